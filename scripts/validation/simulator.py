"""An independent simulator of the wedge, with effects that are not among wedgesweep's candidates.

Newton's equations of the bolster and one wedge form a linear system for the acceleration z'' and both normal
forces. It is integrated by the classical Runge-Kutta method at a fixed step, without event location. Nothing
is shared with wedgesweep's mechanics, not even the constants. The additional effects:

    backlash   width: play of the bolster spring about its equilibrium, within which its force is constant
    drag       coefficient: force -c z'|z'| on the bolster
    drift      rise: friction grows by this share over the session, mostly during the first tests
"""

from math import cos, pi, radians, sin
from typing import NamedTuple

import numpy as np
from numba import njit

# Masses (kg), stiffnesses (N/m), angle (rad) and gravity (m/s^2) of the paper's suspension.
BOLSTER, WEDGE, BOLSTER_SPRING, WEDGE_SPRING = 0.70, 0.17, 5100.0, 2550.0
WEDGE_ANGLE, GRAVITY = radians(37.5), 9.80665
# mu_d, mu_s, threshold velocity (m/s) and exponent of the friction laws.
DYNAMIC, STATIC, THRESHOLD, EXPONENT = 0.29, 0.32, 1e-3, -0.1
COULOMB, STATIC_DYNAMIC, EXPONENTIAL = 0, 1, 2
LAWS = {"coulomb": COULOMB, "static-dynamic": STATIC_DYNAMIC, "exponential": EXPONENTIAL}
# The friction of a session approaches its last value with this time constant (share of the tests).
DRIFT_CONSTANT = 0.3


class System(NamedTuple):
    """The system of one test in SI units; ``friction`` scales both coefficients."""

    law: int
    column_angle: float  # rad
    amplitude: float
    omega: float
    width: float
    drag: float
    friction: float
    equilibrium: float


@njit(cache=True)
def friction_coefficient(v, s):
    """Signed coefficient at a slip velocity; 0 at rest."""
    if s.law == COULOMB:
        return s.friction * DYNAMIC * np.sign(v)
    if abs(v) <= THRESHOLD:
        return s.friction * STATIC * v / THRESHOLD
    fall = (abs(v) / THRESHOLD) ** EXPONENT if s.law == EXPONENTIAL else 1.0
    return s.friction * DYNAMIC * np.sign(v) * fall


@njit(cache=True)
def solve_newton(z, v, base_acceleration, mu, s):
    """z'', N_c and N_b by Cramer's rule; ``mu`` holds the coefficients of column and bolster face."""
    a, g = WEDGE_ANGLE, s.column_angle
    mu_c, mu_b = mu
    r = sin(a) / sin(a + g)
    deflection = z - s.equilibrium
    stretched = s.equilibrium + np.sign(deflection) * max(abs(deflection) - 0.5 * s.width, 0.0)
    wedge_force = -WEDGE_SPRING * r * z * cos(g)
    # Rows: wedge horizontally, wedge vertically, bolster vertically; columns: z'', N_c, N_b.
    a11, a12, a13 = -WEDGE * r * sin(g), cos(g) - mu_c * sin(g), -(cos(a) - mu_b * sin(a))
    a21, a22, a23 = WEDGE * r * cos(g), sin(g) + mu_c * cos(g), sin(a) + mu_b * cos(a)
    a31, a33 = BOLSTER, -2.0 * (sin(a) + mu_b * cos(a))
    b2 = wedge_force - WEDGE * (GRAVITY + base_acceleration)
    b3 = -BOLSTER_SPRING * stretched - s.drag * v * abs(v) - BOLSTER * (GRAVITY + base_acceleration)
    determinant = -a12 * (a21 * a33 - a23 * a31) + a22 * (a11 * a33 - a13 * a31)
    acceleration = (-a12 * (b2 * a33 - a23 * b3) + a22 * (-a13 * b3)) / determinant
    n_b = (b3 - a31 * acceleration) / a33
    n_c = (-a11 * acceleration - a13 * n_b) / a12
    return acceleration, n_c, n_b


@njit(cache=True)
def acceleration(t, z, v, direction, s):
    """Return z'' and the smaller normal force; ``direction`` is that of slip, for Coulomb's law only."""
    r = sin(WEDGE_ANGLE) / sin(WEDGE_ANGLE + s.column_angle)
    q = -sin(s.column_angle) / sin(WEDGE_ANGLE + s.column_angle)
    base_acceleration = -s.amplitude * s.omega**2 * sin(s.omega * t)
    slip = float(direction) if s.law == COULOMB else v
    mu = (friction_coefficient(r * slip, s), friction_coefficient(q * slip, s))
    z_second, n_c, n_b = solve_newton(z, v, base_acceleration, mu, s)
    return z_second, min(n_c, n_b)


@njit(cache=True)
def breakaway_direction(t, z, s):
    """Direction in which a bolster at rest starts to slip under Coulomb's law; 0 if it sticks."""
    if acceleration(t, z, 0.0, 1, s)[0] > 0.0:
        return 1
    return -1 if acceleration(t, z, 0.0, -1, s)[0] < 0.0 else 0


@njit(cache=True)
def runge_kutta_step(t, h, state, direction, s):
    """Return z and v one step ``h`` later."""
    z, v = state
    a1, _ = acceleration(t, z, v, direction, s)
    v2 = v + 0.5 * h * a1
    a2, _ = acceleration(t + 0.5 * h, z + 0.5 * h * v, v2, direction, s)
    v3 = v + 0.5 * h * a2
    a3, _ = acceleration(t + 0.5 * h, z + 0.5 * h * v2, v3, direction, s)
    v4 = v + h * a3
    a4, _ = acceleration(t + h, z + h * v3, v4, direction, s)
    return z + h / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4), v + h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4)


@njit(cache=True)
def simulate(s, h, skipped, stride, samples):
    """Start at rest, skip some steps of length ``h`` (s), then sample every ``stride`` steps.

    Returns z from its equilibrium and v, shape (2, samples), and the smallest normal force meanwhile.
    """
    z, v, least = s.equilibrium, 0.0, np.inf
    direction = breakaway_direction(0.0, z, s) if s.law == COULOMB else 1
    out = np.empty((2, samples))
    for n in range(skipped + stride * (samples - 1) + 1):
        t = n * h
        if n >= skipped and (n - skipped) % stride == 0:
            out[0, (n - skipped) // stride], out[1, (n - skipped) // stride] = z - s.equilibrium, v
        if direction == 0:
            direction = breakaway_direction(t + h, z, s)
            continue
        if n >= skipped:
            least = min(least, acceleration(t, z, v, direction, s)[1])
        last_z, last_v = z, v
        z, v = runge_kutta_step(t, h, (z, v), direction, s)
        if s.law == COULOMB and v * direction < 0.0:
            share = abs(last_v) / (abs(last_v) + abs(v))
            z, v = last_z + share * (z - last_z), 0.0
            direction = breakaway_direction(t + h, z, s)
    return out, least


def system(
    law: str, column_angle_deg: float, frequency: float, amplitude: float, effect: dict[str, float]
) -> System:
    """System of one test at a frequency (Hz) and an amplitude (m).

    ``effect`` may hold width (m), coefficient (N s^2/m^2) and friction (factor on both coefficients).
    """
    found = System(
        LAWS[law],
        radians(column_angle_deg),
        amplitude,
        2.0 * pi * frequency,
        effect.get("width", 0.0),
        effect.get("coefficient", 0.0),
        effect.get("friction", 1.0),
        0.0,
    )
    # Without friction and play the acceleration is linear in z: two values give its zero.
    linear = found._replace(width=0.0)
    low, high = (solve_newton(z, 0.0, 0.0, (0.0, 0.0), linear)[0] for z in (0.0, -1e-3))
    return found._replace(equilibrium=-1e-3 * low / (low - high))


def drifting_friction(rise: float, tests: int) -> np.ndarray:
    """Friction of consecutive tests over that of the model, shape (tests,)."""
    return 1.0 + rise * (1.0 - np.exp(-np.arange(tests) / (DRIFT_CONSTANT * tests)))
