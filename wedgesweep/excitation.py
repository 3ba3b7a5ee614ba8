"""Input: acceleration of the side frame (the paper's Eq. 4: u = a sin(omega t)), with the effects on it."""

from math import cos, sin

from wedgesweep.compiled import inlined
from wedgesweep.effects import hooks


@inlined
def sine_acceleration(t, p):
    """U'' (m/s^2) of the input's fundamental."""
    return -p.input.amplitude * p.input.omega**2 * sin(p.input.omega * t)


@inlined
def acceleration(t, p):
    """U'' in m/s^2 of the side frame, or of the table that carries it."""
    return hooks.base_acceleration(sine_acceleration(t, p), t, p)


@inlined
def jerk(t, p):
    """U''' (m/s^3) of the input's fundamental."""
    return -p.input.amplitude * p.input.omega**3 * cos(p.input.omega * t)


@inlined
def fastest(p):
    """Highest angular frequency (rad/s) of the input."""
    return hooks.fastest(p.input.omega, p)
