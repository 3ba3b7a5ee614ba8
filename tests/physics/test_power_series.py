"""Slip under friction that depends on velocity, with effects, as power series: against Newton's equations."""

from math import inf, pi

import numpy as np
import pytest

from tests.physics import compiled_mechanics as mechanics
from tests.physics.cases import OMEGA_N
from wedgesweep import excitation, friction
from wedgesweep.compiled import compiled
from wedgesweep.hybrid.polynomials import largest_change, polynomial, slope
from wedgesweep.systems.suspension import events as events_of
from wedgesweep.systems.suspension import (
    newton,
    parameters,
    series_events,
    series_slip,
)
from wedgesweep.systems.suspension.modes import ContactMode
from wedgesweep.systems.suspension.power_series import ORDER

AMPLITUDE, OMEGA = 0.4e-3, 0.7 * OMEGA_N
# Branches of column and bolster face, and a z' (in units of v_t) at which they hold.
MODES = [((0, 0), 0.4), ((0, 0), -0.9), ((1, 0), 3.0), ((-1, 0), -5.0), ((1, -1), 40.0), ((-1, 1), -90.0)]
LAWS = ["static-dynamic", "exponential"]


def case(law="static-dynamic", column_angle_deg=2.5, friction=None, **suspension):
    values = {"column_angle": column_angle_deg * pi / 180.0, **suspension}
    return parameters.compact(parameters.record(law, AMPLITUDE, OMEGA, values, friction or {}))


def mode_of(branches, guide=0, direction=0, segment=0):
    return ContactMode(*branches, guide, direction, 1, 1, segment, 1 if branches[0] == 0 else 0)


# Effects (SI), and what they add to a mode, as arguments of ``mode_of``.
DAMPER, GUIDE = {"viscous_damping": {"coefficient": 30.0}}, {"guide_friction": {"force": 2.0}}
STRIBECK = {"stribeck": {"peak": 0.05, "velocity": 5e-3}}
STOP = {"end_stop": {"clearance": 5e-5, "stiffness": 2e4}}
DIRECTION = {"directional_friction": {"asymmetry": 0.3}}
WITH_EFFECTS = [
    pytest.param("static-dynamic", DAMPER | GUIDE, (1, 0), {"guide": 1}, id="damper and guide"),
    pytest.param("exponential", GUIDE, (0, 0), {"guide": 0}, id="ramp of the guide"),
    pytest.param("static-dynamic", STRIBECK | DAMPER, (1, -1), {"guide": 1}, id="Stribeck"),
    pytest.param("static-dynamic", STRIBECK, (1, 0), {"guide": 1}, id="Stribeck beside a ramp"),
    pytest.param("exponential", STOP, (1, -1), {"segment": 1}, id="end stop"),
    pytest.param("exponential", DIRECTION, (1, -1), {"direction": 1}, id="direction"),
    pytest.param("coulomb", STRIBECK, (1, -1), {"guide": 1}, id="set-valued"),
]


def case_with(law, effects):
    """A case with room for every effect."""
    return mechanics.with_all_mechanics(parameters.record(law, AMPLITUDE, OMEGA, effects=effects))


@compiled
def values_and_slopes(coefficients, s):
    """Value, slope and bound of the change of a polynomial."""
    return polynomial(coefficients, s), slope(coefficients, s), largest_change(coefficients, s)


def test_polynomials_are_those_of_numpy():
    generator = np.random.default_rng(0)
    for terms in (2, 5, 8):
        c = generator.normal(size=terms)
        exact = np.polynomial.Polynomial(c)
        for s in (0.0, 0.3, 1.7):
            value, rate, change = values_and_slopes(tuple(c.tolist()), s)
            assert value == pytest.approx(exact(s), rel=1e-13)
            assert rate == pytest.approx(exact.deriv()(s), rel=1e-13)
            assert np.abs(exact(np.linspace(0.0, s, 101)) - c[0]).max() <= change * (1.0 + 1e-13)


@compiled
def newtons_forces(x, u2, column_mu, bolster_mu, cases):
    """Newton's forces under two coefficients of friction."""
    p, mode = cases[0], mode_while_closed()
    load = newton.loads(0.0, (x, 0.0), mode, p)
    load = newton.Loads(load.tangential, load.normal, load.vertical, 0.0, 0.0, u2)
    return newton.reactions(load, newton.Coefficients(column_mu, bolster_mu, 0.0, 0.0), p)[0]


@compiled
def mode_while_closed():
    return ContactMode(0, 0, 0, 0, 1, 1, 0, 1)


@compiled
def equations_of(y, mode, constants, cases):
    return series_slip.equations_of(y, mode, cases[0], constants)


def test_up_to_some_displacement_both_faces_surely_carry_load():
    cases, generator = case(), np.random.default_rng(2)
    unloads = equations_of((0.0, 0.0), mode_of((0, 0)), np.full(32, np.nan), cases).unloads
    assert unloads[1] == 0.0  # no force depends on velocity
    limits = [1.0 / unloads[0], AMPLITUDE * OMEGA**2, *(2 * [cases["friction"]["mu_s"][0]])]
    assert 0.0 < limits[0] < inf

    def least_force(share):
        now = newtons_forces(*(share * limits), cases)
        return min(now.column, now.bolster)

    assert min(map(least_force, generator.uniform(-1.0, 1.0, (200, 4)))) > 0.0
    corners = np.stack(np.meshgrid(*[[-1.0, 1.0]] * 4), axis=-1).reshape(-1, 4)
    assert min(map(least_force, corners)) == pytest.approx(0.0, abs=1e-9)


@compiled
def expanded(t, y, mode, constants, cases):
    """Series of a motion."""
    p = cases[0]
    return series_slip._expanded(t, y, mode, series_slip.equations_of(y, mode, p, constants), p)


def start(cases, velocity):
    return 1e-4, velocity * float(cases["friction"]["v_t"][0])


def check_series(t, y, mode, cases):
    """What a series leaves of Newton's equations falls with the power of time that it leaves out."""
    series = expanded(t, y, mode, np.full(32, np.nan), cases)
    assert len(series.velocity) == ORDER + 1
    assert (series.x[0], series.velocity[0], series.x[1]) == (*y[:2], y[1])
    # A time in which the velocity changes by a good part.
    span, left = 0.15 * min(abs(y[1] / series.velocity[1]), 1.0 / OMEGA), []
    for s in (span, 0.5 * span):
        x, v = (float(np.polynomial.Polynomial(each)(s)) for each in (series.x, series.velocity))
        newtons = mechanics.contact_forces(t + s, (x, v, *y[2:]), mode, cases[0]).acceleration
        left.append(abs(np.polynomial.Polynomial(series.velocity).deriv()(s) - newtons))
    assert left[0] < 1e-4 * abs(series.velocity[1])
    rounding = 1e-12 * OMEGA**2 * abs(y[0])
    assert left[1] < left[0] / (0.6 * 2.0**ORDER) + rounding


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize(("branches", "velocity"), MODES)
def test_a_series_solves_newtons_equations(law, branches, velocity):
    cases = case(law)
    check_series(0.013, start(cases, velocity), mode_of(branches), cases)


@pytest.mark.parametrize(("law", "effects", "branches", "more"), WITH_EFFECTS)
def test_a_series_solves_newtons_equations_with_effects(law, effects, branches, more):
    cases, speed = case_with(law, effects), {0: 4e-4, 1: 9e-3}[branches[0]]
    y = mechanics.initial_state(cases, {("", 0): 1e-4, ("", 1): speed})
    check_series(0.013, y, mode_of(branches, **more), cases)


def test_kept_equations_are_those_of_the_mode():
    """They depend on the segment of the travel and on the branch of the guide."""
    cases, kept = case_with("static-dynamic", STOP | GUIDE), np.full(32, np.nan)
    y = mechanics.initial_state(cases)
    for more in ({"segment": 1}, {"segment": 0}, {"guide": 1}, {"guide": 0}):
        mode = mode_of((1, -1), **more)
        assert equations_of(y, mode, kept, cases) == equations_of(y, mode, np.full(32, np.nan), cases)


@compiled
def base_acceleration(t, cases):
    """Its value and its series from a time on."""
    return excitation.acceleration(t, cases[0]), excitation.acceleration_expanded(t, cases[0])


def test_the_series_of_an_input_is_its_acceleration():
    cases, t = case("coulomb"), 0.013
    series = np.polynomial.Polynomial(base_acceleration(t, cases)[1])
    for s in (0.0, 0.1 / OMEGA):
        assert series(s) == pytest.approx(base_acceleration(t + s, cases)[0], rel=1e-9)


@compiled
def ends(mode, cases):
    """Ends of a mode."""
    return series_events.ends_of_velocity(mode, cases[0])


@compiled
def write_events(y, mode, cases, out):
    """Event functions of a state."""
    events_of.events(newton.forces(0.0, y, mode, cases[0]), 0.0, y, mode, cases[0], out)


@pytest.mark.parametrize("angle", [-6.0, 0.0, 2.5])
@pytest.mark.parametrize("branches", [(0, 0), (1, 0), (-1, 0), (1, -1), (-1, 1), (1, 1), (-1, -1)])
def test_a_mode_ends_where_its_event_functions_say(branches, angle):
    cases, mode, out = case(column_angle_deg=angle), mode_of(branches), np.empty(events_of.EVENTS)
    found = ends(mode, cases)
    for end, event, side in ((found.low, found.low_event, -1.0), (found.high, found.high_event, 1.0)):
        if not np.isfinite(end):
            continue
        for outward, holds in ((-1e-6, True), (1e-6, False)):
            write_events((0.0, end + side * outward * abs(end)), mode, cases, out)
            assert (out[event] > 0.0) == holds
    # Where faces end their branches at several velocities, the first one counts.
    if np.isfinite(found.low) and np.isfinite(found.high) and found.low < found.high:
        write_events((0.0, 0.5 * (found.low + found.high)), mode, cases, out)
        assert out[:4].min() > 0.0


def test_a_law_that_is_no_power_of_speed_has_no_series_beyond_its_ramp():
    assert np.isnan(exponent_of(case("static-dynamic"), "hyperbolic"))
    assert exponent_of(case("exponential"), "exponential") == pytest.approx(-0.1)


@compiled
def _exponent(cases):
    return friction.exponent(cases[0])


def exponent_of(cases, law):
    cases["friction"]["law"] = friction.code(law)
    return _exponent(cases)
