"""The same rig at another size: every number multiplied by powers of three factors."""

from typing import NamedTuple

import numpy as np

from wedgesweep.config import Config
from wedgesweep.effects import EFFECTS, empirical_force
from wedgesweep.friction.quantities import FRICTION
from wedgesweep.natural_units import Dimension
from wedgesweep.quantity import Quantity
from wedgesweep.systems.suspension.parameters import SUSPENSION

TABULATED = [
    Quantity(key, np.nan, "forces of a table")
    for key in (empirical_force.TABLE, f"{empirical_force.COEFFICIENTS}_N")
]


class Size(NamedTuple):
    """Factors of mass, length and time."""

    mass: float
    length: float
    time: float

    def factor(self, dimension: Dimension) -> float:
        """Factor of a quantity."""
        return self.mass**dimension.mass * self.length**dimension.length * self.time**dimension.time

    def numbers(self, quantities, given):
        """Given numbers, or arrays of them, by the names of quantities (SI) or by their keys.

        Gravity is multiplied as well: by 1 in both of the symmetries below.
        """
        by_name = {each.name: each for each in quantities} | {each.key: each for each in quantities}
        return {name: self.factor(by_name[name].dimension) * np.array(value) for name, value in given.items()}

    def suspension(self, given=None):
        """SI numbers of a suspension, the bench's unless given."""
        return self.numbers(SUSPENSION, _defaults(SUSPENSION) | (given or {}))

    def friction(self, given=None):
        """SI numbers of its friction, the bench's unless given."""
        return self.numbers(FRICTION, _defaults(FRICTION) | (given or {}))

    def effects(self, given):
        """Numbers of effects, SI by name or in key units by key."""
        return {
            name: self.numbers((*EFFECTS[name].quantities, *TABULATED), numbers)
            for name, numbers in given.items()
        }

    def config(self, model):
        """The config of a model at this size."""
        given = model.document
        scaled = {
            "suspension": self.numbers(SUSPENSION, given["suspension"]),
            "friction": self.numbers(FRICTION, given["friction"]),
            "effects": self.effects(given["effects"]),
            "sweep": {**given["sweep"], "omega_n_rad_per_s": model.sweep.omega_n / self.time},
        }
        return Config({**given, **scaled})


def _defaults(quantities: tuple[Quantity, ...]) -> dict[str, float]:
    return {each.name: each.default * each.factor for each in quantities}


BENCH_SIZE = Size(1.0, 1.0, 1.0)
# All masses, springs and forces alike: the same motion. And Froude's: lengths and the square of times alike,
# so that accelerations stay as they are.
HEAVIER, FROUDE = Size(4000.0, 1.0, 1.0), Size(4000.0, 36.0, 6.0)
SIZES = {"heavier": HEAVIER, "froude": FROUDE}
# The same with factors that multiply without rounding.
POWERS_OF_TWO = {"heavier": Size(4096.0, 1.0, 1.0), "froude": Size(4096.0, 64.0, 8.0)}
