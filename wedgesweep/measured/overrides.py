"""Numbers of the base model that differ from test to test: an empty and a loaded wagon, a heavier disc."""

from collections.abc import Mapping
from copy import deepcopy
from dataclasses import replace
from typing import Any

from wedgesweep.config import Config, from_document
from wedgesweep.effects.base import OSCILLATOR
from wedgesweep.errors import ConfigError
from wedgesweep.hints import hint

# Numbers of a run and not of the mechanical system.
NOT_OF_THE_SYSTEM = ("title", "sweep", "solver")


def with_numbers(model: Config, numbers: Mapping[str, float], source: str = "model") -> Config:
    """A config with other numbers, by "section.key" and in the keys' units.

    Raises
    ------
    ConfigError
        If a name is unknown or a number is out of range.
    """
    document = deepcopy(model.written)
    unknown = []
    for name, number in numbers.items():
        *sections, key = name.split(".")
        place: Any = document
        for section in sections:
            place = place.get(section, {}) if isinstance(place, dict) else {}
        known = sections and sections[0] not in NOT_OF_THE_SYSTEM and isinstance(place, dict)
        if not (known and isinstance(place.get(key), int | float)):
            unknown.append(
                f"{source}: {name}: the model has no such number; {hint(name, _numbers(document))}"
            )
        else:
            place[key] = number
    if unknown:
        raise ConfigError(unknown)
    changed = from_document(document, source)
    if model.system != OSCILLATOR:
        return changed
    return replace(changed, nominal_load=model.oscillator["normal_force"])


def faults(model: Config, given: Mapping[str, Any], source: str) -> list[str]:
    """Faults of the numbers that the keys of a test give."""
    try:
        with_numbers(model, given.get("model", {}), source)
    except ConfigError as error:
        return list(error.problems)
    return []


def _numbers(table: Mapping[str, Any], prefix: str = "") -> list[str]:
    """Names of all numbers of the mechanical system."""
    found = []
    for name, value in table.items():
        if not prefix and name in NOT_OF_THE_SYSTEM:
            continue
        if isinstance(value, dict):
            found += _numbers(value, f"{prefix}{name}.")
        elif isinstance(value, int | float) and not isinstance(value, bool):
            found.append(f"{prefix}{name}")
    return found
