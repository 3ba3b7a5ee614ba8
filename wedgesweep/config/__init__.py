"""Config of a sweep: TOML with the unit in every key, checked, and SI from here on."""

import logging
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import reduce
from math import isnan
from pathlib import Path
from typing import Any

from wedgesweep import __version__, formatting, rotation, toml
from wedgesweep.config import commented, force_table, sample
from wedgesweep.config.axes import ZIP, corners, is_model_key, model_keys, with_nominal, with_numbers
from wedgesweep.config.cases import NATURAL, AmplitudeUnit, Case, Cases, natural_frequency
from wedgesweep.config.contradictions import contradictions
from wedgesweep.config.declarations import root
from wedgesweep.config.model import OSCILLATOR, Config
from wedgesweep.config.shared_parts import with_shared_parts
from wedgesweep.config.turned import turned_root
from wedgesweep.errors import ConfigError, InputError
from wedgesweep.inputs import record
from wedgesweep.kinds import CONFIG, confusion

__all__ = ["AmplitudeUnit", "Case", "Cases", "Config", "ConfigError", "from_document", "load", "parse"]

log = logging.getLogger(__name__)

# With this effect a suspension may have no equilibrium.
SOFTENING = "cubic_stiffness"


def load(path: str | Path) -> Config:
    """Read a config file; raises ConfigError."""
    if problem := confusion(Path(path), CONFIG):
        raise ConfigError([problem])
    try:
        given = toml.load(Path(path), "a TOML file")
    except InputError as error:
        raise ConfigError(error.problems) from error
    found = from_document(given, str(path), Path(path).parent)
    log.debug("%s: %d cases, %s", path, found.sweep.count, found.document["solver"]["method"])
    return found


def parse(text: str, source: str = "<config>", directory: Path = Path()) -> Config:
    """Read a config from TOML text; raises ConfigError with everything that is wrong with it.

    ``directory``: where the path of a recorded input begins.
    """
    try:
        given = toml.loads(text)
    except ValueError as error:
        raise ConfigError([f"{source}: not valid TOML: {error}"]) from error
    return from_document(given, source, directory)


def from_document(given: Mapping[str, Any], source: str = "<config>", directory: Path = Path()) -> Config:
    """Check the tables and keys of a config; raises ConfigError with everything that is wrong with it."""
    problems: list[str] = []
    given = force_table.expanded(given, directory, problems)
    if rotation.turns(given):
        turned, table = turned_root("input" in given)
        read = table.read(with_nominal(given), "", problems)
        document = turned.back(read)
        problems += map(rotation.text, _of_other_keys(problems, contradictions(document)))
        if not problems and len(_varied(document)) < len(_varied(read)):
            problems.append("sweep: an angle varies in rad and in deg; keep one of both keys")
    else:
        document = root("input" in given).read(with_nominal(given), "", problems)
        problems += _of_other_keys(problems, contradictions(document))
    told = rotation.text if rotation.turns(given) else str
    if not problems:
        problems += map(told, _missing_in_cases(document))
    if not problems:
        problems += _of_varied(document)
    recorded = document.get("input", {})
    if not problems and recorded.get("kind") == "record" and "sha256" not in recorded:
        problems += _located(recorded, directory)
    if problems:
        raise ConfigError([f"{source}: {problem}" for problem in problems])
    if not _varied(document).keys() & {key for keys in NATURAL.values() for key in keys}:
        document["sweep"].setdefault("omega_n_rad_per_s", natural_frequency(document))
    if OSCILLATOR in document and "title" not in given:
        document["title"] = "friction oscillator" if not rotation.turns(document) else "rotor with friction"
    found = Config(document)
    if SOFTENING in found.effects and found.system != OSCILLATOR:
        for numbers in ({}, *corners(_varied(document))):
            _require_rest(found, source, numbers)
    return found


def _varied(document: Mapping[str, Any]) -> dict[str, Sequence[float]]:
    """Values of the numbers of the model that a checked sweep varies, by dotted key."""
    sweep = document["sweep"]
    listed: dict[str, list[float]] = {}
    for case in sweep.get("case", ()):
        for key in filter(is_model_key, case):
            listed.setdefault(key, []).append(case[key])
    axes = {key: values for key, values in sweep.get("axes", {}).items() if key != ZIP}
    return {**listed, **axes} | (sample.drawn(sweep["sample"]) if "sample" in sweep else {})


def _missing_in_cases(document: Mapping[str, Any]) -> Iterator[str]:
    """Numbers that one case of a list gives, and another lacks, though they have no default."""
    cases = document["sweep"].get("case", ())
    for key in model_keys(cases):
        *tables, name = key.split(".")
        place = reduce(lambda inside, table: inside.get(table, {}), tables, document)
        missing = [i for i, case in enumerate(cases) if key not in case and name not in place]
        if missing:
            yield f"sweep.case[{missing[0]}].{key}: missing; another case gives it, and it has no default"


def _of_varied(document: Mapping[str, Any]) -> Iterator[str]:
    """Contradictions between numbers that the sweep varies, or of one of them with the rest."""
    turned = rotation.turns(document)
    for numbers in corners(_varied(document)):
        for problem in contradictions(with_numbers(document, numbers)):
            own, told = (rotation.written(numbers), rotation.text) if turned else (numbers, str)
            where = ", ".join(f"{key} = {formatting.setting(value)}" for key, value in own.items())
            yield f"sweep, at {where}: {told(problem)}"
            return


def _of_other_keys(problems: Iterable[str], found: Iterable[str]) -> list[str]:
    """The contradictions found, but for those of keys with a problem of their own: they are absent here."""
    faulty = {problem.partition(":")[0].partition("[")[0] for problem in problems}
    return [each for each in found if each.partition(":")[0] not in faulty]


def _located(recorded: dict[str, Any], directory: Path) -> list[str]:
    """Fill in the full path and the digest of a recorded input; what is wrong with its file."""
    recorded["file"] = str((directory / recorded["file"]).resolve())
    try:
        recorded["sha256"] = record.digest(Path(recorded["file"]))
        record.columns(recorded)
    except ConfigError as error:
        return error.problems
    return []


def _require_rest(found: Config, source: str, numbers: Mapping[str, float]) -> None:
    """Refuse springs that soften so much that they have no equilibrium under the weight."""
    case = Case("static-dynamic", 1.0, 1e-3, tuple(numbers.items()))
    if isnan(found.record(case)["geometry"]["rest"][0]):
        problem = "leaves the springs no equilibrium under the weight; it must be larger"
        raise ConfigError([f"{source}: effects.{SOFTENING}.coefficient_N_per_mm3: {problem}"])


def schema() -> dict[str, Any]:
    """JSON schema of a config (draft 2020-12), for editors."""
    whole = {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "$id": f"urn:wedgesweep:config:{__version__}",
        "version": __version__,
        "description": root().meaning,
        "anyOf": [root().shape(), turned_root()[1].shape()],
    }
    return with_shared_parts(whole)


def template() -> str:
    """A config with every key, commented."""
    return commented.template(root())
