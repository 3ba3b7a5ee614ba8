"""The base model: a config with one friction law, whose numbers may differ from test to test."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from wedgesweep.config import Config, axes, from_document, load
from wedgesweep.effects import EFFECTS, of_system
from wedgesweep.effects.base import OSCILLATOR
from wedgesweep.errors import ConfigError
from wedgesweep.hints import hint

# Numbers of a run and not of the mechanical system.
NOT_OF_THE_SYSTEM = ("title", "sweep", "solver")


def load_model(path: Path, problems: list[str]) -> tuple[Config | None, str]:
    """Read a config and its one friction law; faults go to ``problems``."""
    try:
        return with_law(load(path), str(path), problems)
    except ConfigError as error:
        problems.extend(error.problems)
        return None, ""


def with_law(config: Config, source: str, problems: list[str]) -> tuple[Config, str]:
    """Return the config and its one friction law; several laws are a fault."""
    laws = config.sweep.laws
    if len(laws) > 1:
        names = ", ".join(laws)
        problems.append(f"{source}: sweep.friction_law: {names}; a model must name exactly one law")
    return config, laws[0]


def with_numbers(model: Config, numbers: Mapping[str, float], source: str = "model") -> Config:
    """A config with other numbers, by "section.key" and in the keys' units.

    Raises
    ------
    ConfigError
        If a name is unknown or a number is out of range.
    """
    known = [*_numbers(model.written), *_conditions(model.system)]
    unknown = [name for name in numbers if name not in known]
    if unknown:
        problem = "the model has no such number"
        raise ConfigError([f"{source}: {name}: {problem}; {hint(name, known)}" for name in unknown])
    changed = from_document(axes.with_numbers(model.written, numbers), source)
    if model.system != OSCILLATOR:
        return changed
    return replace(changed, nominal_load=model.oscillator["normal_force"])


def _conditions(system: str) -> list[str]:
    """Operating conditions by name: tests may state them whether the model has the effect or not."""
    found = [(name, EFFECTS[name].condition) for name in of_system(system)]
    return [f"effects.{name}.{each.key}" for name, each in found if each is not None]


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
