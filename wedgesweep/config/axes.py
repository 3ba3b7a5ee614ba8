"""Numbers of model and input that a sweep varies: dotted keys such as "suspension.wedge_angle_deg"."""

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import product
from typing import Any, TypeAlias

from wedgesweep.config.inputs import ByKind
from wedgesweep.config.keys import Choice, Key, Number, Whole
from wedgesweep.config.series import Numbers, Series, Several
from wedgesweep.config.tables import Table
from wedgesweep.hints import hint, show
from wedgesweep.systems.suspension.parameters import DAMPING

# What an axis holds the values of.
Varied: TypeAlias = Number | Choice
ZIP = "zip"
NO_NUMBER = "no number of a model that may vary"
# Tables whose numbers may vary; those whose names the dimensions of a dataset leave out.
INPUT = "input"
TABLES = ("suspension", "oscillator", "friction", "effects", INPUT)
# Choices that vary, by key; elsewhere than in configs and datasets a name is its place in the list.
CHOICES = {"suspension.damping": DAMPING}
# Keys that do not vary, and why.
SHARED_TIMES = (
    "all cases of a dataset share their times, so that it does not vary; run a config for each value"
)
FIXED = {
    **dict.fromkeys((f"{INPUT}.duration_s", f"{INPUT}.sampling_hz"), SHARED_TIMES),
    "suspension.joints": "datasets of both kinds have different variables; run a config for each",
}
# A tolerance, and the numbers of a range or a distribution that stand for it.
TOLERANCE = re.compile(r"\s*([-+.\deE]+?)\s*(?:\+-|±)\s*([.\deE]+)\s*(%?)\s*")
MIDDLES = ("start", "mean", "median", "low")
LEFT_OUT = ("suspension", "oscillator", "effects")
# Tables that hold numbers without a default.
WITHOUT_DEFAULT = ("oscillator", "effects", INPUT)
# More combinations of extreme values than this are not checked for contradictions.
MOST_CORNERS = 4096


def is_model_key(name: str) -> bool:
    """Whether a name is the dotted key of a number of the model."""
    return "." in name


def model_keys(cases: Iterable[Mapping[str, Any]]) -> list[str]:
    """Dotted keys of the numbers of the model that any of listed cases gives."""
    return list(dict.fromkeys(key for case in cases for key in case if is_model_key(key)))


def dimension(key: str) -> str:
    """Name of a key in datasets: wedge_angle_deg, friction_dynamic, preload_force_N."""
    table, _, rest = key.partition(".")
    return (rest if table in LEFT_OUT else key).replace(".", "_")


def coded(key: str, value: float | str) -> float | str:
    """A value as cases hold it."""
    return float(CHOICES[key].index(value)) if isinstance(value, str) else value


def named(key: str, value: float) -> float | str:
    """A value as a config holds it."""
    return CHOICES[key][int(value)] if key in CHOICES else value


def numbers_of(tables: Table) -> dict[str, Varied]:
    """All numbers that may vary, and choices, by dotted key."""
    return {key: each for key, each in _numbers(tables, "") if key not in FIXED}


def _numbers(table: Table, path: str) -> Iterator[tuple[str, Varied]]:
    for key in table.keys.values():
        if not path and key.key not in TABLES:
            continue
        if isinstance(key, Number) or (isinstance(key, Choice) and f"{path}{key.key}" in CHOICES):
            yield f"{path}{key.key}", key
        elif isinstance(key, Table):
            yield from _numbers(key, f"{path}{key.key}.")
        elif isinstance(key, ByKind):
            for kind in key.kinds.values():
                yield from _numbers(kind, f"{path}{key.key}.")


def flat(given: Mapping[str, Any]) -> dict[str, Any]:
    """Dotted keys of a table that was written with or without quotes."""
    found: dict[str, Any] = {}
    for name, value in given.items():
        # A range or a distribution is no part of a dotted key.
        nested = isinstance(value, dict) and not {"start", "distribution"} & value.keys()
        if nested and name.split(".")[0] in TABLES and name.count(".") < 2:
            found |= flat({f"{name}.{inner}": each for inner, each in value.items()})
        else:
            found[name] = value
    return found


def given_number(document: Mapping[str, Any], key: str) -> float:
    """The number of a dotted key in a document that has it."""
    place: Any = document
    for name in key.split("."):
        place = place[name]
    return float(place)


def with_numbers(document: Mapping[str, Any], numbers: Mapping[str, float | str]) -> dict[str, Any]:
    """A document with other numbers, by dotted key; tables that are not there are made."""
    changed = dict(document)
    for key, number in numbers.items():
        *tables, name = key.split(".")
        place = changed
        for table in tables:
            inside = place.get(table, {})
            place[table] = dict(inside) if isinstance(inside, dict) else inside
            place = place[table]
        if isinstance(place, dict):
            place[name] = number
    return changed


def with_nominal(given: Mapping[str, Any]) -> Mapping[str, Any]:
    """A config with a number in place of each that it only varies, and that has no default: the first one."""
    sweep = given.get("sweep")
    if not isinstance(sweep, dict):
        return given
    listed = sweep.get("case")
    tables = [sweep.get("axes"), sweep.get("sample"), *(listed if isinstance(listed, list) else ())]
    firsts: dict[str, Any] = {}
    for each in tables:
        if isinstance(each, dict):
            firsts = {key: _first(value) for key, value in flat(each).items() if is_model_key(key)} | firsts
    absent = {
        key: value
        for key, value in firsts.items()
        if value is not None and key.split(".")[0] in WITHOUT_DEFAULT and not _stands(given, key)
    }
    return with_numbers(given, absent)


def _first(values: Any) -> Any:
    """A number out of the values of an axis, a distribution or a case; None where there is none."""
    while isinstance(values, list | dict | str):
        if isinstance(values, str):
            parts = TOLERANCE.fullmatch(values)
            values = float(parts[1]) if parts else None
        elif isinstance(values, list):
            values = values[0] if values else None
        else:
            values = next((values[name] for name in MIDDLES if name in values), None)
    return values


def _stands(given: Mapping[str, Any], key: str) -> bool:
    """Whether a config has a number itself, or a default of it."""
    table, _, name = key.partition(".")
    place: Any = given.get(table, {})
    if table == "effects" and isinstance(place, dict):
        effect, _, name = name.partition(".")
        place = place.get(effect, {})
    return isinstance(place, dict) and name in place


@dataclass(frozen=True, kw_only=True)
class WithNumbers(Table):
    """A table that also has dotted keys of ``numbers`` of the model, each with a value of some kind."""

    numbers: Mapping[str, Varied]

    def read(self, value: Any, path: str, problems: list[str]) -> dict[str, Any]:
        if not isinstance(value, dict):
            return super().read(value, path, problems)
        given = flat(value)
        read = super().read({key: given[key] for key in given if not is_model_key(key)}, path, problems)
        for key in filter(is_model_key, given):
            if key in self.numbers:
                at = f'{path}."{key}"'
                read[key] = self.read_number(self.numbers[key], given[key], at, problems, read)
            else:
                fault = f"{NO_NUMBER}; {hint(key, _near(key, self.numbers))}"
                problems.append(f"{path}.{key}: {FIXED.get(key, fault)}")
        return {key: each for key, each in read.items() if each is not None}

    def read_number(
        self, number: Varied, value: Any, path: str, problems: list[str], read: Mapping[str, Any]
    ) -> Any:
        """Check the value of a dotted key; ``read`` holds the other keys."""
        return number.read(value, path, problems)

    def number_shape(self, number: Varied) -> dict[str, Any]:
        """JSON schema of the value of a dotted key."""
        return number.shape()

    def shape(self) -> dict[str, Any]:
        own = super().shape()
        for key, number in self.numbers.items():
            about = {"description": number.meaning} | self.number_shape(number)
            own["properties"][key] = about
            # The same without quotes: a table in a table.
            *tables, name = key.split(".")
            place = own
            for table in tables:
                closed = {"properties": {}, "additionalProperties": False}
                empty = {"type": "object", "description": f"numbers of {table}", **closed}
                place = place["properties"].setdefault(table, empty)
            place["properties"][name] = about
        return own


def _near(key: str, numbers: Mapping[str, Varied]) -> list[str]:
    """The numbers of the same table, of which there are few enough to list."""
    table = key.split(".")[0]
    return [name for name in numbers if name.startswith(f"{table}.")] or [f"{name}.KEY" for name in TABLES]


@dataclass(frozen=True, kw_only=True)
class Groups(Key):
    """Groups of keys that go together; a single group may be written without the outer brackets."""

    def read(self, value: Any, path: str, problems: list[str]) -> list[list[str]] | None:
        groups = (
            [value] if isinstance(value, list) and all(isinstance(each, str) for each in value) else value
        )
        named = isinstance(groups, list) and all(
            isinstance(group, list) and len(group) > 1 and all(isinstance(key, str) for key in group)
            for group in groups
        )
        if not named:
            problems.append(f'{path}: {show(value)} is no list of keys that go together; write ["a", "b"]')
            return None
        names = [key for group in groups for key in group]
        problems.extend(f"{path}: {key} is repeated; keep one" for key in names if names.count(key) > 1)
        return groups

    def shape(self) -> dict[str, Any]:
        names = {"type": "array", "items": {"type": "string"}, "minItems": 2}
        return {"anyOf": [names, {"type": "array", "items": names}]}


TOGETHER = Groups(
    ZIP,
    "axes that go together: their first values, their second ones, ...",
    optional=True,
    example=["suspension.bolster_mass_kg", "suspension.wedge_mass_kg"],
)


@dataclass(frozen=True, kw_only=True)
class Axes(WithNumbers):
    """[sweep.axes]: values of numbers, and which of them go together."""

    def read(self, value: Any, path: str, problems: list[str]) -> dict[str, Any]:
        read = super().read(value, path, problems)
        for group in read.get(ZIP, ()):
            absent = [key for key in group if key not in read]
            problems.extend(f"{path}.{ZIP}: {key} is no axis; {hint(key, read)}" for key in absent)
            if not absent and len({len(read[key]) for key in group}) > 1:
                problems.append(f"{path}.{ZIP}: {', '.join(group)} hold different numbers of values")
        return read

    def read_number(
        self, number: Varied, value: Any, path: str, problems: list[str], read: Mapping[str, Any]
    ) -> Any:
        series = _series(number)
        # What goes together with another axis need not increase.
        follows = any(path.endswith(f'"{key}"') for group in read.get(ZIP, ()) for key in group[1:])
        kind = Numbers(number.key, "", item=number) if follows and isinstance(value, list) else series
        return kind.read(value, path, problems)

    def number_shape(self, number: Varied) -> dict[str, Any]:
        return _series(number).shape()


def _series(item: Varied) -> Several:
    """The values of an axis; names and whole numbers are listed."""
    if isinstance(item, Choice | Whole):
        return Several(item.key, "", item=item)
    return Series(item.key, "", item=item)


def corners(values: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
    """Each value of each key alone, where they are few, and all combinations of smallest and largest ones."""
    for key, own in values.items():
        if len(own) <= MOST_CORNERS:
            yield from ({key: _plain(value)} for value in own)
    ends = [(_plain(min(own)), _plain(max(own))) for own in values.values()]
    if 2 ** len(ends) <= MOST_CORNERS:
        yield from (dict(zip(values, each, strict=True)) for each in product(*ends))


def _plain(value: Any) -> float | int | str:
    """A value as a config holds it, also one that was drawn."""
    return value if isinstance(value, int | str) else float(value)
