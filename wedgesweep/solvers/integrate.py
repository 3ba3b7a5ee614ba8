"""A run from one event to the next: by the system's own method where it has one, else by Runge-Kutta steps.

After each step the event functions are known at its start, middle and end. Where one may have been zero in
between, its minimum is sought. An event is located on the step's dense output, roughly at first. Then the
step is repeated with a length that ends just past the event, and the event is located there: dense output is
most accurate near the ends of a step, and stages far beyond an event would see friction of another mode.

Places within a step are shares of it, from 0 to 1.
"""

from math import inf, nan, pi, sqrt
from typing import Any, NamedTuple

import numpy as np

from wedgesweep.compiled import by_record, inlined, inner
from wedgesweep.hybrid.accumulators import add_impact
from wedgesweep.hybrid.interface import (
    event,
    event_count,
    events,
    expected_event,
    fastest,
    first_states,
    follow,
    holds,
    initial_mode,
    linear,
    never_locks,
    only_first_move,
    opened,
    outruns,
    provided,
    rate,
    settling_step,
    stiff,
    transition,
    well_posed,
)
from wedgesweep.hybrid.linear_modes import Equations, follow_linear, forget, room
from wedgesweep.hybrid.recorded_step import record_step
from wedgesweep.hybrid.search import Bracket, minimum, searched, zero, zero_after_start
from wedgesweep.hybrid.state import CHATTERING, FAILED, LOCKED, NO_EVENT, OK, State
from wedgesweep.hybrid.step import SHORTEST, dense_output, step_limit
from wedgesweep.hybrid.vectors import with_first
from wedgesweep.solvers import explicit, implicit

EVENTS_PER_PERIOD = 1000
# Room for event functions, and for numbers that a system keeps of a case.
MOST_EVENTS, MOST_CONSTANTS = 32, 32
# First step of a run, as a share of a period.
FIRST_STEP = 1e-3
# Least number of steps per period of the fastest input: a longer step could miss a whole motion. While
# contacts hold the mass nothing else limits its length.
LEAST_STEPS, LEAST_STEPS_HELD = 12, 64
SAFETY, SHRINK, GROW = 0.9, 0.2, 5.0
# At an error below this share of the tolerance, which is less than SAFETY**5, the next step is longer.
NOT_GROWING = 0.5
# A window of more periods of the fastest input than this does not end in a reasonable time.
LONGEST_WINDOW = 1_000_000
# A minimum is looked for where the parabola through three values falls below this share of the least.
SUSPECT = 0.3
# Errors of places in a step: of an event, of a minimum; and the phase (rad) after an event in which no other
# one is sought.
PLACE_OF_EVENT, PLACE_OF_MINIMUM, UNSEEN = 1e-14, 1e-6, 1e-13
# Error of the place of an event that a repeated step will locate, and how far beyond it that step goes, as a
# share of the first one.
ROUGHLY, PAST_EVENT = 1e-3, 2e-2
# A step that aims at an expected event goes beyond it by the first share of the time to it, and has at least
# the second share of the length that accuracy allows. It is repeated if it finds an event before the last
# share of its length: its stages have seen too much of the friction beyond.
PAST_EXPECTED, LEAST_SHARE, NEAR_END = 0.15, 0.02, 0.75


class Workspace(NamedTuple):
    """Tolerance of a run, counts of its rate evaluations, steps and events, and working space.

    ``counts`` has shape (3,); the event functions at places of a step have shape (MOST_EVENTS,);
    ``equations``: of linear modes; ``constants`` (MOST_CONSTANTS,): what a system keeps of a case, with NaN
    first where there is nothing yet.
    """

    rtol: float
    counts: Any
    at_start: Any
    at_middle: Any
    at_end: Any
    at_point: Any
    equations: Equations
    constants: Any


def workspace(rtol: float) -> Workspace:
    """A fresh Workspace."""
    start, middle, end, point = np.full((4, MOST_EVENTS), inf)
    return Workspace(
        rtol, np.zeros(3, np.int64), start, middle, end, point, room(), np.full(MOST_CONSTANTS, nan)
    )


class _EventFunction(NamedTuple):
    """An event function on a step: what is searched for zeros and minima."""

    number: int
    step: Any
    mode: Any
    p: Any
    out: Any


@searched(_EventFunction)
@inner
def _value(share, function):
    step = function.step
    y = dense_output(share, step)
    return event(function.number, step.t + share * step.h, y, function.mode, function.p, function.out), nan


@inlined
def _may_graze(before, now, following):
    """Whether a function that is positive at three evenly spaced points may have a zero between them."""
    if not before > now <= following:
        return False
    curvature = before - 2.0 * now + following
    return now - (following - before) ** 2 / (8.0 * curvature) < SUSPECT * now


@inlined
def _parabola_zero(start, middle, end):
    """First zero on [0, 1] of a parabola that begins above zero, from its values at 0, 1/2 and 1."""
    bend, rise = 2.0 * (start - 2.0 * middle + end), 4.0 * middle - 3.0 * start - end
    return 2.0 * start / (sqrt(max(rise * rise - 4.0 * bend * start, 0.0)) - rise)


@inner
def _first_zero(function, start, end, from_zero, close):
    """Share of a step at which an event function is first zero, to within ``close``; 2 if nowhere.

    ``start``, ``end``: its values at the ends of the step. ``from_zero``: the start is an event of the same
    pair, so that its value there is zero but for rounding errors.
    """
    nearest = UNSEEN / (function.step.h * fastest(function.p))
    high, at_high = 0.5, _value(0.5, function)[0]
    if at_high > 0.0 and start > 0.0 and _may_graze(start, at_high, end):
        high = minimum(function, 0.0, 1.0, PLACE_OF_MINIMUM)
        at_high = _value(high, function)[0]
    elif close == ROUGHLY and start > 0.0 and not from_zero and min(at_high, end) <= 0.0:
        return _parabola_zero(start, at_high, end)
    if at_high <= 0.0:
        bracket = Bracket(0.0, start, high, at_high)
        if start > 0.0 and not from_zero:
            return zero(function, bracket, close)
        return zero_after_start(function, bracket, nearest, close)
    if end <= 0.0:
        return zero(function, Bracket(high, at_high, 1.0, end), close)
    return 2.0


@inlined
def first_event(step, mode, last_event, forces, close, p, work):
    """Place in a step, to within ``close``, and number of its first event; (1, NO_EVENT) if there is none.

    ``forces``: of a stage near the middle of the step, and at its end. The event functions at start, middle
    and end show which of them are worth a closer look. If the system may lock, the forces in the middle are
    computed: a missed event could hide that it locks.
    """
    y, at_middle = dense_output(0.5, step), forces[0]
    if not never_locks(p):
        at_middle = rate(step.t + 0.5 * step.h, y, mode, p)[1]
    events(at_middle, step.t + 0.5 * step.h, y, mode, p, work.at_middle)
    events(forces[1], step.t + step.h, step.end, mode, p, work.at_end)
    earliest, first = 1.0, NO_EVENT
    for number in range(event_count(p)):
        start, middle, end = work.at_start[number], work.at_middle[number], work.at_end[number]
        if end == inf or (min(middle, end) > 0.0 and not _may_graze(start, middle, end)):
            continue
        from_zero = last_event >= 0 and number // 2 == last_event // 2
        function = _EventFunction(number, step, mode, p, work.at_point)
        share = _first_zero(function, start, end, from_zero, close)
        if share <= 1.0 and (first < 0 or share < earliest):
            earliest, first = share, number
    return earliest, first


def _implicit_step(t, h, y, k1, mode, p, rtol):
    """``implicit.step`` for records of systems that may be stiff; for others it is never called."""


by_record(
    _implicit_step,
    lambda fields: (
        (lambda t, h, y, k1, mode, p, rtol: implicit.step(t, h, y, k1, mode, p, rtol))
        if provided(stiff, fields)
        else (lambda t, h, y, k1, mode, p, rtol: explicit.step(t, h, y, k1, mode, p, rtol))
    ),
)


@inlined
def _least_aim(h, mode, p):
    """Least length (s) of a step that aims at an expected event: flights between impacts may be short."""
    first, second = opened(mode, p)
    return SHORTEST * 2.0 * pi / fastest(p) if first or second else LEAST_SHARE * h


@inlined
def _shorter(taken, error, exponent):
    """Length (s) of the next try after a step whose error is too large, or not finite."""
    return taken * max(SHRINK, SAFETY * error**exponent) if error < inf else taken * SHRINK


@inlined
def _next_length(h, taken, longest, error, exponent):
    """Length (s) of the next step after one that was accepted, which may have been cut short of ``h``."""
    if taken < longest or error > NOT_GROWING:
        grown = taken * min(GROW, SAFETY * max(error, 1e-10) ** exponent)
        return max(h, grown) if taken < h else grown
    return h


@inner
def _integrate_mode(state, stop, p, keeping, recorder, work):
    """Follow a mode by steps until its first event or ``stop``: the state there and the event.

    In place of an event NO_EVENT, LOCKED or FAILED. Of a step ``h`` is the length that accuracy allows,
    ``aim`` one that ends past the event that the system expects, ``to_event`` one that ends just past the
    event that was found in the step before (inf: none), and ``taken`` the shortest of them.
    """
    t, y, mode, last_event, h = state
    period = 2.0 * pi / fastest(p)
    longest = period / (LEAST_STEPS_HELD if holds(mode, p) else LEAST_STEPS)
    to_event = inf
    k1, forces = rate(t, y, mode, p)
    events(forces, t, y, mode, p, work.at_start)
    expected = expected_event(forces, t, y, mode, p)
    most_steps = step_limit(work.counts[1], (stop - t) / period)
    implicitly = stiff(mode, p)
    if implicitly and last_event >= 0:
        h = min(h, settling_step(p))
    while t < stop:
        h = min(h, longest)
        aim = max((1.0 + PAST_EXPECTED) * expected, _least_aim(h, mode, p))
        taken = min(h, stop - t, to_event, aim)
        if implicitly:
            step, at_middle, at_end, error = _implicit_step(t, taken, y, k1, mode, p, work.rtol)
            exponent, evaluations = -1.0 / implicit.ORDER, implicit.STAGES
        else:
            step, at_middle, at_end, error = explicit.step(t, taken, y, k1, mode, p, work.rtol)
            exponent, evaluations = -1.0 / explicit.ORDER, explicit.STAGES - 1
        work.counts[0] += evaluations
        if not error <= 1.0:
            h = _shorter(taken, error, exponent)
            if h < SHORTEST * period:
                return State(t, y, mode, last_event, h), FAILED
            continue
        close = PLACE_OF_EVENT if taken == aim or to_event < inf else ROUGHLY
        share, number = first_event(step, mode, last_event, (at_middle, at_end), close, p, work)
        if number >= 0 and to_event == inf and (taken != aim or share < NEAR_END):
            to_event = (share + PAST_EVENT) * taken
            continue
        to_event = inf
        work.counts[1] += 1
        if work.counts[1] > most_steps:
            return State(t, y, mode, last_event, h), FAILED
        if keeping:
            record_step(step, share, mode, recorder, p)
        end = dense_output(share, step) if share < 1.0 else step.end
        # At events as well: friction may be strongest where its branch ends.
        if not well_posed(t + share * taken, end, mode, p):
            return State(t, y, mode, last_event, h), LOCKED
        if number >= 0:
            return State(t + share * taken, end, mode, last_event, h), number
        t = stop if taken == stop - t else t + taken
        y, k1, last_event = step.end, step.end_rate, NO_EVENT
        for i in range(event_count(p)):
            work.at_start[i] = work.at_end[i]
        expected = expected_event(at_end, t, y, mode, p)
        implicitly = implicitly or outruns(taken, y, p)
        h = _next_length(h, taken, longest, error, exponent)
    return State(stop, y, mode, last_event, h), NO_EVENT


@inner
def initial_state(t, y, p):
    """State at the start of a run, and whether it is well-posed."""
    mode, unique = initial_mode(t, y, p)
    return State(t, y, mode, np.int64(NO_EVENT), FIRST_STEP * 2.0 * pi / fastest(p)), unique


@inlined
def _follow_mode(state, stop, p, keeping, recorder, work):
    """As ``_integrate_mode``, by the method that is best for the mode."""
    t, y, mode, last_event, h = state
    if not only_first_move(y, mode, p):
        return _integrate_mode(state, stop, p, keeping, recorder, work)
    first = State(t, first_states(y, p), mode, last_event, h)
    if linear(mode, p):
        done, first, number = follow_linear(first, stop, p, keeping, recorder, work)
    else:
        done, first, number = follow(first, stop, p, keeping, recorder, work)
    if not done:
        first, number = _integrate_mode(first, stop, p, keeping, recorder, work)
    return State(first.t, with_first(y, first.y), mode, first.last_event, first.step), number


@inner
def integrate(state, keep_from, stop, p, recorder, work):
    """Follow a run from event to event up to ``stop``, and record the part from ``keep_from`` (s) on.

    Returns how it ended (OK, LOCKED, FAILED, CHATTERING) and the state reached.
    """
    periods = (stop - state.t) * fastest(p) / (2.0 * pi)
    if periods > LONGEST_WINDOW:
        return FAILED, state
    limit = work.counts[2] + EVENTS_PER_PERIOD * (1.0 + periods)
    forget(work.equations)
    work.constants[0] = nan
    while state.t < stop:
        keeping = state.t >= keep_from
        end = stop if keeping else keep_from
        state, number = _follow_mode(state, end, p, keeping, recorder, work)
        if number == NO_EVENT:
            continue
        if number < NO_EVENT:
            return number, state
        if keeping:
            add_impact(recorder.sums[0], state.y, state.mode, number, p)
        y, mode, unique = transition(state.t, state.y, state.mode, number, p)
        state = State(state.t, y, mode, number, state.step)
        work.counts[2] += 1
        if not unique:
            return LOCKED, state
        if work.counts[2] > limit:
            return CHATTERING, state
    return OK, state
