"""Keeps the kept window of a compiled run: quadrature nodes into the tally, states onto the phase grid."""

from typing import Any, NamedTuple

import numpy as np

from wedgesweep import tally
from wedgesweep.compiled import compiled

# Four-point Gauss-Legendre rule on [0, 1].
NODES = tuple(float(0.5 + 0.5 * node) for node in np.polynomial.legendre.leggauss(4)[0])
WEIGHTS = tuple(float(0.5 * weight) for weight in np.polynomial.legendre.leggauss(4)[1])


class Recorder(NamedTuple):
    """Where a run is kept: a tally of shape (1,) and samples as in ``trajectory.Samples``.

    Samples lie at ``start + i step`` (s); nothing is kept of the time before ``start``.
    """

    start: float
    step: float
    tally: Any
    x: Any
    velocity: Any
    contact: Any


@compiled
def first_sample(t, recorder):
    """Index of the first sample at or after time t."""
    place = int(np.ceil((t - recorder.start) / recorder.step - 1e-9))
    return max(place, 0)


@compiled
def put_sample(i, x, velocity, contact, recorder):
    """Store sample i if the grid has it."""
    if i < recorder.x.size:
        recorder.x[i], recorder.velocity[i] = x, velocity
        recorder.contact[i, 0] = contact.column
        recorder.contact[i, 1] = contact.bolster
        recorder.contact[i, 2] = contact.guide
        recorder.contact[i, 3] = contact.column_sign
        recorder.contact[i, 4] = contact.bolster_sign


@compiled
def put_node(t, x, velocity, weight, contact, recorder, p):
    """Add a node to the tally."""
    tally.add(recorder.tally[0], t, x, velocity, weight, contact, p)


@compiled
def keep_at_rest(t, end, x, contact, recorder, p):
    """Keep a span during which the bolster is stuck."""
    put_node(t, x, 0.0, end - t, contact, recorder, p)
    for i in range(first_sample(t, recorder), first_sample(end, recorder)):
        put_sample(i, x, 0.0, contact, recorder)
