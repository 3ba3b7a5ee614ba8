"""Tables of keys, and the two forms of [sweep]."""

from dataclasses import dataclass
from itertools import combinations
from typing import Any

from wedgesweep.config.keys import Key
from wedgesweep.hints import hint, show

Group = tuple[Key, ...]


@dataclass(frozen=True, kw_only=True)
class Table(Key):
    """Keys in groups; keys of a group exclude each other, and the first one has the default.

    ``unknown`` says what a key is that the table does not have.
    """

    groups: tuple[Group, ...]
    unknown: str = "unknown key"

    @property
    def keys(self) -> dict[str, Key]:
        return {key.key: key for group in self.groups for key in group}

    @property
    def written(self) -> str:
        return f"[{self.example or self.key}] with {self.required_keys}"

    @property
    def required_keys(self) -> str:
        return ", ".join(group[0].written for group in self.groups if group[0].required)

    def read(self, value: Any, path: str, problems: list[str]) -> dict[str, Any]:
        if not isinstance(value, dict):
            problems.append(f"{path}: {show(value)} is not a table; write [{path}], its keys below")
            return {}
        at = f"{path}." if path else ""
        unknown = (name for name in value if name not in self.keys)
        problems.extend(f"{at}{name}: {self.unknown}; {hint(name, self.keys)}" for name in unknown)
        read = {}
        for group in self.groups:
            for key in _in_force(group, value, at, problems):
                read[key.key] = key.read(value.get(key.key, key.default), at + key.key, problems)
        return {name: each for name, each in read.items() if each is not None}

    def shape(self) -> dict[str, Any]:
        rules = [rule for group in self.groups for rule in _rules(group)]
        return {
            "type": "object",
            "properties": {name: key.schema() for name, key in self.keys.items()},
            "additionalProperties": False,
            **({"allOf": rules} if rules else {}),
        }


def table(key: str, meaning: str, *entries: Key | Group, kind: type[Table] = Table, **more: Any) -> Table:
    """Make a table of a kind; an entry is a key, or a tuple of keys that exclude each other."""
    groups = tuple(entry if isinstance(entry, tuple) else (entry,) for entry in entries)
    return kind(key=key, meaning=meaning, groups=groups, **more)


def _in_force(group: Group, value: dict[str, Any], at: str, problems: list[str]) -> Group:
    """Keys of a group to read: those given, else the one with the default."""
    given = tuple(key for key in group if key.key in value)
    if len(given) > 1:
        names = " and ".join(key.key for key in given)
        problems.append(f"{at}{given[-1].key}: {names} exclude each other; keep one of them")
    if not given and group[0].required:
        right = " or ".join(key.written for key in group)
        problems.append(f"{at}{group[0].key}: missing; write {right}")
    return given or tuple(key for key in group[:1] if key.default is not None)


def _rules(group: Group) -> list[dict[str, Any]]:
    """The rules of ``_in_force`` as JSON schema."""
    if group[0].required:
        return [{"oneOf": [{"required": [key.key]} for key in group]}]
    return [{"not": {"required": [a.key, b.key]}} for a, b in combinations(group, 2)]


@dataclass(frozen=True, kw_only=True)
class TableList(Key):
    """A list of different tables, [[path]]."""

    item: Table

    @property
    def written(self) -> str:
        needed = self.item.required_keys
        return f"[[{self.example or self.key}]]" + (f" with {needed}" if needed else " for each")

    def read(self, value: Any, path: str, problems: list[str]) -> list[dict[str, Any]] | None:
        if not isinstance(value, list) or not value:
            problems.append(f"{path}: {show(value)} is not a list of tables; write [[{path}]] for each")
            return None
        read = [self.item.read(each, f"{path}[{i}]", problems) for i, each in enumerate(value)]
        first: dict[str, int] = {}
        for i, each in enumerate(read):
            if each and (there := first.setdefault(repr(each), i)) != i:
                problems.append(f"{path}[{i}]: repeats {path}[{there}]; keep one")
        return read

    def shape(self) -> dict[str, Any]:
        return {"type": "array", "items": self.item.shape(), "minItems": 1, "uniqueItems": True}


@dataclass(frozen=True, kw_only=True)
class GridOrList(Key):
    """A table that is a grid of cases or, if it has the key that only ``listed`` has, a list of them.

    ``scaled`` is its form beside a table [input], which reads it instead.
    """

    grid: Table
    listed: Table
    scaled: Table

    @property
    def written(self) -> str:
        return self.grid.written

    def read(self, value: Any, path: str, problems: list[str]) -> dict[str, Any]:
        only_listed = self.listed.keys.keys() - self.grid.keys.keys()
        if not isinstance(value, dict) or not only_listed & value.keys():
            return self.grid.read(value, path, problems)
        clash = [name for name in value if name in self.grid.keys.keys() - self.listed.keys.keys()]
        problems.extend(
            f"{path}.{name}: a grid and [[{path}.{only}]] exclude each other; keep one of them"
            for name in clash
            for only in only_listed
        )
        rest = {name: each for name, each in value.items() if name not in clash}
        return self.listed.read(rest, path, problems)

    def shape(self) -> dict[str, Any]:
        return {"oneOf": [self.grid.shape(), self.listed.shape(), self.scaled.shape()]}
