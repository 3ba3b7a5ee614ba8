"""A bolster at rest under a set-valued law: whether it sticks, and in which direction it breaks away."""

from math import isnan, nan

from wedgesweep import friction
from wedgesweep.compiled import inlined, inner, term
from wedgesweep.excitation import acceleration
from wedgesweep.hybrid.vectors import replaced
from wedgesweep.systems.shared import LOOK_AHEAD, ROUNDING
from wedgesweep.systems.suspension.faces import coefficients
from wedgesweep.systems.suspension.modes import CLOCK, ContactMode, slipping
from wedgesweep.systems.suspension.newton import (
    UNIT_BASE,
    Coefficients,
    loads,
    reactions,
    solve_for_signs,
    with_base,
)


@inner
def about_to_slip(t, y, direction, segment, p):
    """Mode on the verge of slip in a direction, its forces, and whether they are unique."""
    return solve_for_signs(t, y, slipping(direction, segment, 1, p), p)


@inlined
def acceleration_on_breakaway(t, y, direction, segment, p):
    """Acceleration z'' (m/s^2) of a breakaway in a direction, less what locked-in forces hold back."""
    return (
        about_to_slip(t, y, direction, segment, p)[1].acceleration + _locked_in(y, direction, segment, p)[1]
    )


@inner
def _balance(load, column_mu, bolster_mu, p):
    """Base acceleration at which z'' = 0, and z'' per base acceleration.

    NaN if a normal force is negative there.
    """
    mu = Coefficients(column_mu, bolster_mu, 0.0, 0.0)
    at_rest = reactions(with_base(load, 0.0), mu, p)[0].acceleration
    inertia = reactions(UNIT_BASE, mu, p)[0].acceleration
    limit = -at_rest / inertia
    there = reactions(with_base(load, limit), mu, p)[0]
    return limit if min(there.column, there.bolster) > 0.0 else nan, inertia


@inner
def _verge(y, direction, segment, p):
    """Loads and signed coefficients of a stuck bolster that is about to slip in a direction."""
    mode = slipping(direction, segment, 1, p)
    column_mu, bolster_mu = coefficients(0.0, y, mode, p)
    return loads(0.0, y, mode, p), column_mu, bolster_mu


@term("jamming", off="(0.0, 0.0)")
def _locked_in(y, direction, segment, p):
    """What locked-in forces delay a breakaway by: base acceleration, and z'' that they take (m/s^2)."""
    if p.jamming.locked_in == 0.0:  # on a compliant table no base acceleration holds the bolster by itself
        return 0.0, 0.0
    load, column_mu, bolster_mu = _verge(y, direction, segment, p)
    least, inertia = _balance(load, column_mu, bolster_mu, p)
    most = least
    for column_sign, bolster_sign in ((1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)):
        other = _balance(load, column_sign * column_mu, bolster_sign * bolster_mu, p)[0]
        if direction * (most - other) > 0.0:
            most = other
    delay = 0.0 if isnan(least) else p.jamming.locked_in * (most - least)
    return delay, -inertia * delay


@inner
def breakaway_input(y, direction, segment, p):
    """Base acceleration at which a stuck bolster slips in a direction; NaN if a normal force is negative.

    ``segment`` of the travel of the bolster.
    """
    load, column_mu, bolster_mu = _verge(y, direction, segment, p)
    return _balance(load, column_mu, bolster_mu, p)[0] + _locked_in(y, direction, segment, p)[0]


@inner
def mode_at_zero_velocity(t, y, segment, p):
    """Mode that follows z' = 0 under a set-valued law, and whether it is unique."""
    forward, rising, forward_unique = about_to_slip(t, y, 1, segment, p)
    backward, falling, backward_unique = about_to_slip(t, y, -1, segment, p)
    unique = forward_unique and backward_unique
    unique = unique and not (rising.acceleration > 0.0 and falling.acceleration < 0.0)
    upward = rising.acceleration + _locked_in(y, 1, segment, p)[1]
    downward = falling.acceleration + _locked_in(y, -1, segment, p)[1]
    nearly_none = ROUNDING * (p.suspension.gravity + abs(acceleration(t, p)))
    if upward <= nearly_none and downward >= -nearly_none:
        return ContactMode(0, 0, 0, 0, 1, 1, segment, 1), unique
    mode = replaced(forward if upward > 0.0 else backward, CLOCK, 0)
    if friction.static(1, y, p) == friction.sliding(0.0, p):
        return mode, unique
    mode, _, certain = solve_for_signs(t, y, mode, p)
    return mode, unique and certain


@inner
def breakaway_direction(t, y, direction, segment, p):
    """Direction of breakaway: that of the event, unless a moment later only the other one accelerates.

    With hardly any friction the direction of the event may be noise.
    """
    ahead = t + LOOK_AHEAD / p.input.omega
    onward = direction * acceleration_on_breakaway(ahead, y, direction, segment, p)
    back = -direction * acceleration_on_breakaway(ahead, y, -direction, segment, p)
    return -direction if onward <= 0.0 < back else direction
