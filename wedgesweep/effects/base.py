"""What every effect declares."""

from collections.abc import Mapping
from dataclasses import dataclass

from wedgesweep.quantity import Quantity

# The two branches along which the paper looks for its discrepancy.
NUMERICAL, EXPERIMENTAL = "numerical-model", "experimental-model"


@dataclass(frozen=True)
class Effect:
    """One missing piece of physics, switched on by the config table ``[effects.NAME]``.

    At the ``off`` value of each quantity the effect is absent, bit for bit. ``extends`` names the quantities
    that need the extended mechanics as soon as they are not off; without any the base model serves.
    """

    name: str
    family: str
    branch: str
    meaning: str
    quantities: tuple[Quantity, ...]
    extends: tuple[str, ...] = ()

    def acts(self, numbers: Mapping[str, float]) -> bool:
        """Whether numbers (SI units; left out: off) change anything."""
        leading = self.extends or (self.quantities[0].name,)
        off = {each.name: each.neutral * each.factor for each in self.quantities}
        return any(numbers.get(name, off[name]) != off[name] for name in leading)

    @property
    def fields(self) -> tuple[str, ...]:
        """Names of its numbers in the parameter record, in the order of ``quantities``."""
        return tuple(f"{self.name}_{quantity.name}" for quantity in self.quantities)
