"""Compiled solver that goes from event to event: closed form where friction is constant, else Runge-Kutta.

The same contact states, forces and switches as the Radau solver; only the way from one switch to the
next is another.
"""

from math import pi
from time import perf_counter

import numpy as np

from wedgesweep import contact as contacts
from wedgesweep import tally
from wedgesweep.compiled import compiled
from wedgesweep.solvers import oscillator, runge_kutta
from wedgesweep.solvers.recorder import Recorder, keep_at_rest
from wedgesweep.solvers.runge_kutta import FAILED
from wedgesweep.solvers.sticking import LOCKED, release
from wedgesweep.solvers.trajectory import CaseError, Samples, Trajectory, Window

OK, CHATTERING = 0, -4
SWITCHES_PER_PERIOD = 1000
MESSAGES = {
    LOCKED: ("locked", "normal forces not unique: the wedge locks"),
    FAILED: ("solver_failure", "the step size became too small"),
    CHATTERING: ("solver_failure", f"more than {SWITCHES_PER_PERIOD} switches per period"),
}


@compiled
def march(t, stop, x, velocity, contact, last_switch, parameters, rtol, h, keeping, recorder, statistics):
    """Follow a case from one switch to the next up to ``stop``.

    Returns the outcome (OK, LOCKED, FAILED, CHATTERING), time, x, velocity, contact, last switch and step.
    ``statistics``: rate evaluations, steps, switches.
    """
    p = parameters[0]
    limit = statistics[2] + SWITCHES_PER_PERIOD * (1.0 + (stop - t) * p.omega / (2.0 * pi))
    while t < stop:
        began = t
        if contacts.stuck(contact, p):
            t, switch = release(t, stop, x, contact, parameters)
            if keeping:
                keep_at_rest(began, t, x, contact, recorder, p)
        else:
            constant = oscillator.constant_friction(contact, p)
            o = oscillator.oscillator(contact, p)
            if constant and o.linear and p.never_locks:
                x0, velocity0 = x, velocity
                t, x, velocity, switch = oscillator.slide(
                    t, stop, x, velocity, contact, o, p, last_switch
                )
                if keeping:
                    oscillator.keep(began, t, x0, velocity0, contact, o, recorder, p)
            else:
                t, x, velocity, switch, h = runge_kutta.slide(
                    t, stop, x, velocity, contact, p, rtol, h, last_switch, keeping, recorder, statistics
                )
        if switch == -1:
            continue
        if switch < -1:
            return switch, t, x, velocity, contact, last_switch, h
        if p.set_valued and switch < contacts.COLUMN_NORMAL:
            velocity = 0.0
        contact, unique = contacts.successor(t, x, velocity, contact, switch, p)
        last_switch = switch
        statistics[2] += 1
        if not unique:
            return LOCKED, t, x, velocity, contact, last_switch, h
        if statistics[2] > limit:
            return CHATTERING, t, x, velocity, contact, last_switch, h
    return OK, t, x, velocity, contact, last_switch, h


@compiled
def run(parameters, keep, end, start_x, start_velocity, rtol, recorder, statistics):
    """One case from a start to the end of its window; the outcome and the time reached."""
    p = parameters[0]
    contact, unique = contacts.initial(0.0, start_x, start_velocity, p)
    if not unique:
        return LOCKED, 0.0
    h = 2.0 * pi / p.omega / 1000.0
    outcome, t, x, velocity, contact, last, h = march(
        0.0, keep, start_x, start_velocity, contact, -1, parameters, rtol, h, False, recorder, statistics
    )
    if outcome == OK:
        outcome, t, x, velocity, contact, last, h = march(
            keep, end, x, velocity, contact, last, parameters, rtol, h, True, recorder, statistics
        )
    return outcome, t


def solve(
    parameters: np.ndarray,
    window: Window,
    rtol: float,
    time_limit: float,
    start: tuple[float, float] = (0.0, 0.0),
) -> Trajectory:
    """Run one case; arguments and errors as for ``radau.solve``."""
    times = window.sample_times
    samples = Samples(
        times, np.empty(times.size), np.empty(times.size), np.empty((times.size, 5), np.int8)
    )
    sums = tally.empty()
    recorder = Recorder(
        window.keep, times[1] - times[0], sums, samples.x, samples.velocity, samples.contact
    )
    statistics = np.zeros(3, np.int64)
    outcome, t = run(parameters, window.keep, window.end, *start, rtol, recorder, statistics)
    if outcome != OK:
        status, message = MESSAGES[outcome]
        raise CaseError(status, f"{message} (at t = {t:.6g} s)")
    names = ("rate_evaluations", "steps", "switches")
    return Trajectory(samples, sums, window.periods, dict(zip(names, statistics.tolist(), strict=True)))
