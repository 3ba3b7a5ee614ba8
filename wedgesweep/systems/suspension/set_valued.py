"""Rest under a set-valued law: what holds the bolster, and which way it goes when friction lets go."""

from wedgesweep.compiled import inner
from wedgesweep.excitation import acceleration
from wedgesweep.systems.suspension.modes import ContactMode, slipping
from wedgesweep.systems.suspension.newton import ROUNDING, solve_for_signs

# Phase (rad) after which what has just passed zero is safely away from it.
LOOK_AHEAD = 1e-8


@inner
def breakaway(t, y, direction, stop, p):
    """Acceleration z'' (m/s^2) if set-valued friction let go in a direction, and whether it is unique."""
    _, now, unique = solve_for_signs(t, y, slipping(direction, stop, 1, p), p)
    return now.acceleration, unique


@inner
def mode_at_zero_velocity(t, y, stop, p):
    """Mode that follows z' = 0 under a set-valued law, and whether it is unique."""
    rising, forward_unique = breakaway(t, y, 1, stop, p)
    falling, backward_unique = breakaway(t, y, -1, stop, p)
    unique = forward_unique and backward_unique and not (rising > 0.0 and falling < 0.0)
    nearly_none = ROUNDING * (p.suspension.gravity + abs(acceleration(t, p)))
    if rising <= nearly_none and falling >= -nearly_none:
        return ContactMode(0, 0, 0, 1, 1, 0, stop, 1), unique
    mode, _, certain = solve_for_signs(t, y, slipping(1 if rising > 0.0 else -1, stop, 0, p), p)
    return mode, unique and certain


@inner
def breakaway_direction(t, y, direction, stop, p):
    """Direction in which the bolster leaves rest; with next to no friction the event may be noise."""
    ahead = t + LOOK_AHEAD / p.input.omega
    onward = direction * breakaway(ahead, y, direction, stop, p)[0]
    back = -direction * breakaway(ahead, y, -direction, stop, p)[0]
    return -direction if onward <= 0.0 < back else direction
