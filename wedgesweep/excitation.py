"""Motion of the side frame (the paper's Eq. 4): u = a sin(omega t)."""

from math import cos, sin

from wedgesweep.compiled import compiled, inlined


@compiled
def displacement(t, p):
    """U in m."""
    return p.amplitude * sin(p.omega * t)


@inlined
def acceleration(t, p):
    """U'' in m/s^2."""
    return -p.amplitude * p.omega**2 * sin(p.omega * t)


@compiled
def jerk(t, p):
    """U''' in m/s^3."""
    return -p.amplitude * p.omega**3 * cos(p.omega * t)
