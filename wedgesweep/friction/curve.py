"""A friction law as a curve: what figures draw and reports quote."""

import numpy as np

from wedgesweep.compiled import compiled
from wedgesweep.effects import states
from wedgesweep.friction import coefficient, static


@compiled
def _curve(velocities, branch, parameters, out):
    p = parameters[0]
    highest = static(0, states.scales(p), p)
    for i in range(velocities.size):
        out[i] = coefficient(velocities[i], branch, highest, p)


def curve(velocities: np.ndarray, branch: int, p: np.void) -> np.ndarray:
    """Signed coefficient of friction on a branch of the law of a record, before any time at rest.

    ``velocities`` (m/s), shape (n,).
    """
    out = np.empty(len(velocities))
    _curve(np.asarray(velocities, dtype=float), branch, np.array([p]), out)
    return out
