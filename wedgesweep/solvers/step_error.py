"""What the error of a step of the extended system comes to against its tolerance."""

from math import sqrt

from wedgesweep.compiled import compiled
from wedgesweep.extended.mode import AGE, VELOCITY, unit
from wedgesweep.solvers.runge_kutta import ABSOLUTE


@compiled
def over_tolerance(error, y, end, rtol, p):
    """Root mean square, over the states that move, of errors (SIZE,) over what the tolerance allows."""
    total, count = 0.0, 0
    for i in range(AGE):
        size = max(abs(y[i]), abs(end[i]))
        if i > VELOCITY and size == 0.0:
            continue
        total += (error[i] / (rtol * (size + ABSOLUTE * unit(i, p)))) ** 2
        count += 1
    return sqrt(total / count)
