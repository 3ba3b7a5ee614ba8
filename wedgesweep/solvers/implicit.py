"""Rosenbrock's method RODAS of order 4(3) for the stiff modes of a system.

Coefficients: Hairer and Wanner, Solving ODEs II (1996), section VI.4.
"""

from math import inf, isfinite

import numpy as np

from wedgesweep.compiled import allocating
from wedgesweep.hybrid.interface import active, fastest, growth, perturbation, rate, stiff_error
from wedgesweep.hybrid.step import dense_output, over_tolerance, with_dense_output
from wedgesweep.hybrid.vectors import combination, replaced, store, vector
from wedgesweep.solvers.linear_algebra import inverted, places_of

STAGES = 6
ORDER = 4
GAMMA = 0.25
TIMES = np.array([0.0, 0.386, 0.21, 0.63, 1.0, 1.0])
# Weights of the rate's own dependence on time.
SLOPES = np.array([0.25, -0.1043, 0.1035, -0.03620000000000023, 0.0, 0.0])
# State of a stage, from the increments of those before.
MATRIX = np.array(
    [
        [0.0, 0.0, 0.0, 0.0, 0.0],
        [1.544, 0.0, 0.0, 0.0, 0.0],
        [0.9466785280815826, 0.2557011698983284, 0.0, 0.0, 0.0],
        [3.314825187068521, 2.896124015972201, 0.9986419139977817, 0.0, 0.0],
        [1.221224509226641, 6.019134481288629, 12.53708332932087, -0.687886036105895, 0.0],
        [1.221224509226641, 6.019134481288629, 12.53708332932087, -0.687886036105895, 1.0],
    ]
)
# Right-hand side of a stage: coefficients of earlier increments, divided by the step.
COUPLING = np.array(
    [
        [0.0, 0.0, 0.0, 0.0, 0.0],
        [-5.6688, 0.0, 0.0, 0.0, 0.0],
        [-2.430093356833875, -0.2063599157091915, 0.0, 0.0, 0.0],
        [-0.1073529058151375, -9.594562251023355, -20.47028614809616, 0.0, 0.0],
        [7.496443313967647, -10.24680431464352, -33.99990352819905, 11.7089089320616, 0.0],
        [8.083246795921522, -7.981132988064893, -31.52159432874371, 16.31930543123136, -6.058818238834054],
    ]
)
# Step of time for the derivative by differences, as a phase of the fastest input (rad).
PHASE_STEP = 1e-7
# These steps are long: a steady response needs this share of the tolerance in them. The error of a stiff
# velocity, over the width of the stiff range, may be larger by the second factor.
TIGHTER, ON_RAMP = 0.1, 3000.0
# Largest growth of velocities over a step: an implicit method would damp what in truth runs away.
LARGEST_GROWTH = 0.5


@allocating
def _derivatives(t, y, k1, mode, p):
    """The rate's derivatives by the active states (n, n) and by time (n,), from differences."""
    n, moves = len(y), active(p)
    by_state, by_time = np.zeros((n, n)), np.empty(n)
    for i in range(n):
        if not moves[i]:
            continue
        step, both = perturbation(i, y, p)
        high, low = y[i] + step, y[i] - step if both else y[i]
        upper = rate(t, replaced(y, i, high), mode, p)[0]
        lower = rate(t, replaced(y, i, low), mode, p)[0] if both else k1
        for j in range(n):
            if moves[j]:
                by_state[j, i] = (upper[j] - lower[j]) / (high - low)
    change = PHASE_STEP / fastest(p)
    store(combination(1.0 / change, (1.0, -1.0), (rate(t + change, y, mode, p)[0], k1)), by_time)
    return by_state, by_time


@allocating
def _inverse(by_state, places, h):
    """Inverse of I/(gamma h) - J, the matrix of all stages, for the active states ``places``."""
    n = places.size
    matrix = np.empty((n, n))
    for i in range(n):
        for j in range(n):
            matrix[i, j] = -by_state[places[i], places[j]]
        matrix[i, i] += 1.0 / (GAMMA * h)
    return inverted(matrix)


@allocating
def step(t, h, y, k1, mode, p, rtol):
    """As ``explicit.step``."""
    n, places = len(y), places_of(active(p))
    by_state, by_time = _derivatives(t, y, k1, mode, p)
    forces = rate(t, y, mode, p)[1]
    failed = with_dense_output(t, h, y, y, k1, k1, combination(0.0, (1.0,), (y,)))
    if h * growth(by_state, p) > LARGEST_GROWTH:
        return failed, forces, forces, inf
    inverse = _inverse(by_state, places, h)
    increments, slope, end = np.zeros((STAGES, n)), np.empty(n), np.empty(n)
    right = np.empty(places.size)
    store(k1, slope)
    for stage in range(STAGES):
        store(y, end)
        for i in range(n):
            for j in range(stage):
                end[i] += MATRIX[stage, j] * increments[j, i]
        if stage > 0:
            store(rate(t + TIMES[stage] * h, vector(end, y), mode, p)[0], slope)
        for i in range(places.size):
            place = places[i]
            right[i] = slope[place] + h * SLOPES[stage] * by_time[place]
            for j in range(stage):
                right[i] += COUPLING[stage, j] / h * increments[j, place]
        for i in range(places.size):
            for j in range(places.size):
                increments[stage, places[i]] += inverse[i, j] * right[j]
            if not isfinite(increments[stage, places[i]]):
                return failed, forces, forces, inf
    error = vector(increments[STAGES - 1], y)
    last = combination(1.0, (1.0, 1.0), (vector(end, y), error))
    k_end, forces = rate(t + h, last, mode, p)
    tolerance = TIGHTER * rtol
    over = max(
        over_tolerance(error, y, last, tolerance, p), stiff_error(error, mode, p) / (ON_RAMP * tolerance)
    )
    # RODAS's own dense output has errors of 1e-5 in steps whose ends have errors of 1e-9: a cubic is better.
    made = with_dense_output(t, h, y, last, k1, k_end, combination(0.0, (1.0,), (y,)))
    return made, rate(t + 0.5 * h, dense_output(0.5, made), mode, p)[1], forces, over
