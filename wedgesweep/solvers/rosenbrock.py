"""Rosenbrock's method RODAS of order 4(3) for the stiff pieces of the extended system.

A face that a steep ramp of friction all but holds answers within nanoseconds; an explicit step could not
be longer than that. Coefficients: Hairer and Wanner, Solving ODEs II (1996), section VI.4.
"""

from math import inf, isfinite, sqrt

import numpy as np

from wedgesweep.compiled import compiled
from wedgesweep.extended.faces import bolster_slip, column_slip
from wedgesweep.extended.mode import COLUMN_VELOCITY, FRAME_VELOCITY, SIZE, VELOCITY, in_use, unit
from wedgesweep.extended.switches import NOT_ASKED
from wedgesweep.extended.switching import rate
from wedgesweep.solvers.dormand_prince import connect_cubic
from wedgesweep.solvers.step_error import over_tolerance

STAGES = 6
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
# What earlier increments, over the step, add to the right-hand side of a stage.
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
# Share of a unit by which a state is moved for a derivative, and of a ramp on both sides of a velocity.
MOVED, ON_BOTH_SIDES = 1e-7, 1e-4
# Share of the tolerance that a steady response wants of these long steps, and the error of a slip velocity
# that it allows on a ramp, over the end of the ramp.
TIGHTER, ON_RAMP = 0.1, 3000.0
# Growth over a step that is still followed.
LARGEST_GROWTH = 0.5
# Friction that answers this many times faster than the input is stiff.
STIFF = 2000.0
# As much of bristles: the few long implicit steps are then done sooner than the many short explicit ones.
STIFF_BRISTLES = 300.0


@compiled
def stiff(mode, p):
    """Whether a face or the guide is on a ramp of friction that an explicit method could not follow."""
    on_ramp = mode.column == 0 or mode.bolster == 0 or (mode.guide == 0 and p.guide_friction_force > 0.0)
    steep = p.static * p.gravity > STIFF * p.omega * p.threshold_velocity
    return not p.set_valued and on_ramp and steep


@compiled
def outrun(h, y, p):
    """Whether bristles answer so fast that an explicit step, h (s) long, is limited by them alone."""
    way, slip = p.presliding_length, abs(column_slip(y, p))
    return way > 0.0 and slip > STIFF_BRISTLES * p.omega * way and slip * h > way


@compiled
def first_step(p):
    """A step (s) that resolves how a face settles on its ramp after a switch.

    A longer one may be accurate enough but looks past that, and then sees no motion away from the switch.
    """
    return 0.1 * p.threshold_velocity / (p.static * p.gravity)


@compiled
def _derivatives(t, y, places, mode, p, room):
    """The rate's derivatives by the states in use (SIZE, SIZE) and by time (SIZE,), from differences."""
    trial, upper, lower = room.trial, np.empty(SIZE), np.empty(SIZE)
    by_state, by_time = np.zeros((SIZE, SIZE)), np.empty(SIZE)
    trial[:] = y
    for i in places:
        if i in (VELOCITY, COLUMN_VELOCITY, FRAME_VELOCITY):
            # A ramp bends within its own width, as normal forces depend on friction and friction on them. A
            # smaller move there is lost in velocities that are large: then the order of the method is, too.
            side = ON_BOTH_SIDES * p.threshold_velocity
            high, low = y[i] + side, y[i] - side
            trial[i] = low
            rate(t, trial, mode, p, lower)
        else:
            high, low = y[i] + MOVED * max(unit(i, p), abs(y[i])), y[i]
            lower[:] = room.stages[0]
        trial[i] = high
        rate(t, trial, mode, p, upper)
        trial[i] = y[i]
        for j in places:
            by_state[j, i] = (upper[j] - lower[j]) / (high - low)
    change = MOVED / p.omega
    rate(t + change, y, mode, p, upper)
    for j in range(SIZE):
        by_time[j] = (upper[j] - room.stages[0, j]) / change
    return by_state, by_time


@compiled
def _growth(by_state):
    """Rate (1/s) at which friction on its ramps drives the velocities of bolster and column apart.

    An implicit method would damp what in truth runs away, and step over a wedge that locks.
    """
    a, b = by_state[VELOCITY, VELOCITY], by_state[VELOCITY, COLUMN_VELOCITY]
    c, d = by_state[COLUMN_VELOCITY, VELOCITY], by_state[COLUMN_VELOCITY, COLUMN_VELOCITY]
    return 0.5 * (a + d + sqrt(max((a - d) ** 2 + 4.0 * b * c, 0.0)))


@compiled
def _inverse(by_state, places, h):
    """Inverse of the matrix of all stages, of the states in use (Gauss and Jordan, largest pivots first).

    Two to five states: the call of a library took a third of the whole step.
    """
    n = places.size
    matrix, inverse = np.empty((n, n)), np.zeros((n, n))
    for i in range(n):
        for j in range(n):
            matrix[i, j] = -by_state[places[i], places[j]]
        matrix[i, i] += 1.0 / (GAMMA * h)
        inverse[i, i] = 1.0
    for column in range(n):
        largest = column
        for i in range(column + 1, n):
            if abs(matrix[i, column]) > abs(matrix[largest, column]):
                largest = i
        pivot = matrix[largest, column]
        for j in range(n):
            matrix[largest, j], matrix[column, j] = matrix[column, j], matrix[largest, j] / pivot
            inverse[largest, j], inverse[column, j] = inverse[column, j], inverse[largest, j] / pivot
        for i in range(n):
            factor = matrix[i, column]
            if i != column:
                for j in range(n):
                    matrix[i, j] -= factor * matrix[column, j]
                    inverse[i, j] -= factor * inverse[column, j]
    return inverse


@compiled
def step(t, h, y, mode, p, room):
    """One step from y, whose rate is ``room.stages[0]``, to ``room.end``.

    Returns the error over the tolerance, and the forces at the end (NOT_ASKED of a step that failed).
    Leaves the dense output and, as ``room.stages[-1]``, the rate at the end, as dormand_prince does.
    """
    places = np.flatnonzero(in_use(p))
    room.counts[0] += STAGES + places.size + 1
    by_state, by_time = _derivatives(t, y, places, mode, p, room)
    if h * _growth(by_state) > LARGEST_GROWTH:
        return inf, NOT_ASKED
    inverse = _inverse(by_state, places, h)
    increments, slope, right = np.zeros((STAGES, SIZE)), np.empty(SIZE), np.empty(places.size)
    end = room.end
    for stage in range(STAGES):
        for i in range(SIZE):
            end[i] = y[i]
            for j in range(stage):
                end[i] += MATRIX[stage, j] * increments[j, i]
        if stage == 0:
            slope[:] = room.stages[0]
        else:
            rate(t + TIMES[stage] * h, end, mode, p, slope)
        for i in range(places.size):
            place = places[i]
            right[i] = slope[place] + h * SLOPES[stage] * by_time[place]
            for j in range(stage):
                right[i] += COUPLING[stage, j] / h * increments[j, place]
        for i in range(places.size):
            for j in range(places.size):
                increments[stage, places[i]] += inverse[i, j] * right[j]
            if not isfinite(increments[stage, places[i]]):
                return inf, NOT_ASKED
    for i in range(SIZE):
        end[i] += increments[STAGES - 1, i]
    forces = rate(t + h, end, mode, p, room.stages[-1])
    # RODAS's own polynomial is wrong by 1e-5 in the middle of steps whose ends are wrong by 1e-9.
    connect_cubic(h, y, room)
    error = increments[STAGES - 1]
    rtol = TIGHTER * room.rtol
    return max(over_tolerance(error, y, end, rtol, p), _off_ramp(error, mode, rtol, p)), forces


@compiled
def _off_ramp(error, mode, rtol, p):
    """Largest error of a slip velocity on a ramp over what the tolerance allows where it is this narrow."""
    column = abs(column_slip(error, p)) if mode.column == 0 else 0.0
    bolster = abs(bolster_slip(error, p)) if mode.bolster == 0 else 0.0
    largest = max(column, bolster)
    return largest / (ON_RAMP * rtol * p.threshold_velocity)
