"""One mode of the extended system, followed to its first switch.

After each step the switches are known at its start, middle and end; a switch that may have dipped below
zero between them is looked for. Each is located on the step's dense output.
"""

from math import inf, pi

from wedgesweep.compiled import compiled
from wedgesweep.excitation import fastest
from wedgesweep.extended.mode import SIZE, SWITCHES, stuck
from wedgesweep.extended.switches import one_switch, switches, switches_under
from wedgesweep.extended.switching import rate, unique
from wedgesweep.solvers import dormand_prince, rosenbrock
from wedgesweep.solvers.dormand_prince import connect, inside
from wedgesweep.solvers.extended_recorder import keep
from wedgesweep.solvers.runge_kutta import FAILED, GROW, LEAST, MOST_STEPS, SAFETY, SHORTEST, SHRINK
from wedgesweep.solvers.sticking import GOLDEN, LOCKED

# Steps per period of the fastest input while set-valued friction holds: nothing else limits them.
LEAST_STUCK = 64
# A dip is looked for where the parabola through three values falls below this share of the least.
SUSPECT = 0.3
CLOSE = 1e-14


@compiled
def _value(share, place, t, h, mode, p, room):
    return one_switch(place, t + share * h, inside(share, room), mode, p, room.at_point)


@compiled
def _dip(place, t, h, mode, p, room):
    """Share at which a switch is smallest within the step (golden section)."""
    low, high = 0.0, 1.0
    left, right = high - GOLDEN, low + GOLDEN
    at_left, at_right = _value(left, place, t, h, mode, p, room), _value(right, place, t, h, mode, p, room)
    while high - low > 1e-6:
        if at_left <= 0.0:
            return left
        if at_right <= 0.0:
            return right
        if at_left < at_right:
            high, right, at_right = right, left, at_left
            left = high - GOLDEN * (high - low)
            at_left = _value(left, place, t, h, mode, p, room)
        else:
            low, left, at_left = left, right, at_right
            right = low + GOLDEN * (high - low)
            at_right = _value(right, place, t, h, mode, p, room)
    return 0.5 * (low + high)


@compiled
def _zero(place, low, at_low, high, at_high, t, h, mode, p, room):
    """Share at which a switch is zero, positive at ``low`` and not at ``high`` (Illinois method)."""
    for _ in range(100):
        share = high - at_high * (high - low) / (at_high - at_low)
        if not low < share < high:
            share = 0.5 * (low + high)
        value = _value(share, place, t, h, mode, p, room)
        if value == 0.0 or high - low < CLOSE:
            return share
        if value > 0.0:
            if share - low < CLOSE:
                return share
            low, at_low = share, value
            at_high *= 0.5
        else:
            if high - share < CLOSE:
                return share
            high, at_high = share, value
            at_low *= 0.5
    return high


@compiled
def _crossing(place, low, at_low, high, at_high, from_zero, t, h, mode, p, room):
    """``_zero`` for a switch that may begin at zero; 0 if it has no positive part that can be seen."""
    if at_low > 0.0 and not from_zero:
        return _zero(place, low, at_low, high, at_high, t, h, mode, p, room)
    share = 0.5 * (low + high)
    while share * h * p.omega > 1e-13:
        value = _value(share, place, t, h, mode, p, room)
        if value > 0.0:
            return _zero(place, share, value, high, at_high, t, h, mode, p, room)
        high, at_high = share, value
        share *= 0.5
    return 0.0


@compiled
def _may_dip(before, now, following):
    """Whether a switch, positive at three even points, may have been zero between them."""
    if not before > now <= following:
        return False
    curvature = before - 2.0 * now + following
    return now - (following - before) ** 2 / (8.0 * curvature) < SUSPECT * now


@compiled
def first_switch(t, h, mode, last_switch, forces, p, room):
    """Share and place of the first switch of a step, ``forces`` at its end; (1, -1) if there is none."""
    switches(t + 0.5 * h, inside(0.5, room), mode, p, room.at_middle)
    switches_under(forces, t + h, room.end, mode, p, room.at_end)
    earliest, first = 1.0, -1
    for place in range(SWITCHES):
        start, middle, end = room.at_start[place], room.at_middle[place], room.at_end[place]
        if end == inf:
            continue
        from_zero = last_switch >= 0 and place // 2 == last_switch // 2
        zero = 2.0
        if middle <= 0.0:
            zero = _crossing(place, 0.0, start, 0.5, middle, from_zero, t, h, mode, p, room)
        elif start > 0.0 and _may_dip(start, middle, end):
            dip = _dip(place, t, h, mode, p, room)
            value = _value(dip, place, t, h, mode, p, room)
            if value <= 0.0:
                zero = _crossing(place, 0.0, start, dip, value, from_zero, t, h, mode, p, room)
        if zero > 1.0 and end <= 0.0:
            zero = _zero(place, 0.5, middle, 1.0, end, t, h, mode, p, room)
        if zero <= 1.0 and (first < 0 or zero < earliest):
            earliest, first = zero, place
    return earliest, first


@compiled
def _step(t, h, y, mode, implicit, p, room):
    """A step with its dense output; the error over the tolerance, and the forces at the end."""
    if implicit:
        return rosenbrock.step(t, h, y, mode, p, room)
    error, forces = dormand_prince.step(t, h, y, mode, p, room)
    if error <= 1.0:
        connect(h, y, room)
    return error, forces


@compiled
def slide(t, stop, y, mode, last_switch, h, p, keeping, recorder, room):
    """Follow a mode until its first switch or ``stop``, beginning with a step h (s); y moves along.

    Returns time, the switch (-1: none, LOCKED, FAILED) and the step to go on with.
    """
    longest = 2.0 * pi / (fastest(p) * LEAST_STUCK if stuck(mode, p) else fastest(p) * LEAST)
    forces = rate(t, y, mode, p, room.stages[0])
    switches_under(forces, t, y, mode, p, room.at_start)
    most = room.counts[1] + MOST_STEPS * (1.0 + (stop - t) * fastest(p) / (2.0 * pi))
    implicit = rosenbrock.stiff(mode, p)
    if implicit and last_switch >= 0:
        h = min(h, rosenbrock.first_step(p))
    while t < stop:
        exponent = -0.25 if implicit else -0.2
        h = min(h, longest)
        taken = min(h, stop - t)
        error, forces = _step(t, taken, y, mode, implicit, p, room)
        if not error <= 1.0:
            h = taken * max(SHRINK, SAFETY * error**exponent) if error < inf else taken * SHRINK
            if h < SHORTEST * longest:
                return t, FAILED, h
            continue
        room.counts[1] += 1
        if room.counts[1] > most:
            return t, FAILED, h
        share, place = first_switch(t, taken, mode, last_switch, forces, p, room)
        if keeping:
            keep(t, taken, share, mode, recorder, p, room)
        if place >= 0:
            if share < 1.0:
                y[:] = inside(share, room)
            else:
                y[:] = room.end
            return t + share * taken, place, h
        if not unique(t + taken, room.end, mode, p):
            return t, LOCKED, h
        t = stop if taken == stop - t else t + taken
        for i in range(SIZE):
            y[i], room.stages[0, i] = room.end[i], room.stages[-1, i]
        room.at_start[:] = room.at_end
        last_switch = -1
        implicit = implicit or rosenbrock.outrun(taken, y, p)
        grown = taken * min(GROW, SAFETY * max(error, 1e-10) ** exponent)
        h = max(h, grown) if taken < h else grown
    return stop, -1, h
