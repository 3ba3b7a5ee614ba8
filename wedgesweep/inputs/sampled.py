"""An input as samples, how its motion is stored, and the run of a solver under it."""

from dataclasses import dataclass
from math import ceil, pi

import numpy as np

from wedgesweep.inputs.units import SI
from wedgesweep.sampled_input import SampledInput, from_samples
from wedgesweep.simulate import Transient

# Samples of an analytic input in a period of its highest frequency: u'' is then right to 1e-7.
SAMPLES = 64
# Stored samples in a period of the highest frequency of input or model, unless sampling_hz is given.
STORED = 32


@dataclass(frozen=True, eq=False)
class Input:
    """An input at scale 1, from t = 0 to ``duration`` (s).

    ``quantity``: what ``given`` (n,) holds (SI units) in steps of ``step`` (s); ``start``: displacement (m)
    and velocity (m/s) of the mass at t = 0; ``highest``: its highest frequency (Hz), 0: not known.
    """

    quantity: str
    given: np.ndarray
    step: float
    highest: float
    start: tuple[float, float] = (0.0, 0.0)

    @property
    def duration(self) -> float:
        return self.step * (self.given.size - 1)

    @property
    def units(self) -> str:
        """SI unit of the quantity."""
        return SI[self.quantity]

    def sampled(self) -> SampledInput:
        """What acts: displacement of the base (m) or force (N)."""
        fastest = 2.0 * pi * self.highest if self.highest else None
        return from_samples(self.given, self.step, self.quantity, fastest=fastest)

    def stored(self, natural: float, rate: float | None) -> int:
        """Number of stored samples, at a rate (Hz), or as many as input and model need."""
        if rate is None and not self.highest:
            return self.given.size - 1
        highest = max(self.highest, natural / (2.0 * pi))
        return max(ceil(self.duration * (rate or STORED * highest) * (1.0 - 1e-12)), 2)

    def at(self, times: np.ndarray, sampled: SampledInput) -> np.ndarray:
        """The quantity (SI units) at some times (s), shape (n,)."""
        return sampled(times, {"velocity": 1, "acceleration": 2}.get(self.quantity, 0))


def times(duration: float, highest: float) -> np.ndarray:
    """Even times (s) from 0 to the duration, enough of them for a highest frequency (Hz)."""
    return np.linspace(0.0, duration, ceil(duration * highest * SAMPLES) + 1)


def faded(t: np.ndarray, fade: float) -> np.ndarray:
    """Window that rises from 0 in ``fade`` seconds, and falls to 0 in the last ones, with cosines."""
    if fade == 0.0:
        return np.ones(t.size)
    share = np.clip(np.minimum(t, t[-1] - t) / fade, 0.0, 1.0)
    return 0.5 - 0.5 * np.cos(pi * share)


def transient_of(
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
