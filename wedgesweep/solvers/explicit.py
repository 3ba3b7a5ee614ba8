"""Explicit Runge-Kutta steps with dense output: Dormand and Prince's 5(4) pair (1980).

The continuous extension of order 4 is Hairer's (Hairer, Norsett and Wanner, Solving ODEs I, 1993). Zeros
of the tableau are left out: each weight belongs to the stage at the same place in the calls below.
"""

from wedgesweep.compiled import inlined
from wedgesweep.hybrid.interface import rate
from wedgesweep.hybrid.step import over_tolerance, with_dense_output
from wedgesweep.hybrid.vectors import combination, weighted

STAGES = 7
ORDER = 5
TIMES = (0.0, 1 / 5, 3 / 10, 4 / 5, 8 / 9)
A2 = (1 / 5,)
A3 = (3 / 40, 9 / 40)
A4 = (44 / 45, -56 / 15, 32 / 9)
A5 = (19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729)
A6 = (9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656)
WEIGHTS = (35 / 384, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84)
ERROR = (71 / 57600, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40)
DENSE = (
    -12715105075 / 11282082432,
    87487479700 / 32700410799,
    -10690763975 / 1880347072,
    701980252875 / 199316789632,
    -1453857185 / 822651844,
    69997945 / 29380423,
)


@inlined
def step(t, h, y, k1, mode, p, rtol):
    """One step from y, whose rate is k1.

    Returns the step, forces near its middle (of a stage) and at its end, and its error over the tolerance.
    """
    k2 = rate(t + TIMES[1] * h, weighted(y, h, A2, (k1,)), mode, p)[0]
    k3, within = rate(t + TIMES[2] * h, weighted(y, h, A3, (k1, k2)), mode, p)
    k4 = rate(t + TIMES[3] * h, weighted(y, h, A4, (k1, k2, k3)), mode, p)[0]
    k5 = rate(t + TIMES[4] * h, weighted(y, h, A5, (k1, k2, k3, k4)), mode, p)[0]
    k6 = rate(t + h, weighted(y, h, A6, (k1, k2, k3, k4, k5)), mode, p)[0]
    end = weighted(y, h, WEIGHTS, (k1, k3, k4, k5, k6))
    k7, forces = rate(t + h, end, mode, p)
    stages = (k1, k3, k4, k5, k6, k7)
    error = over_tolerance(combination(h, ERROR, stages), y, end, rtol, p)
    return with_dense_output(t, h, y, end, k1, k7, combination(h, DENSE, stages)), within, forces, error
