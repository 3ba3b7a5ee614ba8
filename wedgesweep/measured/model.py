"""The base model: a config with one friction law."""

from pathlib import Path

from wedgesweep.config import Config, load
from wedgesweep.errors import ConfigError


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
