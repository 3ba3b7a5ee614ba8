"""What every effect declares."""

from dataclasses import dataclass

from wedgesweep.quantity import Quantity


@dataclass(frozen=True)
class Effect:
    """One missing piece of physics, switched on by the config table ``[effects.NAME]``.

    The default of each quantity is its neutral value: the effect is then absent, bit for bit.
    """

    name: str
    family: str
    meaning: str
    quantities: tuple[Quantity, ...]

    @property
    def fields(self) -> tuple[str, ...]:
        """Names of its numbers in the parameter record, in the order of ``quantities``."""
        return tuple(f"{self.name}_{quantity.name}" for quantity in self.quantities)
