"""Records the kept window of a run: running sums by quadrature, and samples at evenly spaced times."""

from typing import Any, NamedTuple

import numpy as np

from wedgesweep.compiled import inlined, inner
from wedgesweep.hybrid import accumulators
from wedgesweep.hybrid.interface import contact_forces, observed, rate, sticks

# Four-point Gauss-Legendre rule on [0, 1].
NODES = tuple(float(0.5 + 0.5 * node) for node in np.polynomial.legendre.leggauss(4)[0])
WEIGHTS = tuple(float(0.5 * weight) for weight in np.polynomial.legendre.leggauss(4)[1])


class Recorder(NamedTuple):
    """What is recorded of a run: running sums, shape (1,), and samples at the times ``start + i step`` (s).

    ``x`` and ``velocity`` have shape (n,), ``sticks`` (n,) says whether the observed contact sticks,
    ``normal`` (2, n) holds the normal forces (N; NaN while they are not determined), ``acceleration`` (n,)
    the rate of the velocity. The last two are not recorded if they have the shapes (2, 0) and (0,). Without
    ``energies`` the sums leave out forces and energies, which saves half of the time. Unless ``summed``,
    steps are not added to the sums, which then say nothing.
    """

    start: float
    step: float
    summed: bool
    energies: bool
    sums: Any
    x: Any
    velocity: Any
    normal: Any
    sticks: Any
    acceleration: Any


@inlined
def first_sample(t, recorder):
    """Index of the first sample at or after time t."""
    return max(int(np.ceil((t - recorder.start) / recorder.step - 1e-9)), 0)


@inlined
def record_node(t, y, weight, mode, recorder, p):
    """Add a point to the sums, with its weight (s) in the quadrature."""
    if recorder.energies:
        accumulators.add(recorder.sums[0], t, y, weight, mode, p)
    else:
        accumulators.add_motion(recorder.sums[0], y, weight, mode, p)


@inlined
def record_sample(i, y, mode, recorder, p):
    """Store sample i if the grid has it."""
    if i >= recorder.x.size:
        return
    recorder.x[i], recorder.velocity[i] = observed(y, p)
    recorder.sticks[i] = sticks(y, mode, p)
    if recorder.normal.shape[1] > 0:
        t = recorder.start + i * recorder.step
        recorder.normal[0, i], recorder.normal[1, i] = contact_forces(t, y, mode, p)
    if recorder.acceleration.size > 0:
        t = recorder.start + i * recorder.step
        recorder.acceleration[i] = observed(rate(t, y, mode, p)[0], p)[1]


@inner
def record_constant(t, end, y, mode, recorder, p):
    """Record a span from t to ``end`` (s) in which the state does not change."""
    record_node(t, y, end - t, mode, recorder, p)
    for i in range(first_sample(t, recorder), first_sample(end, recorder)):
        record_sample(i, y, mode, recorder, p)
