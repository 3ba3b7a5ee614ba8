"""The way to a steady state: march, and Newton's method on the map from one phase 0 to another.

The map goes over as many forcing periods as the response seems to take, or a neighbour's does: one case may
have several responses that all are stable, and a state belongs to the one to which it goes by itself. The
map's derivative J comes from differences, or from a neighbour; Broyden's update (1965) keeps it
right from one step to the next. Steps of Newton's method must bring the state ever closer to its own
image, or the run goes back to where marching had come. A response that J calls unstable, or whose mean
position is free, is left to marching.
"""

from math import pi

import numpy as np

from wedgesweep.compiled import compiled
from wedgesweep.extended.mode import AGE, SIZE, VELOCITY, in_use, units
from wedgesweep.solvers.march import OK
from wedgesweep.solvers.passage import clear
from wedgesweep.solvers.repetition import LONGEST, repetition

# Perturbation of the scaled state for J, at least NOISE times an integrator's tolerance, and the least step
# that teaches J anything.
PERTURBATION, NOISE, LEAST_STEP = 1e-6, 1e2, 1e-4
# Where Newton's method is not to be trusted: determinant of I - J, largest eigenvalue of J.
SINGULAR, UNSTABLE = 1e-3, 0.9999
# Periods that are marched before Newton's method is tried, from rest and after it has failed.
PATIENCE = 8
# A response seems to take several periods where its state comes back this many times closer after them than
# after one.
RHYTHM = 10.0
# Above STALE times the last distance J is made anew; with a fresh one more than GAIN is a failure.
STALE, GAIN = 0.2, 0.5
# Share of a period by which a time at rest grows if nothing slips, less rounding; and the time at rest, in
# periods, at which a response without slip is taken. It would grow for ever.
GROWN, RESTED = 1.0 - 1e-9, 100.0
# Below this distance the next period may be the last one, and is kept.
NEAR = 1e-3
# Periods marched of a response with a foreign tone, which never repeats.
TONE_PERIODS = 30


@compiled
def active(y, p, periods):
    """Which states carry over from phase 0 to the one some periods later.

    Not the velocity of a bolster that is held then; the time at rest does if the last slip was in between.
    """
    found = in_use(p)
    found[VELOCITY] = not (p.set_valued and y[VELOCITY] == 0.0)
    found[AGE] = 0.0 < y[AGE] * p.omega < 2.0 * pi * periods * GROWN
    return found


@compiled
def _distance(a, b, size):
    """Largest difference of two states in their units."""
    return np.max(np.abs(a - b) / size)


@compiled
def _run(y, periods, parameters, keeping, tools, passage):
    """Run some periods; y moves along.

    Faces that did not slip in periods after which all else came back will never do so, and neither will
    those that did not in as many periods as a response may have.
    """
    before = y.copy()
    outcome = passage(0, periods, y, parameters, keeping, tools)
    p = parameters[0]
    cycle = 2.0 * pi / p.omega
    if y[AGE] >= periods * GROWN * cycle:
        before[AGE] = y[AGE]
        if y[AGE] >= LONGEST * GROWN * cycle or _distance(y, before, units(p)) <= NEAR:
            y[AGE] = RESTED * cycle
    return outcome


@compiled
def differences(y, image, periods, moves, size, parameters, jacobian, tools, passage):
    """Write J at y, whose image is known; returns the outcome and the periods it took."""
    jacobian[:] = 0.0
    run = 0
    share = PERTURBATION
    if parameters[0].extended:
        share = max(share, NOISE * tools.room.rtol)
    for column in range(SIZE):
        if moves[column]:
            shifted = y.copy()
            shifted[column] += share * size[column]
            outcome = _run(shifted, periods, parameters, False, tools, passage)
            run += periods
            if outcome != OK:
                jacobian[:] = np.nan
                return outcome, run
            jacobian[:, column] = (shifted - image) / size / share
    return OK, run


@compiled
def _part(jacobian, moves):
    """J of the states that move."""
    places = np.flatnonzero(moves)
    part = np.empty((places.size, places.size))
    for i in range(places.size):
        for j in range(places.size):
            part[i, j] = jacobian[places[i], places[j]]
    return part


@compiled
def _trusted(jacobian, moves):
    """Whether a derivative is known and calls the response stable, and its place determined."""
    part = _part(jacobian, moves)
    n = part.shape[0]
    if not np.isfinite(part).all():
        return False
    margin = np.linalg.det(np.eye(n) - part)
    if n == 1:
        return abs(part[0, 0]) < UNSTABLE and margin >= SINGULAR
    if n == 2:
        determinant = np.linalg.det(part)
        stable = abs(part[0, 0] + part[1, 1]) < 1.0 + determinant and determinant < UNSTABLE
        return stable and margin >= SINGULAR
    largest = np.max(np.abs(np.linalg.eigvals(part.astype(np.complex128))))
    return largest < UNSTABLE and margin >= SINGULAR


@compiled
def _aim(y, image, jacobian, moves, size):
    """Newton's next state."""
    places = np.flatnonzero(moves)
    miss = ((image - y) / size)[places]
    step = np.linalg.solve(np.eye(places.size) - _part(jacobian, moves), miss)
    aim = image.copy()
    for i in range(places.size):
        aim[places[i]] = y[places[i]] + step[i] * size[places[i]]
    return aim


@compiled
def _update(jacobian, y, image, before, image_before, size):
    """Broyden's update of J from two states and their images, unless they are too close to tell."""
    step = (y - before) / size
    square = np.dot(step, step)
    if square > LEAST_STEP**2:
        miss = (image - image_before) / size - np.dot(jacobian, step)
        jacobian += np.outer(miss, step) / square


@compiled
def chase(y, periods, jacobian, parameters, tolerance, most, size, tools, passage):
    """Newton's method from y for a state that comes back, with J made where it is not known or not right.

    Returns whether y repeats now, the outcome and the periods run, of which the last ones are kept if so.
    Where it fails y is the state with the shortest way to its own image that it has come to.
    """
    before, image_before, best = y.copy(), y.copy(), y.copy()
    shortest, last, fresh, run = np.inf, np.inf, False, 0
    while run < most:
        image = y.copy()
        keeping = last < NEAR or run == 0
        if keeping:
            clear(tools.tally)
        outcome = _run(image, periods, parameters, keeping, tools, passage)
        run += periods
        if outcome != OK:
            y[:] = best
            return False, outcome, run
        now = _distance(image, y, size)
        if now <= tolerance and keeping:
            y[:] = image
            return True, OK, run
        moves = active(image, parameters[0], periods)
        if now < shortest:
            shortest = now
            best[:] = image
        if run > periods and np.isfinite(jacobian).all():
            _update(jacobian, y, image, before, image_before, size)
        if now > STALE * last or (run == periods and not _trusted(jacobian, moves)):
            if (fresh and now > GAIN * last) or run + periods * (1 + moves.sum()) > most:
                break
            outcome, more = differences(y, image, periods, moves, size, parameters, jacobian, tools, passage)
            run += more
            fresh = True
            if outcome != OK or not _trusted(jacobian, moves):
                break
        else:
            fresh = False
        before[:], image_before[:], last = y, image, now
        y[:] = _aim(y, image, jacobian, moves, size)
    y[:] = best
    return False, OK, run


@compiled
def _rhythm(back):
    """Periods that a response seems to take, from the distances (LONGEST,) of its state from those before."""
    for n in range(2, LONGEST + 1):
        if back[n - 1] * RHYTHM < back[0]:
            return n
    return 1


@compiled
def _found(y, periods, jacobian, parameters, tolerance, most, size, tools, passage):
    """Period of the response that Newton's method finds from y, 0 if none; the outcome, and the periods run.

    It looks for one of so many periods, and keeps as many.
    """
    found, outcome, run = chase(y, periods, jacobian, parameters, tolerance, most, size, tools, passage)
    if not found or periods == 1:
        return int(found), outcome, run
    image = y.copy()
    if _run(image, 1, parameters, False, tools, passage) == OK and _distance(image, y, size) <= tolerance:
        jacobian[:] = np.nan
        return 1, OK, run + 1
    return periods, OK, run + 1


@compiled
def settle(y, periods, jacobian, parameters, tolerance, most, tools, passage):
    """Find a state at phase 0 that repeats, from y (rest where it is NaN) and J (NaN: unknown).

    ``periods``: if y is thought to lie close to it, so that Newton's method comes first, what the response
    takes there; else 0. Returns the outcome, the period of the response in forcing periods (0: it did not
    repeat), the periods run, and how many of them, the last ones but for checks, the tools have kept.
    y and J move along; J is that over a period of the response.
    """
    p = parameters[0]
    size = units(p)
    run = 0
    if not np.isfinite(y).all():
        y[:], periods = 0.0, 0
        jacobian[:] = np.nan
    if p.stray_vibration_acceleration != 0.0:
        most = min(most, TONE_PERIODS)
        return passage(0, most, y, parameters, False, tools), 0, most, 0
    if periods:
        period, outcome, run = _found(y, periods, jacobian, parameters, tolerance, most, size, tools, passage)
        if period:
            return OK, period, run, periods
        if outcome != OK:
            # The neighbour's state may lie where this case cannot go: rest is the start that decides.
            y[:] = 0.0
    past, back = np.full((LONGEST, SIZE), np.inf), np.empty(LONGEST)
    count = 0
    while run < most:
        past[count % LONGEST] = y
        outcome = _run(y, 1, parameters, False, tools, passage)
        run, count = run + 1, count + 1
        if outcome != OK:
            return outcome, 0, run, 0
        for n in range(1, LONGEST + 1):
            back[n - 1] = _distance(y, past[(count - n) % LONGEST], size)
        period = repetition(back, tolerance)
        if period:
            if period != periods:
                jacobian[:] = np.nan
            return OK, period, run, 0
        if count % PATIENCE == 0:
            trial, periods = y.copy(), _rhythm(back)
            jacobian[:] = np.nan
            period, outcome, more = _found(
                trial, periods, jacobian, parameters, tolerance, most - run, size, tools, passage
            )
            run += more
            if period:
                y[:] = trial
                return OK, period, run, periods
    return OK, 0, run, 0
