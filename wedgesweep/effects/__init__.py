"""Physics that the base model leaves out: one effect per file, each off at its neutral value."""

from wedgesweep.effects import guide_friction
from wedgesweep.effects.base import Effect

EFFECTS: dict[str, Effect] = {effect.name: effect for effect in (guide_friction.EFFECT,)}


def neutral() -> dict[str, float]:
    """The parameter record's fields that belong to effects, with every effect off (SI units)."""
    return {
        field: quantity.default * quantity.factor
        for effect in EFFECTS.values()
        for field, quantity in zip(effect.fields, effect.quantities, strict=True)
    }
