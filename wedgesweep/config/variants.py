"""Other configs made of one: with another solver, or of a single case."""

from collections.abc import Mapping
from types import MappingProxyType

from wedgesweep.config import Config, from_document
from wedgesweep.config.axes import with_numbers
from wedgesweep.config.contradictions import contradictions
from wedgesweep.errors import ConfigError


def with_method(config: Config, method: str) -> Config:
    """The same config with another solver; raises ConfigError if its settings do not allow it."""
    document = config.document | {"solver": config.document["solver"] | {"method": method}}
    if problems := list(contradictions(document)):
        raise ConfigError([f'solver "{method}": {problem}' for problem in problems])
    return Config(document)


def single_case(
    config: Config,
    amplitude_mm: float | None,
    beta: float | None,
    frequency_hz: float | None,
    law: str | None,
    amplitude_N: float | None = None,
    numbers: Mapping[str, float | str] = MappingProxyType({}),
) -> Config:
    """The same config with a grid of one case, whose waveforms are kept; raises ConfigError.

    Either ``beta`` or ``frequency_hz`` is given, and one of the amplitudes; ``law`` is by default the
    config's first. ``numbers`` of the model, by dotted key, are by default its nominal ones.
    """
    given = {
        "friction_law": law.lower() if law else config.sweep.laws[0],
        "beta": beta,
        "frequency_hz": frequency_hz,
        "excitation": config.document["sweep"].get("excitation"),
        "amplitude_mm": amplitude_mm,
        "amplitude_N": amplitude_N,
        "omega_n_rad_per_s": config.document["sweep"].get("omega_n_rad_per_s"),
    }
    grid = {key: value for key, value in given.items() if value is not None}
    if config.transient:
        raise ConfigError(["input: a single case is of a sine; remove [input], or use 'wedgesweep run'"])
    solver = config.document["solver"] | {"keep_waveforms": True, "continuation": False}
    document = with_numbers(config.document, config.given(numbers)) | {"sweep": grid, "solver": solver}
    return from_document(Config(document).written, "case")
