"""From one switch to the next: closed form where friction is constant, Runge-Kutta elsewhere."""

from math import pi

from wedgesweep import contact as contacts
from wedgesweep.compiled import compiled
from wedgesweep.solvers import oscillator, runge_kutta
from wedgesweep.solvers.recorder import keep_at_rest
from wedgesweep.solvers.sticking import LOCKED, release

OK, CHATTERING = 0, -4
SWITCHES_PER_PERIOD = 1000


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
                t, x, velocity, switch = oscillator.slide(t, stop, x, velocity, contact, o, p, last_switch)
                if keeping:
                    oscillator.keep(began, t, x0, velocity0, contact, o, recorder, p)
            else:
                t, x, velocity, switch, h = runge_kutta.slide(
                    t,
                    stop,
                    x,
                    velocity,
                    contact,
                    p,
                    rtol,
                    h,
                    last_switch,
                    keeping,
                    recorder,
                    statistics,
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
