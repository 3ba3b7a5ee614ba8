"""Newton's equations of the base model as rational functions of both coefficients of friction.

Acceleration and normal forces are (at_rest + by_x x + by_u u'') / determinant. All four terms are linear in
each coefficient of friction, T = mu N, so that the forces at four pairs of coefficients determine them.
"""

from math import inf
from typing import NamedTuple

from wedgesweep import friction
from wedgesweep.compiled import contracted, inlined, inner
from wedgesweep.hybrid.search import Sample
from wedgesweep.systems.suspension.newton import Coefficients, Loads, loads, reactions


class Bilinear(NamedTuple):
    """A function of both coefficients: constant + column mu_c + bolster mu_b + both mu_c mu_b."""

    constant: float
    column: float
    bolster: float
    both: float


class Numerator(NamedTuple):
    """What stands over the determinant: at rest, per displacement x (m), per base acceleration (m/s^2)."""

    at_rest: Bilinear
    by_x: Bilinear
    by_u: Bilinear


class RationalForces(NamedTuple):
    """Acceleration (m/s^2) and normal forces (N), and the |x| (m) up to which no normal force can vanish."""

    determinant: Bilinear
    acceleration: Numerator
    column: Numerator
    bolster: Numerator
    loaded: float


@inlined
def _bilinear(pp, pn, np, nn, size):
    """From values at coefficients +-``size``, in the order (+, +), (+, -), (-, +), (-, -)."""
    return Bilinear(
        0.25 * ((pp + nn) + (pn + np)),
        0.25 * ((pp - nn) + (pn - np)) / size,
        0.25 * ((pp - nn) - (pn - np)) / size,
        0.25 * ((pp + nn) - (pn + np)) / size**2,
    )


@inlined
def _at_corners(load, size, p):
    """Forces and determinant at the four pairs of coefficients +-``size``."""
    return (
        reactions(load, Coefficients(size, size, 0.0, 0.0), p),
        reactions(load, Coefficients(size, -size, 0.0, 0.0), p),
        reactions(load, Coefficients(-size, size, 0.0, 0.0), p),
        reactions(load, Coefficients(-size, -size, 0.0, 0.0), p),
    )


@inlined
def _determinant(corners, size):
    (_, pp), (_, pn), (_, np), (_, nn) = corners
    return _bilinear(pp, pn, np, nn, size)


@inlined
def _numerators(corners, size):
    """What stands over the determinant in the acceleration, and in both normal forces."""
    (a, pp), (b, pn), (c, np), (d, nn) = corners
    return (
        _bilinear(a.acceleration * pp, b.acceleration * pn, c.acceleration * np, d.acceleration * nn, size),
        _bilinear(a.column * pp, b.column * pn, c.column * np, d.column * nn, size),
        _bilinear(a.bolster * pp, b.bolster * pn, c.bolster * np, d.bolster * nn, size),
    )


@inlined
def _loaded(at_rest, by_x, by_u, most_u):
    """The |x| (m) up to which both normal forces push, at the coefficients of one corner."""
    column = (at_rest.column - abs(by_u.column) * most_u) / abs(by_x.column)
    return min(column, (at_rest.bolster - abs(by_u.bolster) * most_u) / abs(by_x.bolster))


@inner
def rational_forces(mode, p):
    """``RationalForces`` of a case without friction of the guide, which the mode would change."""
    s, g = p.suspension, p.geometry
    size = max(friction.static(mode.clock, (0.0, 0.0), p), friction.sliding(p.friction.v_t, p))
    wedge = -s.wedge_spring * g.column_ratio * g.cos_column
    at_rest = _at_corners(loads(0.0, (0.0, 0.0), mode, p), size, p)
    by_x = _at_corners(
        Loads(wedge * g.cos_column, wedge * g.sin_column, -s.bolster_spring, 0.0, 0.0, 0.0), size, p
    )
    by_u = _at_corners(Loads(0.0, 0.0, 0.0, 0.0, 0.0, 1.0), size, p)
    # A force times the determinant is linear in x, in u'' and in each coefficient: it is least at a corner.
    most_u, loaded = p.input.amplitude * p.input.omega**2, inf
    for i in range(4):
        loaded = min(loaded, _loaded(at_rest[i][0], by_x[i][0], by_u[i][0], most_u))
    resting, per_x, per_u = _numerators(at_rest, size), _numerators(by_x, size), _numerators(by_u, size)
    return RationalForces(
        _determinant(at_rest, size),
        Numerator(resting[0], per_x[0], per_u[0]),
        Numerator(resting[1], per_x[1], per_u[1]),
        Numerator(resting[2], per_x[2], per_u[2]),
        loaded,
    )


@contracted
def _bilinear_sample(b, column, bolster):
    """Value and time derivative, from those of both coefficients of friction (``Sample``)."""
    per_column, per_bolster = b.column + b.both * bolster.value, b.bolster + b.both * column.value
    value = (b.constant + b.column * column.value) + per_bolster * bolster.value
    return Sample(value, per_column * column.slope + per_bolster * bolster.slope)


@contracted
def rational(numerator, determinant, x, u2, column, bolster):
    """The acceleration or a normal force with its rate, from those of all that it depends on (``Sample``)."""
    at_rest = _bilinear_sample(numerator.at_rest, column, bolster)
    by_x = _bilinear_sample(numerator.by_x, column, bolster)
    by_u = _bilinear_sample(numerator.by_u, column, bolster)
    below = _bilinear_sample(determinant, column, bolster)
    value = (at_rest.value + by_x.value * x.value + by_u.value * u2.value) / below.value
    rise = at_rest.slope + by_x.slope * x.value + by_u.slope * u2.value
    rise += by_x.value * x.slope + by_u.value * u2.slope
    return Sample(value, (rise - value * below.slope) / below.value)
