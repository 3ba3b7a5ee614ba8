"""Follows a mode of a regularised law in the base model where friction depends on velocity.

On the ramp and beyond it power series (power_series.py) make the steps. They go on beyond the end of a branch
of friction, so that no step has to be repeated there.
"""

from math import inf, isfinite, pi, sqrt

from wedgesweep import excitation, friction
from wedgesweep.compiled import inlined, inner
from wedgesweep.effects import guide_friction
from wedgesweep.hybrid.interface import error_scales
from wedgesweep.hybrid.polynomials import largest_change, polynomial
from wedgesweep.hybrid.recorded_step import record_step
from wedgesweep.hybrid.state import FAILED, NO_EVENT, State
from wedgesweep.hybrid.step import ABSOLUTE, SHORTEST, SeriesStep, step_limit
from wedgesweep.systems.suspension import newton
from wedgesweep.systems.suspension.modes import HELD
from wedgesweep.systems.suspension.newton import UNIT_BASE, closed_contacts, loads, loads_per_displacement
from wedgesweep.systems.suspension.power_series import ORDER, Equations, Face, Motion, expand, expand_powers
from wedgesweep.systems.suspension.series_events import ends_of, first_event

# Least number of steps per period of the input; and while they are recorded, so that each has one extreme.
LEAST_STEPS, LEAST_STEPS_RECORDED = 6, 12
# The last term of a series, and a share of the one before it, limit a step, which is shorter by a factor.
LAST_BUT_ONE, SAFETY = 0.1, 0.8
# Order of the last term but one; numba multiplies out powers that are constants.
BEFORE = ORDER - 1
# A normal force stays positive in a step if its values at start, middle and end exceed this share of their
# second difference: a parabola stays above the least of them less a quarter of that share.
SECOND_DIFFERENCE = 0.5


@inlined
def _face(ratio, branch, y, mode, p):
    """Friction of a face whose slip velocity is ratio z'."""
    if branch == 0:
        return Face(ratio * friction.static(mode.clock, y, p) / p.friction.v_t, 0.0)
    return Face(0.0, branch * friction.sliding(abs(ratio * y[1]), p))


@inlined
def _without_contact(load, closed):
    """What ``Equations`` hold, under loads."""
    return (
        load.tangential - closed.inertia * load.vertical - closed.along_base * load.base,
        load.normal - closed.into_base * load.base,
        closed.mobility * load.vertical - load.base,
    )


@inlined
def _normal_forces(load, column_mu, bolster_mu, closed):
    """Normal forces on column and bolster face (N), under a load of ``Equations``."""
    into = closed.into + bolster_mu * closed.into_mu
    along = closed.along + bolster_mu * closed.along_mu
    bolster = (column_mu * load[1] - load[0]) / (column_mu * into - along)
    return load[1] - into * bolster, bolster


@inner
def equations_of(mode, p):
    """``Equations`` of a case without friction of the guide, which would depend on the mode."""
    closed, loaded = closed_contacts(p), inf
    at_rest = _without_contact(loads(0.0, (0.0, 0.0), mode, p), closed)
    by_x = _without_contact(loads_per_displacement(p), closed)
    by_u = _without_contact(UNIT_BASE, closed)
    most = max(friction.static(mode.clock, (0.0, 0.0), p), friction.sliding(p.friction.v_t, p))
    most_u = p.input.amplitude * p.input.omega**2
    # Normal forces times the determinant are linear in x, u'' and each coefficient: least at a corner.
    for column_mu, bolster_mu in ((most, most), (most, -most), (-most, most), (-most, -most)):
        rest = _normal_forces(at_rest, column_mu, bolster_mu, closed)
        of_x = _normal_forces(by_x, column_mu, bolster_mu, closed)
        of_u = _normal_forces(by_u, column_mu, bolster_mu, closed)
        for face in range(2):
            loaded = min(loaded, (rest[face] - abs(of_u[face]) * most_u) / abs(of_x[face]))
    return Equations(at_rest, by_x, by_u, closed, loaded)


@inlined
def _motion(t, y, mode, equations, p):
    """What the series from a state on begins with."""
    g, square = p.geometry, p.input.omega**2
    column = _face(g.column_ratio, mode.column, y, mode, p)
    bolster = _face(g.bolster_ratio, mode.bolster, y, mode, p)
    u2, u3 = excitation.acceleration(t, p), -square * excitation.velocity(t, p)
    return Motion(y[0], y[1], u2, u3, square, column, bolster, friction.exponent(p), equations)


@inlined
def _expanded(t, y, mode, equations, p):
    """The series from a state on."""
    motion = _motion(t, y, mode, equations, p)
    if motion.exponent == 0.0 or (mode.column == 0 and mode.bolster == 0):
        return expand(motion)
    return expand_powers(motion)


@inlined
def _length(series, longest, rtol, p):
    """Length (s) of a step, at most ``longest``, whose last term is within the tolerance."""
    scales, v = error_scales(p), series.velocity
    last = (abs(v[ORDER]) * longest + LAST_BUT_ONE * abs(v[BEFORE])) * longest**BEFORE
    of_x = last * longest / (ORDER + 1) / (abs(series.x[0]) + ABSOLUTE * scales[0])
    error = max(of_x, last / (abs(v[0]) + ABSOLUTE * scales[1])) / rtol
    # An eighth root in place of a seventh one, which takes longer: the safety factor covers the difference.
    return longest if error <= 1.0 else SAFETY * longest / sqrt(sqrt(sqrt(error)))


@inlined
def _state_at(s, series):
    return polynomial(series.x, s), polynomial(series.velocity, s)


@inner
def _smaller_force(t, y, mode, p):
    """The smaller one of both normal forces (N)."""
    now = newton.forces(t, y, mode, p)
    return min(now.column, now.bolster)


@inlined
def _may_unload(t, h, series, loaded, mode, p):
    """Whether a normal force may vanish in a step."""
    if abs(series.x[0]) + largest_change(series.x, h) < loaded:
        return False
    before = _smaller_force(t, _state_at(0.0, series), mode, p)
    middle = _smaller_force(t + 0.5 * h, _state_at(0.5 * h, series), mode, p)
    after = _smaller_force(t + h, _state_at(h, series), mode, p)
    return not min(before, middle, after) > SECOND_DIFFERENCE * abs(before - 2.0 * middle + after)


@inlined
def follow_series(state, stop, equations, p, keeping, recorder, work):
    """Follow a mode as long as both faces surely carry load.

    Returns whether this led to its event or ``stop``, the state reached, and the event, NO_EVENT or FAILED.
    """
    t, y, mode, last_event, h = state
    period, ends = 2.0 * pi / p.input.omega, ends_of(mode, p)
    longest = period / (LEAST_STEPS_RECORDED if keeping else LEAST_STEPS)
    most_steps = step_limit(work.counts[1], (stop - t) / period)
    while t < stop:
        series = _expanded(t, y, mode, equations, p)
        h = _length(series, longest, work.rtol, p)
        work.counts[0] += 1
        work.counts[1] += 1
        if not h >= SHORTEST * period or work.counts[1] > most_steps:
            return True, State(t, y, mode, last_event, h), FAILED
        taken = min(h, stop - t)
        if _may_unload(t, taken, series, equations.loaded, mode, p):
            return False, State(t, y, mode, last_event, h), NO_EVENT
        time, event = first_event(series.velocity, taken, last_event, ends, p)
        time = min(time, taken)
        if keeping:
            step = SeriesStep(t, taken, y, (series.x, series.velocity))
            record_step(step, time / taken, mode, recorder, p)
        y = _state_at(time, series)
        if event >= 0:
            return True, State(t + time, y, mode, last_event, h), event
        t, last_event = stop if taken == stop - t else t + taken, NO_EVENT
    return True, State(stop, y, mode, last_event, h), NO_EVENT


@inlined
def has_series(mode, p):
    """Whether power series follow a mode: friction of the faces is linear in z', or a power of it."""
    if (
        p.friction.set_valued
        or abs(mode.column) == HELD
        or abs(mode.bolster) == HELD
        or guide_friction.acts(p)
    ):
        return False
    if mode.column_sign < 0 or mode.bolster_sign < 0:
        return False
    return (mode.column == 0 and mode.bolster == 0) or isfinite(friction.exponent(p))
