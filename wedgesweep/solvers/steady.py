"""Settling on purpose: march until the state at phase 0 of the input repeats, or jump there by Newton.

The Poincare map takes the state (x, x') at the start of a forcing period to the one at its end. A state
that comes back after n periods is a response of period n.
"""

from math import pi

import numpy as np

from wedgesweep.compiled import compiled
from wedgesweep.solvers.march import OK, begin, march
from wedgesweep.solvers.repetition import LONGEST, repetition
from wedgesweep.solvers.sticking import LOCKED

# Marching comes first; then Newton's method is tried this often (periods).
PATIENCE = 12
# Perturbation of the state for the derivative of the map, and where Newton is not to be trusted.
PERTURBATION, SINGULAR, UNSTABLE = 1e-6, 1e-3, 0.9999


@compiled
def _distance(a, b, p):
    """Largest difference of two states, in input amplitudes and input velocities."""
    return max(abs(a[0] - b[0]) / p.amplitude, abs(a[1] - b[1]) / (p.amplitude * p.omega))


@compiled
def poincare(k, x, velocity, parameters, recorder, work):
    """State after one forcing period from a state at phase 0, and the outcome."""
    period = 2.0 * pi / parameters[0].omega
    state, unique = begin(k * period, x, velocity, parameters[0])
    if not unique:
        return x, velocity, LOCKED
    outcome, state = march(state, (k + 1) * period, parameters, False, recorder, work)
    return state.x, state.velocity, outcome


@compiled
def newton(k, x, velocity, parameters, recorder, work):
    """One Newton step towards a fixed point of the map; the state itself where that cannot be trusted.

    The slopes of the map come from differences; a response that they call unstable, or whose mean
    position is free, is left to marching.
    """
    p = parameters[0]
    size = np.array([p.amplitude, p.amplitude * p.omega])
    x1, v1, outcome = poincare(k, x, velocity, parameters, recorder, work)
    matrix = np.empty((2, 2))
    for column in range(2):
        shift = PERTURBATION * size * (np.arange(2) == column)
        x2, v2, status = poincare(k, x + shift[0], velocity + shift[1], parameters, recorder, work)
        outcome = min(outcome, status)
        matrix[0, column] = (x2 - x1) / size[0] / PERTURBATION
        matrix[1, column] = (v2 - v1) / size[1] / PERTURBATION
    trace = matrix[0, 0] + matrix[1, 1]
    determinant = matrix[0, 0] * matrix[1, 1] - matrix[0, 1] * matrix[1, 0]
    margin = 1.0 - trace + determinant  # of (I - J)
    stable = abs(trace) < 1.0 + determinant and determinant < UNSTABLE
    if outcome != OK or not stable or margin < SINGULAR:
        return x, velocity
    rx, rv = (x1 - x) / size[0], (v1 - velocity) / size[1]
    dx = ((1.0 - matrix[1, 1]) * rx + matrix[0, 1] * rv) / margin
    dv = (matrix[1, 0] * rx + (1.0 - matrix[0, 0]) * rv) / margin
    return x + dx * size[0], velocity + dv * size[1]


@compiled
def _extrapolated(x, last, before):
    """Limit of three deflections in a row (Aitken), the last of them where there is none in sight.

    A bolster that is at rest at phase 0 creeps by a slip per period, near breakaway ever more slowly: as
    1/k after k periods. There each extrapolation halves what is left, and does not overshoot.
    """
    now, then = x - last, last - before
    if now == 0.0 or abs(now) >= abs(then) or now * then <= 0.0:
        return x
    return x + now * now / (then - now)


@compiled
def settle(x, velocity, parameters, tolerance, most, recorder, work):
    """March from a state at phase 0 until it repeats.

    Returns the outcome, the number of periods, x, velocity, and the period of the response in forcing
    periods (0: it did not repeat within ``most`` periods).
    """
    p = parameters[0]
    past, back = np.full((LONGEST, 2), np.inf), np.empty(LONGEST)
    k = 0
    while k < most:
        past[k % LONGEST, 0], past[k % LONGEST, 1] = x, velocity
        x, velocity, outcome = poincare(k, x, velocity, parameters, recorder, work)
        k += 1
        if outcome != OK:
            return outcome, k, x, velocity, 0
        state = (x, velocity)
        for n in range(1, LONGEST + 1):
            back[n - 1] = _distance(state, past[(k - n) % LONGEST], p)
        n = repetition(back, tolerance)
        if n:
            return OK, k, x, velocity, n
        if k % PATIENCE == 0:
            before, gain = _distance(state, past[(k - 1) % LONGEST], p), 0.1
            if velocity == 0.0:
                gain = 0.5
                trial = (_extrapolated(x, past[(k - 1) % LONGEST, 0], past[(k - 2) % LONGEST, 0]), 0.0)
            else:
                trial = newton(k, x, velocity, parameters, recorder, work)
            x1, v1, outcome = poincare(k, trial[0], trial[1], parameters, recorder, work)
            if outcome == OK and _distance((x1, v1), trial, p) < gain * before:
                x, velocity = trial
    return OK, k, x, velocity, 0
