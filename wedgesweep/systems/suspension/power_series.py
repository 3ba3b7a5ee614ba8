"""The motion of the base model as a power series in time, while friction is linear in z' or a power of it.

Each coefficient follows from those before it, by products of series, mu_c = c_0 + c_1 s + c_2 s^2 + ..., in
(see rational.py)

    z'' D = L_00 + L_10 mu_c + L_01 mu_b + L_11 mu_c mu_b,    L = at_rest + by_x x + by_u u''

For the method see Jorba and Zou (2005), A software package for the numerical integration of ODEs by means of
high-order Taylor methods. Its arithmetic is written out in straight lines: loops take twice the time.
"""

from collections.abc import Callable
from typing import Any, NamedTuple, cast

from wedgesweep.compiled import contracted

# Order of the series of z'. A higher one takes longer steps, each of which takes longer.
ORDER = 7
# The terms of a Bilinear, as the ends of names.
_TERMS = {"00": "constant", "10": "column", "01": "bolster", "11": "both"}


class Face(NamedTuple):
    """Coefficient of friction of a face: slope z' + power (z'/z'_0)^e; z'_0: where a series begins."""

    slope: float
    power: float


class Series(NamedTuple):
    """Coefficients of x, z', u'' and both coefficients of friction, by powers of time (s)."""

    x: Any
    velocity: Any
    u2: Any
    column_mu: Any
    bolster_mu: Any


def _product(one: str, other: str, k: int, first: int = 0) -> str:
    """Coefficient k of the product of two series, from the term ``first`` of one on."""
    return "(" + " + ".join(f"{one}{i} * {other}{k - i}" for i in range(first, k + 1)) + ")"


def _friction(k: int, powers: bool) -> list[str]:
    """Coefficient k of both coefficients of friction."""
    lines = []
    if powers and k == 0:
        lines = ["m0, inverse_v = 1.0, 1.0 / v0"]
    elif powers:
        # m = (v/v_0)^e, of which v m' = e m v'
        terms = (f"(exponent * {i} - {k - i}) * v{i} * m{k - i}" for i in range(1, k + 1))
        lines = [f"m{k} = {1 / k} * inverse_v * ({' + '.join(terms)})"]
    for face in ("column", "bolster"):
        power = f" + {face}.power * m{k}" if powers else f" + {face}.power" if k == 0 else ""
        lines.append(f"{face}{k} = {face}.slope * v{k}{power}")
    return lines


def _acceleration(k: int) -> list[str]:
    """Coefficient k of z''."""
    lines = [f"both{k} = {_product('column', 'bolster', k)}"]
    constant = " + d_00" if k == 0 else ""
    lines.append(f"d{k} = d_10 * column{k} + d_01 * bolster{k} + d_11 * both{k}{constant}")
    for term in _TERMS:
        at_rest = f" + at_rest_{term}" if k == 0 else ""
        lines.append(f"l{term}_{k} = by_x_{term} * x{k} + by_u_{term} * u{k}{at_rest}")
    products = [_product(*each, k) for each in (("l10_", "column"), ("l01_", "bolster"), ("l11_", "both"))]
    total = " + ".join([f"l00_{k}", *products])
    if k == 0:
        return [*lines, "inverse = 1.0 / d0", f"a0 = inverse * ({total})"]
    return [*lines, f"a{k} = inverse * ({total} - {_product('d', 'a', k, 1)})"]


def _lines(powers: bool) -> list[str]:
    """The body of ``expand``, or with ``powers`` of ``expand_powers``."""
    parts = {"d": "determinant"} | {part: f"acceleration.{part}" for part in ("at_rest", "by_x", "by_u")}
    lines = [
        f"{name}_{term} = forces.{path}.{of}" for name, path in parts.items() for term, of in _TERMS.items()
    ]
    for k in range(ORDER):
        if k > 1:
            lines.append(f"u{k} = {-1 / (k * (k - 1))} * square * u{k - 2}")
        lines += _friction(k, powers) + _acceleration(k)
        lines += [f"v{k + 1} = {1 / (k + 1)} * a{k}", f"x{k + 1} = {1 / (k + 1)} * v{k}"]
    counts = {"x": ORDER + 1, "v": ORDER + 1, "u": ORDER, "column": ORDER, "bolster": ORDER}
    rows = (f"({', '.join(f'{name}{k}' for k in range(count))})" for name, count in counts.items())
    return [*lines, f"return Series({', '.join(rows)})"]


def _written(powers: bool) -> Callable:
    """A compiled function that expands a motion.

    Its arguments: displacement (m), velocity (m/s), the base acceleration and its rate, the input's squared
    angular frequency, the ``Face`` of column and bolster, the exponent, and the ``RationalForces``.
    """
    head = "def expand(x0, v0, u0, u1, square, column, bolster, exponent, forces):"
    scope: dict[str, Any] = {"Series": Series}
    exec("\n    ".join([head, *_lines(powers)]), scope)
    return cast(Callable, contracted(scope["expand"]))


# Where no coefficient of friction is a power of velocity, other than a constant, and where one may be.
expand, expand_powers = _written(powers=False), _written(powers=True)
