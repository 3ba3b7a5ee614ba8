"""A bolster at rest under a set-valued law: whether it sticks, and in which direction it breaks away."""

from wedgesweep import friction
from wedgesweep.compiled import inlined, inner
from wedgesweep.excitation import acceleration
from wedgesweep.systems.suspension.modes import ContactMode, slipping, with_clock
from wedgesweep.systems.suspension.newton import ROUNDING, solve_for_signs

# Phase (rad) after which a quantity that passes zero now exceeds rounding errors.
LOOK_AHEAD = 1e-8


@inner
def about_to_slip(t, y, direction, segment, p):
    """Mode on the verge of slip in a direction, its forces, and whether they are unique."""
    return solve_for_signs(t, y, slipping(direction, segment, 1, p), p)


@inlined
def acceleration_on_breakaway(t, y, direction, segment, p):
    """Acceleration z'' (m/s^2) if the bolster broke away in a direction."""
    return about_to_slip(t, y, direction, segment, p)[1].acceleration


@inner
def mode_at_zero_velocity(t, y, segment, p):
    """Mode that follows z' = 0 under a set-valued law, and whether it is unique."""
    forward, rising, forward_unique = about_to_slip(t, y, 1, segment, p)
    backward, falling, backward_unique = about_to_slip(t, y, -1, segment, p)
    unique = forward_unique and backward_unique
    unique = unique and not (rising.acceleration > 0.0 and falling.acceleration < 0.0)
    nearly_none = ROUNDING * (p.suspension.gravity + abs(acceleration(t, p)))
    if rising.acceleration <= nearly_none and falling.acceleration >= -nearly_none:
        return ContactMode(0, 0, 0, 1, 1, 0, segment, 1), unique
    mode = with_clock(forward if rising.acceleration > 0.0 else backward, 0)
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
