"""What the error of a step of the extended system comes to against its tolerance."""

from math import sqrt

from wedgesweep.compiled import compiled, inlined
from wedgesweep.extended.mode import AGE, BRISTLE, COLUMN_WAY, FRAME_WAY, VELOCITY, X
from wedgesweep.solvers.runge_kutta import ABSOLUTE


@inlined
def unit(place, p):
    """Unit of a state: share of 1, input amplitude or velocity, or the time of a radian."""
    if place == BRISTLE:
        return 1.0
    if place == AGE:
        return 1.0 / p.omega
    if place in (X, COLUMN_WAY, FRAME_WAY):
        return p.amplitude
    return p.amplitude * p.omega


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
