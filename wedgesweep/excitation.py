"""Input: a force, or motion of the base (the paper's Eq. 4: u = a sin(omega t)), with the effects on it."""

from math import cos, sin

from wedgesweep.compiled import inlined
from wedgesweep.effects import hooks


@inlined
def acceleration(t, p):
    """U'' in m/s^2 of the side frame, or of the table that carries it."""
    fundamental = -p.input.amplitude * p.input.omega**2 * sin(p.input.omega * t)
    return hooks.base_acceleration(fundamental, t, p)


@inlined
def velocity(t, p):
    """U' in m/s."""
    return hooks.base_velocity(p.input.amplitude * p.input.omega * cos(p.input.omega * t), t, p)


@inlined
def displacement(t, p):
    """U in m."""
    return hooks.base_displacement(p.input.amplitude * sin(p.input.omega * t), t, p)


@inlined
def force(t, p):
    """Force on the mass in N, where the input is one and its amplitude in N."""
    return hooks.input_force(p.input.amplitude * sin(p.input.omega * t), t, p)


@inlined
def fastest(p):
    """Highest angular frequency (rad/s) of the input."""
    return hooks.fastest(p.input.omega, p)
