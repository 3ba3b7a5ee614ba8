"""Units of an input's size: the ending of a key names the quantity."""

from collections.abc import Mapping
from typing import Any, NamedTuple

from wedgesweep import units


class Unit(NamedTuple):
    """What a key with this ending tells: the quantity, what turns a number into SI, and the SI unit."""

    quantity: str
    factor: float
    si: str


UNITS = {
    "mm": Unit("displacement", 1e-3, "m"),
    "mm_per_s": Unit("velocity", 1e-3, "m s-1"),
    "m_per_s2": Unit("acceleration", 1.0, "m s-2"),
    "N": Unit("force", 1.0, "N"),
}
# Units of quantities in SI, and those that a recording may be in.
SI = {each.quantity: each.si for each in UNITS.values()}
RECORDED = {quantity: units.UNITS[quantity] for quantity in SI}


def sized(given: Mapping[str, Any], size: str) -> tuple[Unit, float]:
    """Unit and SI value of the key ``size``_UNIT that a table has."""
    ((unit, value),) = [(UNITS[u], given[f"{size}_{u}"]) for u in UNITS if f"{size}_{u}" in given]
    return unit, value * unit.factor
