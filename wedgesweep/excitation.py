"""Input: acceleration of the side frame (the paper's Eq. 4: u = a sin(omega t)), with the effects on it."""

from math import sin

from wedgesweep.compiled import inlined
from wedgesweep.effects import hooks


@inlined
def acceleration(t, p):
    """U'' in m/s^2 of the side frame, or of the table that carries it."""
    fundamental = -p.input.amplitude * p.input.omega**2 * sin(p.input.omega * t)
    return hooks.base_acceleration(fundamental, t, p)


@inlined
def fastest(p):
    """Highest angular frequency (rad/s) of the input."""
    return hooks.fastest(p.input.omega, p)
