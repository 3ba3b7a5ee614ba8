"""The motion of the suspension as a power series in time, while all but friction is linear.

Coefficients of friction are linear in z', a power of it, or decay exponentially with it.

Each coefficient follows from those before it, by products of series like mu_c = c_0 + c_1 s + c_2 s^2 + ...
The equations are those of ``newton.reactions``, with the constants of ``newton.Closed``.

For the method see Jorba and Zou (2005), A software package for the numerical integration of ODEs by means of
high-order Taylor methods.
"""

from typing import Any, NamedTuple

from wedgesweep.excitation import TERMS
from wedgesweep.traced import traced

# Order of the series of z'. A higher one takes longer steps, each of which takes longer.
ORDER = TERMS


class Face(NamedTuple):
    """Coefficient of friction of a face: slope z' + power (z'/z'_0)^e + fading exp(by_velocity (z' - z'_0)).

    z'_0: where a series begins (m/s).
    """

    slope: float
    power: float
    fading: float
    by_velocity: float


class Equations(NamedTuple):
    """Newton's equations as ``newton.closed_contacts`` and loads.

    Loads are forces on a wedge along and normal to the column (N), and z'' without contact forces (m/s^2): at
    x = z' = 0, and their changes by x, by z' and by u''. Both faces carry load under any friction while
    ``unloads[0]`` |x| + ``unloads[1]`` |z'| < 1.
    """

    at_rest: Any
    by_x: Any
    by_v: Any
    by_u: Any
    closed: Any
    unloads: Any


class Motion(NamedTuple):
    """What a series begins with.

    Displacement (m), velocity (m/s), base acceleration (m/s^2) as a series, friction of both faces, the
    exponent of powers, and ``Equations``.
    """

    x: float
    velocity: float
    u2: Any
    column: Face
    bolster: Face
    exponent: float
    equations: Any


class Series(NamedTuple):
    """Coefficients of x and z' by powers of time (s), shape (ORDER + 1,)."""

    x: Any
    velocity: Any


def _total(terms: list) -> Any:
    """Their sum, without the zero with which ``sum`` begins by default."""
    return sum(terms[1:], terms[0])


def _product(one: list, other: list, k: int, first: int = 0) -> Any:
    """Coefficient k of the product of two series, from the term ``first`` of one on."""
    return _total([one[i] * other[k - i] for i in range(first, k + 1)])


def _next_power(m: list, v: list, exponent: Any) -> Any:
    """The next coefficient of m = (v/v_0)^e, of which v m' = e m v'."""
    k = len(m)
    return _total([(exponent * i - (k - i)) * v[i] * m[k - i] for i in range(1, k + 1)]) / (k * v[0])


def _next_exponential(e, v, factor):
    """The next coefficient of e = exp(factor (v - v_0)), of which e' = factor e v'."""
    k = len(e)
    return _total([i * v[i] * e[k - i] for i in range(1, k + 1)]) * factor * (1.0 / k)


class _Acceleration:
    """The series of z'' and of what it needs: determinant (z'' - free) = push (mu_c normal - tangential)."""

    def __init__(self, equations: Equations) -> None:
        self.equations = equations
        self.column_mu: list = []
        self.into: list = []
        self.push: list = []
        self.normal: list = []
        self.load: list = []
        self.determinant: list = []
        self.by_contact: list = []

    def append(self, x: Any, v: Any, u2: Any, column_mu: Any, bolster_mu: Any) -> Any:
        """The next coefficient, from those of x, z', u'' and both coefficients of friction."""
        at_rest, by_x, by_v, by_u, closed, _ = self.equations
        k = len(self.load)
        tangential, normal, free = (by_x[i] * x + by_v[i] * v + by_u[i] * u2 for i in range(3))
        along, into = closed.along_mu * bolster_mu, closed.into_mu * bolster_mu
        push = closed.push_mu * bolster_mu
        if k == 0:
            tangential, normal, free = tangential + at_rest[0], normal + at_rest[1], free + at_rest[2]
            along, into, push = along + closed.along, into + closed.into, push + closed.push
        self.normal.append(normal)
        self.column_mu.append(column_mu)
        self.into.append(into)
        self.push.append(push)
        self.load.append(_product(self.column_mu, self.normal, k) - tangential)
        self.determinant.append(_product(self.column_mu, self.into, k) - along)
        total = _product(self.push, self.load, k)
        if k == 0:
            self.inverse = 1.0 / self.determinant[0]
        else:
            total = total - _product(self.determinant, self.by_contact, k, 1)
        self.by_contact.append(self.inverse * total)
        return free + self.by_contact[k]


def expanded(motion: Motion, powers: bool, fading: bool) -> Series:
    """The series of a motion, of numbers or symbols; without ``powers`` these are constants."""
    x, v, m = [motion.x], [motion.velocity], [1.0]
    exponentials: tuple[list, list] = [1.0], [1.0]
    acceleration = _Acceleration(motion.equations)
    for k in range(ORDER):
        if powers and k > 0:
            m.append(_next_power(m, v, motion.exponent))
        both = []
        for face, e in zip((motion.column, motion.bolster), exponentials, strict=True):
            mu = face.slope * v[k]
            mu = mu + face.power * m[k] if k < len(m) else mu
            if fading and k > 0:
                e.append(_next_exponential(e, v, face.by_velocity))
            both.append(mu + face.fading * e[k] if fading else mu)
        v.append(acceleration.append(x[k], v[k], motion.u2[k], *both) * (1.0 / (k + 1)))
        x.append(v[k] * (1.0 / (k + 1)))
    return Series(tuple(x), tuple(v))


@traced
def expand(motion: Motion) -> Series:
    """The series of a motion under coefficients of friction that are linear in velocity, or constant."""
    return expanded(motion, powers=False, fading=False)


@traced
def expand_powers(motion: Motion) -> Series:
    """The series of a motion under coefficients of friction that are powers of velocity, or linear in it."""
    return expanded(motion, powers=True, fading=False)


@traced
def expand_fading(motion: Motion) -> Series:
    """The series of a motion under coefficients of friction that decay with velocity, or are linear in it."""
    return expanded(motion, powers=False, fading=True)
