"""Slip under constant friction as a linear oscillator: its equations, solved.

    x'' = c0 + cx x + cu u''      N = n0 + nx x + nu u''  on either face
    x(t) = centre + forced sin(omega t) + A cos(Omega s) + B sin(Omega s),   s = t - start

A ``Phase`` is a point of the motion; rotations advance it.
"""

from math import inf, sqrt
from typing import NamedTuple

from wedgesweep import friction
from wedgesweep.compiled import inlined
from wedgesweep.effects import guide_friction
from wedgesweep.hybrid.search import Sample
from wedgesweep.systems.suspension.faces import coefficients
from wedgesweep.systems.suspension.modes import BOLSTER, COLUMN, GUIDE, VELOCITY, X
from wedgesweep.systems.suspension.newton import (
    UNIT_BASE,
    Coefficients,
    loads,
    loads_per_displacement,
    reactions,
)
from wedgesweep.trigonometry import cosine, sine, small_turn

# Relative distance of both squared frequencies below which the forced and the free part nearly cancel.
RESONANT = 1e-4


class NormalForce(NamedTuple):
    """Normal force of a face: n0 (N), nx (N/m), nu (kg)."""

    at_rest: float
    by_x: float
    by_u: float


class LinearOscillator(NamedTuple):
    """Linear equations of a mode and their solution, see the module's docstring; and how the mode ends."""

    linear: bool  # whether there is a closed form
    frequency: float  # Omega, rad/s
    centre: float  # m
    forced: float  # m
    column: NormalForce
    bolster: NormalForce
    column_mu: float  # signed, for T = mu N: with the sign of the normal force
    bolster_mu: float
    threshold: float  # |z'| at which the mode ends, m/s
    event: int  # number of that event function


# What is followed of a motion: z' and the normal forces on column and bolster face.
SLIP, COLUMN_FORCE, BOLSTER_FORCE = range(3)


@inlined
def _threshold(mode, p):
    """The |z'| (m/s) at which the first face of a slip mode reaches the end of its branch, and that event."""
    ratio, place, branch = p.geometry.column_ratio, COLUMN, mode.column
    if p.friction.set_valued:
        return 0.0, 2 * COLUMN if branch > 0 else 2 * COLUMN + 1
    v_t, across = p.friction.v_t, abs(p.geometry.bolster_ratio)
    if across != 0.0 and across < ratio:
        ratio, place, branch = across, BOLSTER, mode.bolster
    if guide_friction.acts(p) and ratio > 1.0:
        ratio, place, branch = 1.0, GUIDE, mode.guide
    return v_t / ratio, 2 * place if branch > 0 else 2 * place + 1


@inlined
def constant_friction(mode, p):
    """Whether no coefficient of friction depends on velocity in a mode."""
    if p.friction.set_valued:
        return True
    bolster = abs(mode.bolster) == 1 or p.geometry.bolster_ratio == 0.0
    guide = abs(mode.guide) == 1 or not guide_friction.acts(p)
    return friction.exponent(p) == 0.0 and abs(mode.column) == 1 and bolster and guide


@inlined
def linear_oscillator(y, mode, p):
    """Closed form of a mode of constant friction; ``linear`` is False near resonance."""
    omega = p.input.omega
    column_mu, bolster_mu = coefficients(0.0, y, mode, p)
    mu = Coefficients(mode.column_sign * column_mu, mode.bolster_sign * bolster_mu, 0.0, 0.0)
    at_rest = reactions(loads(0.0, (0.0, 0.0), mode, p), mu, p)[0]
    driven, by_x = reactions(UNIT_BASE, mu, p)[0], reactions(loads_per_displacement(p), mu, p)[0]
    square = -by_x.acceleration
    linear = square > 0.0 and abs(square - omega**2) > RESONANT * omega**2
    if not linear:
        square = inf
    threshold, event = _threshold(mode, p)
    return LinearOscillator(
        linear,
        sqrt(square),
        at_rest.acceleration / square,
        driven.acceleration * p.input.amplitude * omega**2 / (omega**2 - square),
        NormalForce(at_rest.column, by_x.column, driven.column),
        NormalForce(at_rest.bolster, by_x.bolster, driven.bolster),
        mu.column,
        mu.bolster,
        threshold,
        event,
    )


class Phase(NamedTuple):
    """Point of the motion: cosine and sine of the input's phase; free part of x and its quadrature (m)."""

    cosine: float
    sine: float
    free: float
    quadrature: float


@inlined
def phase_at(t, y, oscillator, p):
    """Phase of a state at time t."""
    c, s = cosine(p.input.omega * t), sine(p.input.omega * t)
    free = y[X] - oscillator.centre - oscillator.forced * s
    quadrature = (y[VELOCITY] - oscillator.forced * p.input.omega * c) / oscillator.frequency
    return Phase(c, s, free, quadrature)


@inlined
def rotated(phase, input_cos, input_sin, free_cos, free_sin):
    """Phase after the input and the free vibration have turned by angles given by their cosines and sines."""
    return Phase(
        phase.cosine * input_cos - phase.sine * input_sin,
        phase.sine * input_cos + phase.cosine * input_sin,
        phase.free * free_cos + phase.quadrature * free_sin,
        phase.quadrature * free_cos - phase.free * free_sin,
    )


@inlined
def turns(time, oscillator, p):
    """Cosines and sines of the angles by which input and free vibration turn in a short time (s)."""
    input_cos, input_sin = small_turn(p.input.omega * time)
    free_cos, free_sin = small_turn(oscillator.frequency * time)
    return input_cos, input_sin, free_cos, free_sin


@inlined
def advanced(phase, time, oscillator, p):
    """Phase some time (s) later, at most an interval of the scan."""
    return rotated(phase, *turns(time, oscillator, p))


@inlined
def motion(phase, oscillator, p):
    """Displacement (m) and velocity (m/s)."""
    x = oscillator.centre + oscillator.forced * phase.sine + phase.free
    return x, oscillator.forced * p.input.omega * phase.cosine + oscillator.frequency * phase.quadrature


@inlined
def _acceleration(phase, oscillator, p):
    """Relative acceleration x'' (m/s^2)."""
    return -oscillator.forced * p.input.omega**2 * phase.sine - oscillator.frequency**2 * phase.free


@inlined
def _jerk(phase, oscillator, p):
    """Its rate x''' (m/s^3)."""
    return -oscillator.forced * p.input.omega**3 * phase.cosine - oscillator.frequency**3 * phase.quadrature


@inlined
def snap(phase, oscillator, p):
    """The rate x'''' (m/s^4) of the jerk."""
    return oscillator.forced * p.input.omega**4 * phase.sine + oscillator.frequency**4 * phase.free


@inlined
def base_acceleration(phase, p):
    """Base acceleration u'' (m/s^2)."""
    return -p.input.amplitude * p.input.omega**2 * phase.sine


@inlined
def force_at(force, x, u2):
    """A normal force (N) at a displacement x (m) and a base acceleration u2 (m/s^2)."""
    return force.at_rest + force.by_x * x + force.by_u * u2


@inlined
def _force(which, oscillator):
    return oscillator.column if which == COLUMN_FORCE else oscillator.bolster


@inlined
def value_of(which, phase, oscillator, p):
    """The velocity (m/s) or a normal force (N), and its rate."""
    x, velocity = motion(phase, oscillator, p)
    if which == SLIP:
        return Sample(velocity, _acceleration(phase, oscillator, p))
    force = force_at(_force(which, oscillator), x, base_acceleration(phase, p))
    return Sample(force, rate_of(which, phase, oscillator, p).value)


@inlined
def rate_of(which, phase, oscillator, p):
    """The rate of the velocity or of a normal force, and the slope of that rate."""
    x2 = _acceleration(phase, oscillator, p)
    if which == SLIP:
        return Sample(x2, _jerk(phase, oscillator, p))
    force, base, omega = _force(which, oscillator), p.input.amplitude, p.input.omega
    velocity = motion(phase, oscillator, p)[1]
    return Sample(
        force.by_x * velocity - force.by_u * base * omega**3 * phase.cosine,
        force.by_x * x2 + force.by_u * base * omega**4 * phase.sine,
    )
