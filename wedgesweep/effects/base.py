"""What every effect declares."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from wedgesweep.quantity import Quantity

# The two branches along which the paper looks for its discrepancy.
NUMERICAL, EXPERIMENTAL = "numerical-model", "experimental-model"


# Systems that effects may act on, and what the parts that they act on are called in each.
SUSPENSION, OSCILLATOR = SYSTEMS = ("suspension", "oscillator")
PARTS = {
    SUSPENSION: {
        **{"body": "bolster", "mass": "bolster", "base": "side frame"},
        **{"face": "column face", "faces": "wedges", "guide": "its lateral guide"},
    },
    OSCILLATOR: {
        **{"body": "oscillator", "mass": "mass", "base": "base"},
        **{"face": "rubbing face", "faces": "rubbing surface", "guide": "the surface that it rubs on"},
    },
}


@dataclass(frozen=True)
class Effect:
    """One missing piece of physics, switched on by the config table ``[effects.NAME]``.

    At the neutral value of each quantity the effect is absent, bit for bit. ``extends`` names the quantities
    that add forces, coefficients, states or events to the base model when they are not off. An effect
    without any is one that the base model's mechanics can do. ``contains``: effects that are special cases
    of this one; ``limits``: those of them that an effect must clearly surpass to be rated beside them, as it
    comes as close to them as it likes. ``systems``: those that have the part which it acts on. ``excludes``:
    effects that cannot be in one model with it. ``acts_on``: effects whose force it changes; in a model
    without other friction it shows beside them only. ``of_loops``: a diagnosis looks for it in loops; beside
    other tests only where it is asked to. ``condition``: an operating condition that tests state; the effect
    shows only where it differs between them.
    ``meaning`` may hold names of PARTS in braces; see ``described``.
    """

    name: str
    family: str
    branch: str
    meaning: str
    quantities: tuple[Quantity, ...]
    extends: tuple[str, ...] = ()
    contains: tuple[str, ...] = ()
    limits: tuple[str, ...] = ()
    systems: tuple[str, ...] = SYSTEMS
    excludes: tuple[str, ...] = ()
    acts_on: tuple[str, ...] = ()
    of_loops: bool = False
    condition: Quantity | None = None

    def described(self, system: str = SUSPENSION) -> str:
        """What the effect is, in words, on a system."""
        return self.meaning.format(**PARTS[system])

    @property
    def searched(self) -> bool:
        """Whether a diagnosis looks for its numbers, so that it is a candidate."""
        return any(each.search for each in self.quantities)

    @cached_property
    def off(self) -> Mapping[str, float]:
        """Numbers (SI units) at which the effect is absent."""
        return {each.name: each.neutral * each.factor for each in self.quantities}

    def acts(self, numbers: Mapping[str, float]) -> bool:
        """Whether numbers (SI units; left out: off) change anything."""
        leading = self.extends or (self.quantities[0].name,)
        return any(numbers.get(name, self.off[name]) != self.off[name] for name in leading)
