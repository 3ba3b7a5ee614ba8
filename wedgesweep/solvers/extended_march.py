"""The extended system from one switch to the next."""

from math import pi

import numpy as np

from wedgesweep.compiled import compiled
from wedgesweep.excitation import fastest
from wedgesweep.extended import switching
from wedgesweep.extended.mode import AGE
from wedgesweep.solvers.extended_slide import slide
from wedgesweep.solvers.march import CHATTERING, FIRST_STEP, OK, SWITCHES_PER_PERIOD
from wedgesweep.solvers.runge_kutta import FAILED
from wedgesweep.solvers.sticking import LOCKED


@compiled
def march(t, y, mode, last_switch, h, stop, p, keeping, recorder, room):
    """Follow a case to ``stop``; y moves along.

    Returns the outcome (OK, LOCKED, FAILED, CHATTERING), time, mode, last switch and step reached.
    """
    limit = room.counts[2] + SWITCHES_PER_PERIOD * (1.0 + (stop - t) * fastest(p) / (2.0 * pi))
    while t < stop:
        t, switch, h = slide(t, stop, y, mode, last_switch, h, p, keeping, recorder, room)
        if switch < -1:
            return switch, t, mode, last_switch, h
        if switch == -1:
            continue
        mode, unique = switching.successor(t, y, mode, switch, p)
        last_switch = switch
        room.counts[2] += 1
        if not unique:
            return LOCKED, t, mode, last_switch, h
        if room.counts[2] > limit:
            return CHATTERING, t, mode, last_switch, h
    return OK, t, mode, last_switch, h


@compiled
def begin(t, y, p):
    """Mode at the start of a run, whether it is unique, and the first step (s)."""
    mode, unique = switching.initial(t, y, p)
    if not mode.clock:
        y[AGE] = 0.0
    return mode, unique, FIRST_STEP * 2.0 * pi / p.omega


@compiled
def follow(t, y, keep, end, p, recorder, room):
    """One case from a state to the end of its window: outcome and time; y moves along."""
    if not np.isfinite(p.rest):
        return FAILED, t
    mode, unique, h = begin(t, y, p)
    if not unique:
        return LOCKED, t
    last = -1
    outcome = OK
    if t < keep:
        outcome, t, mode, last, h = march(t, y, mode, last, h, keep, p, False, recorder, room)
    if outcome == OK and keep < end:
        outcome, t, mode, last, h = march(t, y, mode, last, h, end, p, True, recorder, room)
    return outcome, t
