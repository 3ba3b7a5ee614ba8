"""Natural units of a model (mass, length, time), which scale search ranges and test plans.

Ranges, such as that in which a fit looks for a force, are declared in SI for the bench of the paper's Table
1. For another model they are multiplied by the ratio of the natural units, so that a model whose masses,
lengths and times are all in proportion gets the same search.
"""

from math import sqrt
from typing import NamedTuple

# Mass (kg), stiffness (N/m) and gravity (m/s^2) of the bench for which ranges are declared.
BENCH_MASS, BENCH_STIFFNESS, BENCH_GRAVITY = 0.70, 5.10e3, 9.80665


class Dimension(NamedTuple):
    """Powers of mass, length and time in a quantity."""

    mass: int = 0
    length: int = 0
    time: int = 0


SHARE = Dimension()
LENGTH, TIME = Dimension(length=1), Dimension(time=1)
VELOCITY, ACCELERATION = Dimension(length=1, time=-1), Dimension(length=1, time=-2)
FREQUENCY = Dimension(time=-1)


class NaturalUnits(NamedTuple):
    """Natural units of a model: mass (kg), length (m), time (s)."""

    mass: float
    length: float
    time: float

    def ratio(self, dimension: Dimension) -> float:
        """A quantity of this model over the corresponding one of the bench; 1 for the bench itself."""
        pairs = zip(self, BENCH, dimension, strict=True)
        ratio = 1.0
        for own, bench, power in pairs:
            ratio *= (own / bench) ** power
        return ratio


def natural_units(
    mass: float,
    stiffness: float,
    gravity: float = 0.0,
    travel: float | None = None,
    omega: float | None = None,
) -> NaturalUnits:
    """Natural units of a mass on a spring.

    Parameters
    ----------
    mass : float
        kg.
    stiffness : float
        N/m; 0 for a mass without spring.
    gravity : float
        m/s^2; 0 where the weight makes no forces of contact. Otherwise lengths are in proportion to the
        static deflection, as friction is then in proportion to the weight.
    travel : float, optional
        Largest amplitude (m) of the measured motion, the unit of length without gravity. Default: the static
        deflection of the bench.
    omega : float, optional
        Angular frequency (rad/s) of the tests, of which the unit of time is the reciprocal without a spring.
        Default: the bench's unit.

    Returns
    -------
    NaturalUnits
        Mass, static deflection (or travel), and reciprocal of the angular natural frequency.
    """
    elsewhere = 1.0 / omega if omega else BENCH.time
    time = sqrt(mass / stiffness) if stiffness > 0.0 else elsewhere
    if gravity > 0.0 and stiffness > 0.0:
        return NaturalUnits(mass, gravity * time**2, time)
    return NaturalUnits(mass, travel or BENCH.length, time)


_BENCH_TIME = sqrt(BENCH_MASS / BENCH_STIFFNESS)
BENCH = NaturalUnits(BENCH_MASS, BENCH_GRAVITY * _BENCH_TIME**2, _BENCH_TIME)
