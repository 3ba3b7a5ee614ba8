"""What solvers need to run a model under an input that does not repeat."""

import numpy as np

from wedgesweep.inputs.sampled import Input
from wedgesweep.sampled_input import SampledInput
from wedgesweep.simulate import Transient


def transient(
    given: Input, natural: float, rate: float | None, absolute: bool, oscillator: bool, belt: float = 0.0
) -> Transient:
    """A run under an input.

    ``natural``: the model's natural frequency (rad/s); ``rate`` (Hz) of the stored samples; ``absolute``:
    displacements are against the ground; ``belt``: its velocity (m/s). A suspension's state is minus what
    results are reported as.
    """
    sampled, sign = given.sampled(), 1.0 if oscillator else -1.0
    start = (sign * given.start[0], sign * given.start[1])
    samples = given.stored(natural, rate)
    return Transient(
        sampled, _length(given, sampled, natural, absolute, belt), natural, given.duration, samples, start
    )


def _length(given: Input, sampled: SampledInput, natural: float, absolute: bool, belt: float) -> float:
    """What motions are compared with (m; under a force N): the input, or a release, or motion on a belt."""
    knots = given.step * np.arange(given.given.size)
    if given.quantity == "force" or absolute:
        size = float(np.abs(sampled(knots)).max())
    else:
        size = float(np.abs(sampled(knots, 2)).max()) / natural**2
    return max(size, abs(given.start[0]), abs(given.start[1]) / natural, abs(belt) / natural) or 1.0
