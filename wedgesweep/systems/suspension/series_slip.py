"""Follows a mode of slip in which friction depends on velocity and all else is linear, by power series.

They (power_series.py) go on beyond the end of a branch of friction, so that no step has to be repeated there.
"""

from math import inf, isfinite, log, pi, sqrt

from wedgesweep import excitation, friction
from wedgesweep.compiled import inlined, inner, term
from wedgesweep.effects import directional_friction, guide_friction, stribeck, travel
from wedgesweep.hybrid.interface import error_scales, fastest, linear
from wedgesweep.hybrid.polynomials import largest_change, polynomial
from wedgesweep.hybrid.recorded_step import record_step
from wedgesweep.hybrid.state import FAILED, NO_EVENT, State
from wedgesweep.hybrid.step import ABSOLUTE, SHORTEST, SeriesStep, step_limit
from wedgesweep.hybrid.vectors import with_motion
from wedgesweep.systems.suspension import newton
from wedgesweep.systems.suspension.modes import VELOCITY, X, held
from wedgesweep.systems.suspension.newton import UNIT_BASE, Closed, closed_contacts, loads, with_base
from wedgesweep.systems.suspension.power_series import (
    ORDER,
    Equations,
    Face,
    Motion,
    expand,
    expand_fading,
    expand_powers,
)
from wedgesweep.systems.suspension.series_events import ends_of_displacement, ends_of_velocity, first_event
from wedgesweep.traced import traced

# Least number of steps per period of the input; and while they are recorded, so that each has one extreme.
LEAST_STEPS, LEAST_STEPS_RECORDED = 6, 12
# The last term of a series, and a share of the one before it, limit a step, which is shorter by a factor.
LAST_BUT_ONE, SAFETY = 0.1, 0.8
# Order of the last term but one; numba multiplies out powers that are constants.
BEFORE = ORDER - 1
# By how much the logarithm of a decaying part of friction may change in a step: the last terms of the series
# of exp(5) tell what it leaves to a factor of 1.5.
MOST_GROWTH = 5.0
# A normal force stays positive in a step if its values at start, middle and end exceed this share of their
# second difference: a parabola stays above the least of them less a quarter of that share.
SECOND_DIFFERENCE = 0.5


# Equations


@traced
def _without_contact(load, closed):
    """What ``Equations`` hold, under loads."""
    return (
        load.tangential - closed.inertia * load.vertical - closed.along_base * load.base,
        load.normal - closed.into_base * load.base,
        closed.mobility * load.vertical - load.base,
    )


@inner
def _at(x, velocity, y, mode, closed, p):
    """The same at a displacement (m) and a velocity (m/s), without an acceleration of the table."""
    load = loads(0.0, with_motion(y, x, velocity), mode, p)
    return _without_contact(with_base(load, 0.0), closed)


@traced
def _change(before, after):
    return after[0] - before[0], after[1] - before[1], after[2] - before[2]


@inlined
def _normal_forces(load, column_mu, bolster_mu, closed):
    """Normal forces on column and bolster face (N), under a load of ``Equations``."""
    into = closed.into + bolster_mu * closed.into_mu
    along = closed.along + bolster_mu * closed.along_mu
    bolster = (column_mu * load[1] - load[0]) / (column_mu * into - along)
    return load[1] - into * bolster, bolster


@inlined
def _largest_coefficient(y, mode, p):
    """Largest coefficient of friction of both faces."""
    most = max(friction.static(mode.clock, y, p), friction.sliding(p.friction.v_t, p))
    return most * max(directional_friction.factor(1, p), directional_friction.factor(-1, p))


@inner
def _write_equations(y, mode, p, out):
    """Write ``Equations``, (24,)."""
    closed, by_displacement, by_velocity = closed_contacts(p), 0.0, 0.0
    at_rest = _at(0.0, 0.0, y, mode, closed, p)
    by_x = _change(at_rest, _at(1.0, 0.0, y, mode, closed, p))
    by_v = _change(at_rest, _at(0.0, 1.0, y, mode, closed, p))
    by_u = _without_contact(UNIT_BASE, closed)
    most, most_u = _largest_coefficient(y, mode, p), excitation.largest_acceleration(p)
    # Normal forces times the determinant are linear in all of these: least at a corner.
    for column_mu, bolster_mu in ((most, most), (most, -most), (-most, most), (-most, -most)):
        rest = _normal_forces(at_rest, column_mu, bolster_mu, closed)
        of_x = _normal_forces(by_x, column_mu, bolster_mu, closed)
        of_v = _normal_forces(by_v, column_mu, bolster_mu, closed)
        of_u = _normal_forces(by_u, column_mu, bolster_mu, closed)
        for face in range(2):
            margin = rest[face] - abs(of_u[face]) * most_u
            by_displacement = max(by_displacement, abs(of_x[face]) / margin if margin > 0.0 else inf)
            by_velocity = max(by_velocity, abs(of_v[face]) / margin if margin > 0.0 else inf)
    for i in range(3):
        out[i], out[i + 3], out[i + 6], out[i + 9] = at_rest[i], by_x[i], by_v[i], by_u[i]
    for i in range(10):
        out[i + 12] = closed[i]
    out[22], out[23] = by_displacement, by_velocity


@inlined
def _three(n, first):
    return n[first], n[first + 1], n[first + 2]


@inlined
def equations_of(y, mode, p, constants):
    """``Equations`` of a mode; ``constants`` (26,): those of the last one, and what they depend on.

    That is the segment of the travel, and the branch of the guide.
    """
    guide = mode.guide if guide_friction.acts(p) else 0
    of = constants
    if not (of[0] == of[0] and of[24] == mode.segment and of[25] == guide):  # NaN: none yet
        _write_equations(y, mode, p, of)
        of[24], of[25] = mode.segment, guide
    contacts = Closed(of[12], of[13], of[14], of[15], of[16], of[17], of[18], of[19], of[20], of[21])
    return Equations(_three(of, 0), _three(of, 3), _three(of, 6), _three(of, 9), contacts, (of[22], of[23]))


# Series


@inner
def _face(ratio, branch, y, mode, p):
    """Friction of a face whose slip velocity is ratio z'."""
    factor = directional_friction.factor(mode.direction, p)
    if ratio == 0.0:
        return Face(0.0, 0.0, 0.0, 0.0)
    if branch == 0:
        return Face(factor * ratio * friction.static(mode.clock, y, p) / p.friction.v_t, 0.0, 0.0, 0.0)
    speed, factor = abs(ratio * y[VELOCITY]), factor * branch
    excess = stribeck.excess(speed, p)
    of_law = friction.sliding(speed, p) - excess
    return Face(0.0, factor * of_law, factor * excess, branch * ratio * stribeck.decay(p))


@term("stribeck", off="expand(motion)", expand=expand)
def _expand_fading(motion, p):
    """``expand_fading``, for records that need its code."""
    return expand_fading(motion)


@inlined
def _expanded(t, y, mode, equations, p):
    """The series from a state on."""
    g, u2 = p.geometry, excitation.acceleration_expanded(t, p)
    column = _face(g.column_ratio, mode.column, y, mode, p)
    bolster = _face(g.bolster_ratio, mode.bolster, y, mode, p)
    motion = Motion(y[X], y[VELOCITY], u2, column, bolster, friction.exponent(p), equations)
    if _on_ramp(mode) or friction.is_constant(p):
        return expand(motion)
    if stribeck.acts(p):
        return _expand_fading(motion, p)
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


@term("stribeck", off="h")
def _before_growth(h, series, rtol, p):
    """Length (s) of a step, at most h, in which what falls with velocity stays negligible, or hardly grows.

    Its series begins as if it stayed negligible in a slip that becomes slower.
    """
    if not stribeck.acts(p):
        return h
    speed, change = abs(series.velocity[0]), largest_change(series.velocity, h)
    for ratio in (abs(p.geometry.column_ratio), abs(p.geometry.bolster_ratio)):
        growth = -stribeck.decay(p) * ratio * change
        if growth > MOST_GROWTH:
            share = stribeck.excess(ratio * speed, p) / friction.sliding(ratio * speed, p)
            less = min(max(MOST_GROWTH, log(rtol / share)) / growth, 1.0)
            h, change = less * h, less * change
    return h


@inlined
def _state_at(s, series, y):
    return with_motion(y, polynomial(series.x, s), polynomial(series.velocity, s))


@inner
def _smaller_force(t, y, mode, p):
    """The smaller one of both normal forces (N)."""
    now = newton.forces(t, y, mode, p)
    return min(now.column, now.bolster)


@inlined
def _may_unload(t, h, series, y, unloads, mode, p):
    """Whether a normal force may vanish in a step."""
    x = abs(series.x[0]) + largest_change(series.x, h)
    velocity = abs(series.velocity[0]) + largest_change(series.velocity, h)
    if unloads[0] * x + unloads[1] * velocity < 1.0:
        return False
    before = _smaller_force(t, _state_at(0.0, series, y), mode, p)
    middle = _smaller_force(t + 0.5 * h, _state_at(0.5 * h, series, y), mode, p)
    after = _smaller_force(t + h, _state_at(h, series, y), mode, p)
    return not min(before, middle, after) > SECOND_DIFFERENCE * abs(before - 2.0 * middle + after)


@inlined
def _first_event(series, h, last_event, ends, mode, p):
    """Time (s) and number of the first event in a step h (s)."""
    found = first_event(series.velocity, h, last_event, ends, p)
    if travel.acts(p):
        other = first_event(series.x, h, last_event, ends_of_displacement(mode, p), p)
        return other if other[0] < found[0] else found
    return found


@inlined
def follow_series(state, stop, p, keeping, recorder, work):
    """As ``interface.follow``, for a mode that ``has_series``, as long as both faces surely carry load."""
    t, y, mode, last_event, h = state
    period, ends = 2.0 * pi / fastest(p), ends_of_velocity(mode, p)
    equations = equations_of(y, mode, p, work.constants)
    longest = period / LEAST_STEPS_RECORDED if keeping else 2.0 * pi / (LEAST_STEPS * p.input.omega)
    most_steps = step_limit(work.counts[1], (stop - t) / period)
    while t < stop:
        series = _expanded(t, y, mode, equations, p)
        h = _before_growth(_length(series, longest, work.rtol, p), series, work.rtol, p)
        work.counts[0] += 1
        work.counts[1] += 1
        if not h >= SHORTEST * period or work.counts[1] > most_steps:
            return True, State(t, y, mode, last_event, h), FAILED
        taken = min(h, stop - t)
        if _may_unload(t, taken, series, y, equations.unloads, mode, p):
            return False, State(t, y, mode, last_event, h), NO_EVENT
        time, event = _first_event(series, taken, last_event, ends, mode, p)
        time = min(time, taken)
        if keeping:
            step = SeriesStep(t, taken, y, (series.x, series.velocity))
            record_step(step, time / taken, mode, recorder, p)
        y = _state_at(time, series, y)
        if event >= 0:
            return True, State(t + time, y, mode, last_event, h), event
        t, last_event = stop if taken == stop - t else t + taken, NO_EVENT
    return True, State(stop, y, mode, last_event, h), NO_EVENT


@inlined
def _on_ramp(mode):
    """Whether both faces slip below the threshold velocity."""
    return mode.column == 0 and mode.bolster == 0


@inlined
def has_series(mode, p):
    """Whether power series follow a mode that slips: not where friction is constant and all is linear."""
    if not (p.geometry.linear and excitation.is_harmonic(p)) or held(mode):
        return False
    if mode.column_sign < 0 or mode.bolster_sign < 0 or linear(mode, p):
        return False
    falls, exponent = stribeck.acts(p), friction.exponent(p)
    if p.friction.set_valued:
        return exponent == 0.0
    return _on_ramp(mode) or exponent == 0.0 or (isfinite(exponent) and not falls)
