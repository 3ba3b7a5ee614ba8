"""Newton's equations of the base model as a rational function of both coefficients of friction.

z'' = (at_rest + by_x x + by_u u'') / determinant. Each of these four is linear in each coefficient, T = mu N,
so that the accelerations at four pairs of coefficients determine them.
"""

from math import inf
from typing import NamedTuple

from wedgesweep import friction
from wedgesweep.compiled import inlined, inner
from wedgesweep.systems.suspension.newton import Coefficients, Loads, loads, reactions

# Coefficients of friction that are tried where there is no friction.
LEAST = 1e-3


class Bilinear(NamedTuple):
    """A function of both coefficients: constant + column mu_c + bolster mu_b + both mu_c mu_b."""

    constant: float
    column: float
    bolster: float
    both: float


class RationalAcceleration(NamedTuple):
    """See the module; ``loaded``: the |x| (m) up to which both faces carry load under any friction."""

    determinant: Bilinear
    at_rest: Bilinear
    by_x: Bilinear
    by_u: Bilinear
    loaded: float


@inlined
def _bilinear(both, column, bolster, none, size):
    """From the values where both coefficients, one or none are ``size``, the others being -``size``."""
    return Bilinear(
        0.25 * ((both + none) + (column + bolster)),
        0.25 * ((both - none) + (column - bolster)) / size,
        0.25 * ((both - none) - (column - bolster)) / size,
        0.25 * ((both + none) - (column + bolster)) / size**2,
    )


@inner
def _at_corner(load, column_mu, bolster_mu, p):
    return reactions(load, Coefficients(column_mu, bolster_mu, 0.0, 0.0), p)


@inlined
def _at_corners(load, size, p):
    """Forces and determinant at the same pairs of coefficients."""
    return (
        _at_corner(load, size, size, p),
        _at_corner(load, size, -size, p),
        _at_corner(load, -size, size, p),
        _at_corner(load, -size, -size, p),
    )


@inlined
def _numerator(corners, size):
    (a, of_a), (b, of_b), (c, of_c), (d, of_d) = corners
    values = a.acceleration * of_a, b.acceleration * of_b, c.acceleration * of_c, d.acceleration * of_d
    return _bilinear(*values, size)


@inlined
def _loaded(at_rest, by_x, by_u, most_u):
    """The |x| (m) up to which both normal forces push at one corner, under any |u''| <= ``most_u``."""
    column = (at_rest.column - abs(by_u.column) * most_u) / abs(by_x.column)
    return min(column, (at_rest.bolster - abs(by_u.bolster) * most_u) / abs(by_x.bolster))


@inner
def rational_acceleration(mode, p):
    """``RationalAcceleration`` of a case without friction of the guide, which would depend on the mode."""
    s, g = p.suspension, p.geometry
    most = max(friction.static(mode.clock, (0.0, 0.0), p), friction.sliding(p.friction.v_t, p))
    size = max(most, LEAST)
    wedge = -s.wedge_spring * g.column_ratio * g.cos_column
    moved = Loads(wedge * g.cos_column, wedge * g.sin_column, -s.bolster_spring, 0.0, 0.0, 0.0)
    at_rest = _at_corners(loads(0.0, (0.0, 0.0), mode, p), size, p)
    by_x, by_u = _at_corners(moved, size, p), _at_corners(Loads(0.0, 0.0, 0.0, 0.0, 0.0, 1.0), size, p)
    # Normal forces times the determinant are linear in x, u'' and each coefficient: least at a corner.
    most_u, loaded = p.input.amplitude * p.input.omega**2, inf
    for i in range(4):
        loaded = min(loaded, _loaded(at_rest[i][0], by_x[i][0], by_u[i][0], most_u))
    determinant = _bilinear(at_rest[0][1], at_rest[1][1], at_rest[2][1], at_rest[3][1], size)
    numerators = _numerator(at_rest, size), _numerator(by_x, size), _numerator(by_u, size)
    return RationalAcceleration(determinant, numerators[0], numerators[1], numerators[2], loaded)
