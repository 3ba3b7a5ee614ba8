"""Acceleration that the model predicts in the states of a given motion."""

from wedgesweep.compiled import compiled
from wedgesweep.hybrid.interface import cycle, initial_mode, rate


@compiled
def accelerations(parameters, x, v, out):
    """Write z'' (m/s^2) in the states x (m) and v (m/s) on an even grid over one period from phase 0.

    ``parameters``: a record of the base model, shape (1,); a bolster that friction holds has none.
    """
    p = parameters[0]
    for i in range(x.size):
        t = cycle(p) * i / x.size
        mode, _ = initial_mode(t, (x[i], v[i]), p)
        out[i] = rate(t, (x[i], v[i]), mode, p)[0][1]
