"""Rest under a set-valued law: what holds the bolster, and which way it goes when friction lets go."""

from wedgesweep.compiled import compiled
from wedgesweep.contact import LOOK_AHEAD, ROUNDING
from wedgesweep.excitation import table_acceleration
from wedgesweep.extended.mechanics import closed
from wedgesweep.extended.mode import Mode


@compiled
def slipping(direction, stop, clock, p):
    """Mode of a set-valued law as z' has the given sign; ``clock`` = 1: about to, still at rest."""
    ratio = p.bolster_ratio
    bolster = direction if ratio > 0.0 else -direction
    if ratio == 0.0:
        bolster = 0
    sign = direction if p.directional_friction_asymmetry != 0.0 else 0
    return Mode(direction, bolster, direction, 1, 1, sign, stop, clock)


@compiled
def breakaway(t, y, direction, stop, p):
    """Acceleration z'' (m/s^2) if set-valued friction let go in a direction, and whether it is unique."""
    _, now, unique = closed(t, y, slipping(direction, stop, 1, p), p)
    return now.acceleration, unique


@compiled
def from_rest(t, y, stop, p):
    """Mode that follows z' = 0 under a set-valued law, and whether it is unique."""
    rising, forward_unique = breakaway(t, y, 1, stop, p)
    falling, backward_unique = breakaway(t, y, -1, stop, p)
    unique = forward_unique and backward_unique and not (rising > 0.0 and falling < 0.0)
    nearly_none = ROUNDING * (p.gravity + abs(table_acceleration(t, p)))
    if rising <= nearly_none and falling >= -nearly_none:
        return Mode(0, 0, 0, 1, 1, 0, stop, 1), unique
    mode, _, certain = closed(t, y, slipping(1 if rising > 0.0 else -1, stop, 0, p), p)
    return mode, unique and certain


@compiled
def released(t, y, direction, stop, p):
    """Direction in which the bolster leaves rest; with next to no friction the switch may be noise."""
    ahead = t + LOOK_AHEAD / p.omega
    onward = direction * breakaway(ahead, y, direction, stop, p)[0]
    back = -direction * breakaway(ahead, y, -direction, stop, p)[0]
    return -direction if onward <= 0.0 < back else direction
