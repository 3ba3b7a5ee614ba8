"""Numbers, units and effects as a reader wants them, in plain text."""

from collections.abc import Mapping, Sequence
from math import sqrt
from typing import Any

from wedgesweep.digits import LARGE, NO_BREAK, NONE, SMALL, decimals, fixed, number, short
from wedgesweep.effects import EFFECTS
from wedgesweep.quantity import Quantity

INTERVAL = f"95{NO_BREAK}% interval"
UNITS = {
    "_N_per_mm3": "N/mm³",
    "_N_per_mm": "N/mm",
    "_N_s_per_m": "N s/m",
    "_m_per_s2": "m/s²",
    "_rad_per_s": "rad/s",
    "_mm_per_s": "mm/s",
    "_deg": "°",
    "_kg": "kg",
    "_mm": "mm",
    "_hz": "Hz",
    "_N": "N",
    "_s": "s",
}


def probability(p: float | None) -> str:
    """A p value; tiny ones are only bounded."""
    return NONE if p is None else "< 0.001" if p < 1e-3 else f"{p:.2g}"


def p_value(p: float | None) -> str:
    """As it is told: p = 0.02, p < 0.001."""
    told = probability(p)
    return f"p {told}" if told.startswith("<") else f"p = {told}"


def listing(words: Sequence[str], last: str = "and") -> str:
    """Words as a sentence takes them: a, b and c."""
    return f" {last} ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)


def split_key(key: str) -> tuple[str, str]:
    """What a config key names, and its unit."""
    quantity = Quantity(key, 0.0, "")
    return quantity.name.replace("_", " "), UNITS.get(quantity.suffix, "")


def with_unit(text: str, unit: str) -> str:
    """A number with its unit."""
    return f"{text}{unit}" if unit == "°" or not unit else f"{text}{NO_BREAK}{unit}"


def estimate(key: str, found: Mapping[str, Any]) -> str:
    """A fitted number with its interval, for a sentence."""
    name, unit = split_key(key)
    if found["value"] is None:
        return f"{name} not determined"
    trio = spread(found)
    if trio is None:
        return f"{name} {with_unit(number(found['value']), unit)}, no interval"
    value, low, high = trio
    return f"{name} {with_unit(value, unit)}, {INTERVAL} {low} to {with_unit(high, unit)}"


def compact(key: str, found: Mapping[str, Any]) -> str:
    """The same for a table, whose head says what stands in brackets."""
    name, unit = split_key(key)
    value, low, high = spread(found) or (number(found["value"]), "", "")
    return f"{name} {with_unit(value, unit)}" + (f" ({low} to {high})" if low else "")


def spread(found: Mapping[str, Any]) -> tuple[str, str, str] | None:
    """A fitted number and the ends of its interval, to two digits of its width; None without interval."""
    ends = found["ci95"]
    if found["value"] is None or ends is None or None in ends:
        return None
    values = (found["value"], *ends)
    width, largest = abs(ends[1] - ends[0]), max(map(abs, values))
    if width == 0.0 or not SMALL <= largest < LARGE:
        return number(values[0]), number(values[1]), number(values[2])
    value, low, high = (_to_places(each, decimals(width, 2)) for each in values)
    return value, low, high


def _to_places(value: float, places: int) -> str:
    """A number with so many decimals; one that is too small for them keeps a digit of its own."""
    vanishes = value != 0.0 and round(value, places) == 0.0
    return number(value, 1) if vanishes else fixed(value, places)


def meaning(effect: str) -> str:
    """What an effect is, in words."""
    return EFFECTS[effect].meaning if effect in EFFECTS else effect.replace("_", " ")


def together(effects: Sequence[str]) -> str:
    """Effects of one explanation, by name."""
    return " + ".join(effects) or "base model"


def over_noise(misfit: float | None, dof: float) -> float | None:
    """How large an error is, in standard deviations of the noise."""
    return None if misfit is None or dof <= 0 else sqrt(misfit / dof)


def times_noise(misfit: float | None, dof: float) -> str:
    """The same in words."""
    return f"{number(over_noise(misfit, dof))} times the noise"


def counted(count: int, word: str) -> str:
    """A count with its noun: 1 test, 12 tests."""
    return f"{count} {word}" if count == 1 else f"{count} {word}s"


def tells(document: Mapping[str, Any]) -> bool:
    """Whether a diagnosis recommends a test that tells explanations apart, not only the best there is."""
    return document["next_test"]["distance"] >= document["method"]["enough_distance"]


def following(test: Mapping[str, Any]) -> str:
    """The recommended test."""
    return f"{short(test['frequency_hz'])}{NO_BREAK}Hz and {short(test['amplitude_mm'], 3)}{NO_BREAK}mm"
