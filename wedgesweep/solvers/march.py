"""From one switch to the next: closed form where friction is constant, Runge-Kutta elsewhere."""

from math import pi
from typing import Any, NamedTuple

import numpy as np

from wedgesweep import contact as contacts
from wedgesweep.compiled import compiled, inlined
from wedgesweep.damper import Contact
from wedgesweep.solvers import oscillator, runge_kutta
from wedgesweep.solvers.recorder import keep_at_rest
from wedgesweep.solvers.sticking import LOCKED, release

OK, CHATTERING = 0, -4
SWITCHES_PER_PERIOD = 1000
# The first step of a run is cautious: this share of a period.
FIRST_STEP = 1e-3


class State(NamedTuple):
    """Where a run is: time (s), deflection (m), velocity (m/s), contact, and how it got there.

    ``last_switch`` (-1: none) is the switch that led to this contact, ``step`` (s) what Runge-Kutta may try.
    """

    t: float
    x: float
    velocity: float
    contact: Contact
    last_switch: int
    step: float


class Work(NamedTuple):
    """What a run carries along: tolerance, counts (evaluations, steps, switches) and room for switches."""

    rtol: float
    counts: Any
    switches: Any
    trial: Any


def workspace(rtol: float) -> Work:
    """A fresh Work."""
    return Work(rtol, np.zeros(3, np.int64), np.empty(contacts.SWITCHES), np.empty(contacts.SWITCHES))


@compiled
def begin(t, x, velocity, p):
    """State at the start of a run, and whether its contact is unique."""
    contact, unique = contacts.initial(t, x, velocity, p)
    return State(t, x, velocity, contact, -1, FIRST_STEP * 2.0 * pi / p.omega), unique


@inlined
def _piece(state, stop, parameters, keeping, recorder, work):
    """Follow one contact to its first switch or ``stop``: time, x, velocity, switch (-1: none), step."""
    p = parameters[0]
    t, x, velocity, contact, last_switch, step = state
    if contacts.stuck(contact, p):
        end, switch = release(t, stop, x, contact, parameters)
        if keeping:
            keep_at_rest(t, end, x, contact, recorder, p)
        return end, x, velocity, switch, step
    o = oscillator.oscillator(contact, p)
    if not o.linear:
        return runge_kutta.slide(t, stop, x, velocity, contact, last_switch, step, p, keeping, recorder, work)
    end, x1, velocity1, switch = oscillator.slide(t, stop, x, velocity, contact, o, p, last_switch)
    if keeping:
        oscillator.keep(t, end, x, velocity, contact, o, recorder, p)
    return end, x1, velocity1, switch, step


@compiled
def march(state, stop, parameters, keeping, recorder, work):
    """Follow a case from one switch to the next up to ``stop``.

    Returns the outcome (OK, LOCKED, FAILED, CHATTERING) and the state reached.
    """
    p = parameters[0]
    limit = work.counts[2] + SWITCHES_PER_PERIOD * (1.0 + (stop - state.t) * p.omega / (2.0 * pi))
    while state.t < stop:
        t, x, velocity, switch, step = _piece(state, stop, parameters, keeping, recorder, work)
        if switch == -1:
            state = State(t, x, velocity, state.contact, state.last_switch, step)
            continue
        if switch < -1:
            return switch, state
        if p.set_valued and switch < contacts.COLUMN_NORMAL:
            velocity = 0.0
        contact, unique = contacts.successor(t, x, velocity, state.contact, switch, p)
        state = State(t, x, velocity, contact, switch, step)
        work.counts[2] += 1
        if not unique:
            return LOCKED, state
        if work.counts[2] > limit:
            return CHATTERING, state
    return OK, state
