"""The motion of the base model as a power series in time, while friction is linear in z' or a power of it.

Each coefficient follows from those before it, by products of series like mu_c = c_0 + c_1 s + c_2 s^2 + ...

    z'' (D_0 + D_1 mu_b) = A_0 + A_1 mu_b,    A_0, A_1, D_0 and D_1 linear in mu_c (rational.py)

For the method see Jorba and Zou (2005), A software package for the numerical integration of ODEs by means of
high-order Taylor methods.
"""

from typing import Any, NamedTuple

from wedgesweep.traced import traced

# Order of the series of z'. A higher one takes longer steps, each of which takes longer.
ORDER = 7


class Face(NamedTuple):
    """Coefficient of friction of a face: slope z' + power (z'/z'_0)^e; z'_0: where a series begins."""

    slope: float
    power: float


class Motion(NamedTuple):
    """What a series begins with.

    Displacement (m), velocity (m/s), base acceleration (m/s^2) and its rate, squared angular frequency of the
    input, friction of both faces, the exponent of powers, and ``rational.RationalAcceleration``.
    """

    x: float
    velocity: float
    u2: float
    u3: float
    square: float
    column: Face
    bolster: Face
    exponent: float
    forces: Any


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


class _Acceleration:
    """The series of z'' and of all that it needs."""

    def __init__(self, forces: Any) -> None:
        self.forces = forces
        self.column_mu: list = []
        self.bolster_mu: list = []
        self.loads: tuple[list, ...] = [], [], [], []
        self.a1: list = []
        self.d1: list = []
        self.d: list = []
        self.a: list = []

    def append(self, x: Any, u2: Any, column_mu: Any, bolster_mu: Any) -> Any:
        """The next coefficient, from those of x, u'' and both coefficients of friction."""
        forces, k = self.forces, len(self.a)
        self.column_mu.append(column_mu)
        self.bolster_mu.append(bolster_mu)
        for i, load in enumerate(self.loads):
            acting = forces.by_x[i] * x + forces.by_u[i] * u2
            load.append(acting + forces.at_rest[i] if k == 0 else acting)
        constant, column, bolster, both = self.loads
        self.a1.append(bolster[k] + _product(self.column_mu, both, k))
        d0, d1 = forces.determinant.column * column_mu, forces.determinant.both * column_mu
        if k == 0:
            d0, d1 = d0 + forces.determinant.constant, d1 + forces.determinant.bolster
        self.d1.append(d1)
        self.d.append(d0 + _product(self.d1, self.bolster_mu, k))
        total = constant[k] + _product(self.column_mu, column, k) + _product(self.bolster_mu, self.a1, k)
        if k == 0:
            self.inverse = 1.0 / self.d[0]
        else:
            total = total - _product(self.d, self.a, k, 1)
        self.a.append(self.inverse * total)
        return self.a[k]


def expanded(motion: Motion, powers: bool) -> Series:
    """The series of a motion, of numbers or symbols; with ``powers`` beyond a constant and a slope."""
    x, v, u2, m = [motion.x], [motion.velocity], [motion.u2, motion.u3], [1.0]
    acceleration = _Acceleration(motion.forces)
    for k in range(ORDER):
        if k > 1:
            u2.append(motion.square * u2[k - 2] * (-1.0 / (k * (k - 1))))
        if powers and k > 0:
            m.append(_next_power(m, v, motion.exponent))
        both = []
        for face in (motion.column, motion.bolster):
            mu = face.slope * v[k]
            both.append(mu + face.power * m[k] if k < len(m) else mu)
        a = acceleration.append(x[k], u2[k], *both)
        v.append(a * (1.0 / (k + 1)))
        x.append(v[k] * (1.0 / (k + 1)))
    return Series(tuple(x), tuple(v))


@traced
def expand(motion: Motion) -> Series:
    """The series of a motion under coefficients of friction that are linear in velocity, or constant."""
    return expanded(motion, powers=False)


@traced
def expand_powers(motion: Motion) -> Series:
    """The series of a motion under coefficients of friction that are powers of velocity, or linear in it."""
    return expanded(motion, powers=True)
