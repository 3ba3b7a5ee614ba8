"""Time at which a bolster that set-valued friction holds breaks away, without integration (base model).

While it sticks only the base moves: it sticks between two base accelerations. As long as both normal forces
stay positive these are known, and so are the phases at which a harmonic base motion reaches them.
"""

from math import asin, ceil, inf, pi

from wedgesweep.compiled import inlined, inner
from wedgesweep.effects import fixture_resonance
from wedgesweep.hybrid.state import NO_EVENT
from wedgesweep.systems.suspension.modes import COLUMN
from wedgesweep.systems.suspension.set_valued import breakaway_input
from wedgesweep.trigonometry import sine

DOWN, UP = 2 * COLUMN, 2 * COLUMN + 1


@inner
def breakaway_range(y, segment, p):
    """Base accelerations (m/s^2) below which a stuck bolster slips up, and above which it slips down.

    Also whether both faces carry load between them; else the bolster may leave in another way.
    """
    forward, backward = breakaway_input(y, 1, segment, p), breakaway_input(y, -1, segment, p)
    return forward, backward, p.geometry.always_well_posed != 0 and forward < backward


@inlined
def carries_load_until_breakaway(y, segment, p):
    """Whether both faces carry load until a stuck bolster breaks away, whatever its direction.

    On a compliant table the side frame moves, and with it the load: nothing is known in advance.
    """
    if fixture_resonance.acts(p):
        return False
    return breakaway_range(y, segment, p)[2]


@inner
def breakaway_between(forward, backward, t, stop, p):
    """Time at which a stuck bolster breaks away, and the event: NO_EVENT if nothing happens before ``stop``.

    It slips up at base accelerations below ``forward``, and down above ``backward`` (m/s^2).
    """
    omega = p.input.omega
    most = p.input.amplitude * omega**2
    upper, lower = -forward / most, -backward / most  # of sin(omega t)
    phase = omega * t
    if sine(phase) > upper:
        return t, UP
    if sine(phase) < lower:
        return t, DOWN
    turn = 2.0 * pi
    rising = falling = inf
    if upper < 1.0:
        rising = asin(upper)
        rising += turn * ceil((phase - rising) / turn)
    if lower > -1.0:
        falling = pi - asin(lower)
        falling += turn * ceil((phase - falling) / turn)
    moment = min(rising, falling) / omega
    if moment >= stop:
        return stop, NO_EVENT
    return moment, UP if rising < falling else DOWN
