"""Steady states by shooting: Newton's method for fixed points of the Poincare map, and plain integration.

The map spans as many forcing periods as the response seems to repeat after, or as a neighbour's does. A case
may have several stable responses; plain integration decides which of them a start leads to. The derivative J
of the map (monodromy matrix) comes from differences or from a neighbour, and Broyden's update (1965) adapts
it from step to step. If a Newton step does not bring the state closer to its image, integration goes on from
where it had stopped. It also finds the responses that Newton's method cannot: those that J shows to be
unstable, and those whose mean position is not determined.
"""

from math import isfinite
from typing import Any, NamedTuple

import numba
import numpy as np

from wedgesweep.compiled import Pointer, allocating, inlined, inner
from wedgesweep.hybrid.accumulators import clear
from wedgesweep.hybrid.state import OK
from wedgesweep.solvers.linear_algebra import inverted, places_of, spectral_radius
from wedgesweep.solvers.period_detection import CLOSER, LONGEST_PERIOD, detected_period, guessed_period
from wedgesweep.solvers.period_map import run_case

# Perturbation of the scaled state for J, at least NOISE times the tolerance of a step, and the least step
# after which J is updated.
PERTURBATION, NOISE, LEAST_STEP = 1e-6, 1e2, 1e-4
# Limits of Newton's method: largest number in the inverse of I - J (1 / (1 - eigenvalue), if there is only
# one), by which it also enlarges errors of the map; largest eigenvalue of J.
LARGEST_INVERSE, UNSTABLE = 1e3, 0.9999
# Periods of plain integration before Newton's method is tried, from rest and after it has failed.
NEWTON_INTERVAL = 8
# If the distance is above STALE times the last one, J is computed again; with a new J, Newton's method has
# failed if it is above GAIN times the last one.
STALE, GAIN = 0.2, 0.5
# Share of a period by which a clock grows at least if nothing resets it; and its value, in periods, in a
# response in which nothing ever does.
GROWN, CONTACT_TIME_LIMIT = 1.0 - 1e-9, 100.0
# Below this distance of a state from its image the next run may be the last one, and is kept.
KEPT_BELOW = 1e-3
# Periods of integration where a spurious tone keeps the input from repeating.
PERIODS_UNDER_TWO_TONES = 30
# An extrapolated state is taken if it reduces the distance to its image by this factor.
EXTRAPOLATION_GAIN = 0.5


class Shooting(NamedTuple):
    """A search for a steady state: its case (period_map.Cases, and which), tolerance and limit of periods.

    ``records``: whether the memory keeps the last periods of a state that Newton's method has found.
    """

    cases: Any
    number: int
    size: Any  # natural sizes of the states (n,)
    clocks: Any  # which states only count time (n,)
    cycle: float  # period of the input (s)
    tolerance: float
    most_periods: int
    memory: Any
    records: bool


@allocating
def shooting(cases, number, accuracy, memory, records):
    """A search for the steady state of one of the cases; ``accuracy``: its tolerance and limit of periods."""
    size, clocks, cycle = cases.scales[number], cases.clocks[number], cases.cycle[number]
    return Shooting(cases, number, size, clocks, cycle, accuracy[0], accuracy[1], memory, records)


@inlined
def run_map(first, periods, y, keeping, shooting):
    """Run the case from phase 0 of period ``first``; y (n,) is replaced. Returns the outcome."""
    return run_case(shooting.cases, shooting.number, first, periods, y, keeping, shooting.memory)


class Found(NamedTuple):
    """How a search ended.

    ``period`` of the response in forcing periods (0: it did not repeat), periods ``run``, and how many of
    them the memory has kept (the last ones but for checks).
    """

    outcome: int
    period: int
    run: int
    kept: int


@inlined
def copy(source, target):
    """Write the first numbers of an array into another."""
    # numba would compile texts of errors for shapes that differ with ``target[:] = source``: a second.
    for i in range(target.size):
        target[i] = source[i]


@inner
def _distance(a, b, size):
    """Largest difference of two states over their natural sizes; NaN if one of these is NaN."""
    largest = 0.0
    for i in range(size.size):
        difference = abs(a[i] - b[i]) / size[i]
        if difference != difference:
            return difference
        largest = max(largest, difference)
    return largest


@allocating
def _moving(y, periods, shooting):
    """Which states at phase 0 affect those some periods later, y; a clock does if it was reset in between."""
    moves = shooting.memory.free[: y.size].copy()
    for i in range(moves.size):
        if shooting.clocks[i]:
            moves[i] = 0.0 < y[i] < periods * GROWN * shooting.cycle
    return moves


@allocating
def _run(y, periods, keeping, shooting):
    """Run some periods; y is replaced by the state reached. Returns the outcome.

    A clock that was not reset although all other states came back never will be; nor will one that was not
    reset in as many periods as a response may have. Both are set to CONTACT_TIME_LIMIT.
    """
    before, cycle = y.copy(), shooting.cycle
    outcome = run_map(0, periods, y, keeping, shooting)
    for i in range(y.size):
        if shooting.clocks[i] and y[i] >= periods * GROWN * cycle:
            before[i] = y[i]
            if y[i] >= LONGEST_PERIOD * GROWN * cycle or _distance(y, before, shooting.size) <= KEPT_BELOW:
                y[i] = CONTACT_TIME_LIMIT * cycle
    return outcome


@allocating
def monodromy(y, image, periods, keeping, moves, jacobian, shooting):
    """Write J at y, whose image is known, by differences; returns the outcome and the periods run.

    ``keeping``: whether the run to the image was kept. So are these, as other steps lead a little beside it.
    """
    jacobian[:] = 0.0
    size = shooting.size
    run = 0
    share = max(PERTURBATION, NOISE * shooting.memory.work.rtol)
    for k in range(size.size):
        if moves[k]:
            shifted = y.copy()
            shifted[k] += share * size[k]
            outcome = _run(shifted, periods, keeping, shooting)
            run += periods
            if outcome != OK:
                jacobian[:] = np.nan
                return outcome, run
            for i in range(size.size):
                jacobian[i, k] = (shifted[i] - image[i]) / size[i] / share
    return OK, run


@allocating
def _part(jacobian, moves):
    """Rows and columns of J for the states that move."""
    places = places_of(moves)
    part = np.empty((places.size, places.size))
    for i in range(places.size):
        for j in range(places.size):
            part[i, j] = jacobian[places[i], places[j]]
    return part


@inner
def known(matrix):
    """Whether all numbers of a matrix are finite: NaN stands for what is not known."""
    for i in range(matrix.shape[0]):
        for j in range(matrix.shape[1]):
            if not isfinite(matrix[i, j]):
                return False
    return True


@allocating
def _newton_matrix(part):
    """Inverse of I - J."""
    matrix = np.empty(part.shape)
    for i in range(part.shape[0]):
        for j in range(part.shape[1]):
            matrix[i, j] = (1.0 if i == j else 0.0) - part[i, j]
    return inverted(matrix)


@allocating
def _stable_and_regular(jacobian, moves):
    """Whether J is known, its eigenvalues are inside the unit circle, and I - J is regular.

    If I - J is singular the mean position of the response is not determined.
    """
    if not known(jacobian):
        return False
    part = _part(jacobian, moves)
    n = part.shape[0]
    inverse = _newton_matrix(part)
    for i in range(n):
        for j in range(n):
            if not abs(inverse[i, j]) <= LARGEST_INVERSE:
                return False
    if n == 1:
        return abs(part[0, 0]) < UNSTABLE
    if n == 2:
        determinant = part[0, 0] * part[1, 1] - part[0, 1] * part[1, 0]
        return abs(part[0, 0] + part[1, 1]) < 1.0 + determinant and determinant < UNSTABLE
    return spectral_radius(part) < UNSTABLE


@allocating
def _newton_step(y, image, jacobian, moves, size):
    """Newton's next state."""
    places = places_of(moves)
    inverse = _newton_matrix(_part(jacobian, moves))
    following = image.copy()
    for i in range(places.size):
        step = 0.0
        for j in range(places.size):
            step += inverse[i, j] * (image[places[j]] - y[places[j]]) / size[places[j]]
        following[places[i]] = y[places[i]] + step * size[places[i]]
    return following


@allocating
def _update(jacobian, y, image, before, image_before, size):
    """Broyden's update of J from two states and their images, unless the states are too close together."""
    step, square = np.empty(size.size), 0.0
    for i in range(size.size):
        step[i] = (y[i] - before[i]) / size[i]
        square += step[i] * step[i]
    if square <= LEAST_STEP**2:
        return
    for i in range(size.size):
        miss = (image[i] - image_before[i]) / size[i]
        for j in range(size.size):
            miss -= jacobian[i, j] * step[j]
        for j in range(size.size):
            jacobian[i, j] += miss * step[j] / square


@inner
def _leave_out_closed(moves, y, shooting):
    """Leave out states that a closed contact holds at y: they are 0, and can change to one side only."""
    for i in range(moves.size):
        moves[i] = moves[i] and not (shooting.cases.impacts and y[i] == 0.0)


@allocating
def newton_shooting(y, periods, jacobian, most, shooting):
    """Newton's method from y for a state that comes back; J is computed if it is unknown or out of date.

    Returns whether y now repeats, the outcome and the periods run; if y repeats the memory keeps the last of
    them. If the method fails, y is the image of the state that came closest to its own image.
    """
    size = shooting.size
    before, image_before, best = y.copy(), y.copy(), y.copy()
    # Distances of the state from its image: ``now``, in the step before, and the shortest so far.
    last, shortest, run = np.inf, np.inf, 0
    # Whether J was computed in the step before, and whether it has passed the test of stability once.
    fresh = accepted = False
    while run < most:
        image = y.copy()
        near = last < KEPT_BELOW or run == 0
        keeping = near and shooting.records
        if keeping:
            clear(shooting.memory.sums)
        outcome = _run(image, periods, keeping, shooting)
        run += periods
        if outcome != OK:
            copy(best, y)
            return False, outcome, run
        now = _distance(image, y, size)
        if now <= shooting.tolerance and near:
            copy(image, y)
            return True, OK, run
        moves = _moving(image, periods, shooting)
        _leave_out_closed(moves, y, shooting)
        if now < shortest:
            shortest = now
            copy(image, best)
        if run == periods and now <= CLOSER * shooting.tolerance and not known(jacobian):
            # All but steady: another run costs less than a derivative.
            copy(image, y)
            last = now
            continue
        if accepted:
            _update(jacobian, y, image, before, image_before, size)
        if now > STALE * last or not (accepted or _stable_and_regular(jacobian, moves)):
            if (fresh and now > GAIN * last) or run + periods * (1 + places_of(moves).size) > most:
                break
            outcome, more = monodromy(y, image, periods, keeping, moves, jacobian, shooting)
            run += more
            fresh = True
            if outcome != OK or not _stable_and_regular(jacobian, moves):
                break
        else:
            fresh = False
        accepted = True
        copy(y, before)
        copy(image, image_before)
        last = now
        copy(_newton_step(y, image, jacobian, moves, size), y)
    copy(best, y)
    return False, OK, run


@allocating
def _shoot(y, periods, jacobian, most, shooting):
    """Newton's method from y for a response of some periods, or of a divisor of them."""
    found, outcome, run = newton_shooting(y, periods, jacobian, most, shooting)
    if not found:
        return Found(outcome, 0, run, periods)
    size = shooting.size
    for shorter in range(1, periods):
        if periods % shorter:
            continue
        image = y.copy()
        outcome = _run(image, shorter, False, shooting)
        run += shorter
        if outcome == OK and _distance(image, y, size) <= CLOSER * shooting.tolerance:
            jacobian[:] = np.nan
            found, outcome, more = newton_shooting(y, shorter, jacobian, most, shooting)
            return Found(outcome, shorter * found, run + more, shorter)
    return Found(OK, periods, run, periods)


@allocating
def _extrapolated(y, last, before, moves):
    """Limit of three successive states (Aitken); the last of them where they do not converge.

    A state at rest at phase 0 may creep by one slip per period, near breakaway ever more slowly: as 1/k after
    k periods. There each extrapolation halves the distance to the limit and does not overshoot.
    """
    limit = y.copy()
    for i in range(y.size):
        now, then = y[i] - last[i], last[i] - before[i]
        if moves[i] and now != 0.0 and abs(now) < abs(then) and now * then > 0.0:
            limit[i] += now * now / (then - now)
    return limit


@allocating
def _creep(y, moves, past, count, shooting):
    """Extrapolate the creep of states that a contact holds at phase 0; returns the periods run.

    ``moves``: which states may take other values.
    """
    size = shooting.size
    last, before = past[(count - 1) % LONGEST_PERIOD], past[(count - 2) % LONGEST_PERIOD]
    trial = _extrapolated(y, last, before, moves)
    image = trial.copy()
    outcome = _run(image, 1, False, shooting)
    if outcome == OK and _distance(image, trial, size) < EXTRAPOLATION_GAIN * _distance(y, last, size):
        copy(trial, y)
    return 1


@allocating
def _settle(y, periods, jacobian, shooting):
    """Find a state at phase 0 that repeats, from y (rest where it is NaN) and J (NaN: unknown).

    ``periods``: period of the response that y should be close to, for which Newton's method is tried first;
    0 if none is known. y and J are updated in place; J is that over one period of the response.
    """
    most, run = shooting.most_periods, 0
    if not known(y.reshape(1, y.size)):
        y[:], periods = 0.0, 0
        jacobian[:] = np.nan
    if not shooting.cases.repeats[shooting.number]:
        most = min(most, PERIODS_UNDER_TWO_TONES)
        outcome = run_map(0, most, y, False, shooting)
        return Found(outcome, 0, most, 0)
    if periods:
        found = _shoot(y, periods, jacobian, most, shooting)
        if found.period:
            return found
        run = found.run
        if found.outcome != OK:
            # The neighbour's state may be impossible in this case: rest decides.
            y[:] = 0.0
    return _integrate(y, periods, jacobian, run, shooting)


@allocating
def _integrate(y, periods, jacobian, run, shooting):
    """Integrate from y until the state repeats, or Newton's method, tried now and then, finds one that does.

    As ``settle``; ``periods``: period of the response over which J was taken, ``run``: periods run before.
    """
    size, most = shooting.size, shooting.most_periods
    past, back = np.empty((LONGEST_PERIOD, size.size)), np.empty(LONGEST_PERIOD)
    past[:] = np.inf
    count = 0
    while run < most:
        copy(y, past[count % LONGEST_PERIOD])
        outcome = _run(y, 1, False, shooting)
        run, count = run + 1, count + 1
        if outcome != OK:
            return Found(outcome, 0, run, 0)
        for n in range(1, LONGEST_PERIOD + 1):
            back[n - 1] = _distance(y, past[(count - n) % LONGEST_PERIOD], size)
        period = detected_period(back, shooting.tolerance)
        if period:
            if period != periods:
                jacobian[:] = np.nan
            return Found(OK, period, run, 0)
        if count % NEWTON_INTERVAL == 0:
            moves, guessed = shooting.memory.free[: y.size].copy(), guessed_period(back)
            # A spiral into a fixed point seems to repeat after a few periods as well.
            for periods in range(1, guessed + 1, max(1, guessed - 1)):
                trial = y.copy()
                jacobian[:] = np.nan
                found = _shoot(trial, periods, jacobian, most - run, shooting)
                run += found.run
                if found.period:
                    copy(trial, y)
                    return Found(OK, found.period, run, found.kept)
            run += _creep(y, moves, past, count, shooting)
    return Found(OK, 0, run, 0)


_shared: list[Pointer] = []


def settle_pointer(cases: Any, memory: Any) -> Pointer:
    """``_settle`` for all callers, whatever their cases: to compile it takes longer than to compile them.

    ``cases``, ``memory``: examples.
    """
    if not _shared:

        def settle(y, periods, jacobian, shooting):
            return _settle(y, periods, jacobian, shooting)

        example = Shooting(cases, 0, cases.scales[0], cases.clocks[0], 1.0, 1.0, 1, memory, True)
        arguments = (cases.scales[0], 0, cases.scales, example)
        _shared.append(Pointer(settle, numba.typeof(Found(0, 0, 0, 0)), arguments))
    return _shared[0]
