"""Slip under constant friction as a linear oscillator: its equations, solved.

    x'' = c0 + cx x + cu u''      N = n0 + nx x + nu u''  on either face
    x(t) = centre + forced sin(omega t) + A cos(Omega s) + B sin(Omega s),   s = t - start

A ``Phase`` is a point of the motion; rotations advance it.
"""

from math import inf, sqrt
from typing import NamedTuple

from wedgesweep import friction
from wedgesweep.compiled import inlined, inner
from wedgesweep.effects import guide_friction
from wedgesweep.systems.suspension.faces import coefficients
from wedgesweep.systems.suspension.modes import BOLSTER, COLUMN, GUIDE
from wedgesweep.systems.suspension.newton import Coefficients, Loads, loads, reactions
from wedgesweep.trigonometry import cosine, sine, small_turn

# Relative distance of both squared frequencies below which the forced and the free part nearly cancel.
RESONANT = 1e-4


class LinearOscillator(NamedTuple):
    """Linear equations of a mode and their solution, see the module's docstring; and how the mode ends."""

    linear: bool  # whether there is a closed form
    frequency: float  # Omega, rad/s
    centre: float  # m
    forced: float  # m
    driven: float  # cu
    column: float  # n0 (N), nx (N/m), nu (kg) of the column face
    column_x: float
    column_u: float
    bolster: float  # and of the bolster face
    bolster_x: float
    bolster_u: float
    column_mu: float  # signed, for T = mu N: with the sign of the normal force
    bolster_mu: float
    threshold: float  # |z'| at which the mode ends, m/s
    event: int  # number of that event function


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


@inner
def linear_oscillator(y, mode, p):
    """Closed form of a mode; ``linear`` is False if friction is not constant, or near resonance."""
    if not (p.geometry.always_well_posed and constant_friction(mode, p)):
        return LinearOscillator(False, inf, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1)
    s, g, omega = p.suspension, p.geometry, p.input.omega
    column_mu, bolster_mu = coefficients(0.0, y, mode, p)
    mu = Coefficients(mode.column_sign * column_mu, mode.bolster_sign * bolster_mu, 0.0, 0.0)
    at_rest = reactions(loads(0.0, (0.0, 0.0), mode, p), mu, p)[0]
    driven = reactions(Loads(0.0, 0.0, 0.0, 0.0, 0.0, 1.0), mu, p)[0]
    wedge = -s.wedge_spring * g.column_ratio * g.cos_column
    by_x = reactions(
        Loads(wedge * g.cos_column, wedge * g.sin_column, -s.bolster_spring, 0.0, 0.0, 0.0), mu, p
    )[0]
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
        driven.acceleration,
        at_rest.column,
        by_x.column,
        driven.column,
        at_rest.bolster,
        by_x.bolster,
        driven.bolster,
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
def input_turn(t, p):
    """Cosine and sine of the phase of the input."""
    return cosine(p.input.omega * t), sine(p.input.omega * t)


@inlined
def phase_of(turn, x, velocity, oscillator, p):
    """Phase of a state; ``turn``: ``input_turn`` at its time."""
    c, s = turn
    free = x - oscillator.centre - oscillator.forced * s
    quadrature = (velocity - oscillator.forced * p.input.omega * c) / oscillator.frequency
    return Phase(c, s, free, quadrature)


@inlined
def phase_at(t, x, velocity, oscillator, p):
    """Phase of a state at time t."""
    return phase_of(input_turn(t, p), x, velocity, oscillator, p)


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
def angles(time, oscillator, p):
    """Cosines and sines of the angles by which input and free vibration turn in some time (s)."""
    a, b = p.input.omega * time, oscillator.frequency * time
    return cosine(a), sine(a), cosine(b), sine(b)


@inner
def advanced(phase, time, oscillator, p):
    """Phase some time (s) later."""
    return rotated(phase, *angles(time, oscillator, p))


@inlined
def small_angles(time, oscillator, p):
    """As ``angles``, for at most an interval of the scan."""
    input_cos, input_sin = small_turn(p.input.omega * time)
    free_cos, free_sin = small_turn(oscillator.frequency * time)
    return input_cos, input_sin, free_cos, free_sin


@inlined
def advanced_briefly(phase, time, oscillator, p):
    """As ``advanced``, for at most an interval of the scan."""
    return rotated(phase, *small_angles(time, oscillator, p))


@inlined
def motion(phase, oscillator, p):
    """Displacement (m) and velocity (m/s)."""
    x = oscillator.centre + oscillator.forced * phase.sine + phase.free
    return x, oscillator.forced * p.input.omega * phase.cosine + oscillator.frequency * phase.quadrature


@inlined
def acceleration(phase, oscillator, p):
    """Relative acceleration x'' (m/s^2)."""
    return -oscillator.forced * p.input.omega**2 * phase.sine - oscillator.frequency**2 * phase.free


@inlined
def jerk(phase, oscillator, p):
    """Rate x''' of the ``acceleration`` (m/s^3)."""
    return -oscillator.forced * p.input.omega**3 * phase.cosine - oscillator.frequency**3 * phase.quadrature


@inlined
def snap(phase, oscillator, p):
    """Rate x'''' of the ``jerk`` (m/s^4)."""
    return oscillator.forced * p.input.omega**4 * phase.sine + oscillator.frequency**4 * phase.free


@inlined
def normal_forces(phase, oscillator, p):
    """Normal forces (N) on column and bolster face."""
    return _forces_at(motion(phase, oscillator, p)[0], base_acceleration(phase, p), oscillator)


@inlined
def _forces_at(x, u2, oscillator):
    column = oscillator.column + oscillator.column_x * x + oscillator.column_u * u2
    bolster = oscillator.bolster + oscillator.bolster_x * x + oscillator.bolster_u * u2
    return column, bolster


@inlined
def force_rates(phase, oscillator, p):
    """Rates of the ``normal_forces`` (N/s)."""
    velocity = motion(phase, oscillator, p)[1]
    u3 = -p.input.amplitude * p.input.omega**3 * phase.cosine
    return (
        oscillator.column_x * velocity + oscillator.column_u * u3,
        oscillator.bolster_x * velocity + oscillator.bolster_u * u3,
    )


@inlined
def force_accelerations(phase, oscillator, p):
    """Second derivatives of the ``normal_forces`` (N/s^2)."""
    x2 = acceleration(phase, oscillator, p)
    u4 = p.input.amplitude * p.input.omega**4 * phase.sine
    return (
        oscillator.column_x * x2 + oscillator.column_u * u4,
        oscillator.bolster_x * x2 + oscillator.bolster_u * u4,
    )


@inlined
def base_acceleration(phase, p):
    """Base acceleration u'' (m/s^2)."""
    return -p.input.amplitude * p.input.omega**2 * phase.sine


@inlined
def acceleration_at(x, u2, oscillator):
    """Acceleration z'' (m/s^2) at a displacement x (m) and a base acceleration u2 (m/s^2)."""
    return oscillator.driven * u2 - oscillator.frequency**2 * (x - oscillator.centre)


@inlined
def smaller_force_at(x, u2, oscillator):
    """The smaller one of both normal forces (N), likewise."""
    column, bolster = _forces_at(x, u2, oscillator)
    return min(column, bolster)
