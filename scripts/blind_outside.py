"""An independent simulator of the wedge with effects that wedgesweep does not know.

Newton's equations of PHYSICS.md as one linear system for z'' and both normal forces, Runge and Kutta's
method at a fixed step, no located switches. Shares nothing with wedgesweep. Effects:

    backlash   width: play of the bolster spring about the place of rest, where its force does not change
    drag       coefficient: force -c z'|z'| on the bolster
    drift      rise: friction grows by this share over the session, most of it in the first tests
"""

from math import cos, pi, radians, sin
from typing import NamedTuple

import numpy as np
from numba import njit

BOLSTER, WEDGE, BOLSTER_SPRING, WEDGE_SPRING = 0.70, 0.17, 5100.0, 2550.0
WEDGE_ANGLE, GRAVITY = radians(37.5), 9.80665
DYNAMIC, STATIC, THRESHOLD, EXPONENT = 0.29, 0.32, 1e-3, -0.1
COULOMB, STATIC_DYNAMIC, EXPONENTIAL = 0, 1, 2
LAWS = {"coulomb": COULOMB, "static-dynamic": STATIC_DYNAMIC, "exponential": EXPONENTIAL}
# A session's friction is within e^-1 of its last value after this share of the tests.
SETTLES = 0.3


class System(NamedTuple):
    """One test's system; ``friction`` scales both coefficients."""

    law: int
    lean: float  # rad
    amplitude: float
    omega: float
    width: float
    drag: float
    friction: float
    rest: float


@njit(cache=True)
def friction_coefficient(v, s):
    """Signed coefficient at a slip velocity; at rest 0."""
    if s.law == COULOMB:
        return s.friction * DYNAMIC * np.sign(v)
    if abs(v) <= THRESHOLD:
        return s.friction * STATIC * v / THRESHOLD
    fall = (abs(v) / THRESHOLD) ** EXPONENT if s.law == EXPONENTIAL else 1.0
    return s.friction * DYNAMIC * np.sign(v) * fall


@njit(cache=True)
def solve_newton(z, v, base, mu_c, mu_b, s):
    """z'', N_c and N_b by Cramer's rule for given coefficients (both normal forces pressing)."""
    a, g = WEDGE_ANGLE, s.lean
    r = sin(a) / sin(a + g)
    play = z - s.rest
    spring = s.rest + np.sign(play) * max(abs(play) - 0.5 * s.width, 0.0)
    wedge = -WEDGE_SPRING * r * z * cos(g)
    # Rows: wedge sideways, wedge upward, bolster upward; columns: z'', N_c, N_b.
    a11, a12, a13 = -WEDGE * r * sin(g), cos(g) - mu_c * sin(g), -(cos(a) - mu_b * sin(a))
    a21, a22, a23 = WEDGE * r * cos(g), sin(g) + mu_c * cos(g), sin(a) + mu_b * cos(a)
    a31, a33 = BOLSTER, -2.0 * (sin(a) + mu_b * cos(a))
    b2 = wedge - WEDGE * (GRAVITY + base)
    b3 = -BOLSTER_SPRING * spring - s.drag * v * abs(v) - BOLSTER * (GRAVITY + base)
    whole = -a12 * (a21 * a33 - a23 * a31) + a22 * (a11 * a33 - a13 * a31)
    z_two = (-a12 * (b2 * a33 - a23 * b3) + a22 * (-a13 * b3)) / whole
    n_b = (b3 - a31 * z_two) / a33
    n_c = (-a11 * z_two - a13 * n_b) / a12
    return z_two, n_c, n_b


@njit(cache=True)
def acceleration(t, z, v, direction, s):
    """Acceleration z'' and the smaller normal force; ``direction`` of slip is for Coulomb's law."""
    r = sin(WEDGE_ANGLE) / sin(WEDGE_ANGLE + s.lean)
    q = -sin(s.lean) / sin(WEDGE_ANGLE + s.lean)
    base = -s.amplitude * s.omega**2 * sin(s.omega * t)
    slip = float(direction) if s.law == COULOMB else v
    mu_c, mu_b = friction_coefficient(r * slip, s), friction_coefficient(q * slip, s)
    z_two, n_c, n_b = solve_newton(z, v, base, mu_c, mu_b, s)
    return z_two, min(n_c, n_b)


@njit(cache=True)
def holds(t, z, s):
    """Direction in which a bolster at rest sets off under Coulomb's law; 0 if friction holds it."""
    if acceleration(t, z, 0.0, 1, s)[0] > 0.0:
        return 1
    return -1 if acceleration(t, z, 0.0, -1, s)[0] < 0.0 else 0


@njit(cache=True)
def step(t, h, z, v, direction, s):
    """One step of Runge and Kutta's method."""
    a1, _ = acceleration(t, z, v, direction, s)
    v2 = v + 0.5 * h * a1
    a2, _ = acceleration(t + 0.5 * h, z + 0.5 * h * v, v2, direction, s)
    v3 = v + 0.5 * h * a2
    a3, _ = acceleration(t + 0.5 * h, z + 0.5 * h * v2, v3, direction, s)
    v4 = v + h * a3
    a4, _ = acceleration(t + h, z + h * v3, v4, direction, s)
    return z + h / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4), v + h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4)


@njit(cache=True)
def follow(s, h, before, stride, samples):
    """Samples (2, n) of z less its rest and of v, ``stride`` steps apart, and the least normal force."""
    z, v, least = s.rest, 0.0, np.inf
    direction = holds(0.0, z, s) if s.law == COULOMB else 1
    out = np.empty((2, samples))
    for n in range(before + stride * (samples - 1) + 1):
        t = n * h
        if n >= before and (n - before) % stride == 0:
            out[0, (n - before) // stride], out[1, (n - before) // stride] = z - s.rest, v
        if direction == 0:
            direction = holds(t + h, z, s)
            continue
        if n >= before:
            least = min(least, acceleration(t, z, v, direction, s)[1])
        past, was = v, z
        z, v = step(t, h, z, v, direction, s)
        if s.law == COULOMB and v * direction < 0.0:
            share = abs(past) / (abs(past) + abs(v))
            z, v = was + share * (z - was), 0.0
            direction = holds(t + h, z, s)
    return out, least


def system(law: str, lean_deg: float, frequency: float, amplitude: float, effect: dict[str, float]) -> System:
    """System of one test (Hz, m); ``effect`` has width (m), coefficient (N s^2/m^2), friction (scale)."""
    loose = System(
        LAWS[law],
        radians(lean_deg),
        amplitude,
        2.0 * pi * frequency,
        effect.get("width", 0.0),
        effect.get("coefficient", 0.0),
        effect.get("friction", 1.0),
        0.0,
    )
    # Without friction the forces are straight lines over z: the place of rest from two of them.
    tight = loose._replace(width=0.0)
    low, high = (solve_newton(z, 0.0, 0.0, 0.0, 0.0, tight)[0] for z in (0.0, -1e-3))
    return loose._replace(rest=-1e-3 * low / (low - high))


def session(rise: float, tests: int) -> np.ndarray:
    """Friction of tests that are made one after another, over that of the model, shape (tests,)."""
    return 1.0 + rise * (1.0 - np.exp(-np.arange(tests) / (SETTLES * tests)))
