"""The template: a config with every key, its meaning, and its default or what a beginner should choose."""

from typing import Any

from wedgesweep import toml
from wedgesweep.config import inputs
from wedgesweep.config.axes import TABLES, WithNumbers
from wedgesweep.config.keys import Key
from wedgesweep.config.tables import GridOrList, Table, TableList

HEAD = """\
# Config of wedgesweep. The ending of a key names its unit. Only [sweep] is required; all other keys are shown
# with their defaults, except in [solver]. To switch an effect on, remove the "# " before its table and keys.

"""

# What the template says in place of defaults, and why: steady states of any grid, in seconds.
CHOSEN: dict[str, Any] = {"solver.method": "event-driven", "solver.settle": "steady"}
REASONS = {
    "solver": """\
# Here: steady states by the event-driven solver. Radau, the default of method, is the slower, independent
# choice: write method = "radau", and settle_periods or duration_s in place of settle. To have Radau verify
# some cases of any sweep: wedgesweep run CONFIG --verify 20
""",
}


def template(root: Table) -> str:
    """TOML text of a complete config; what is optional or an alternative is commented out."""
    return HEAD + _body(root, "", "")


def _body(table: Table, path: str, mark: str) -> str:
    lines = []
    for group in table.groups:
        written = next((key for key in group if path + key.key in CHOSEN), group[0])
        for key in group:
            off = mark or key is not written or (key.optional and path + key.key not in CHOSEN)
            lines.append(_entry(key, path, "# " if off else ""))
    if isinstance(table, WithNumbers):
        name, value = table.example
        lines.append(f'# "{name}" = {toml.inline(value)}  # or any other number of {", ".join(TABLES)}\n')
    return "".join(lines)


def _entry(key: Key, path: str, mark: str) -> str:
    at = path + key.key
    if isinstance(key, GridOrList):
        only_listed = (each for each in key.listed.keys.values() if each.key not in key.grid.keys)
        lists = "".join(_entry(each, f"{at}.", "# ") for each in only_listed)
        return f"{_entry(key.grid, path, mark)}\n# Instead of a grid, cases one by one:\n{lists}"
    if isinstance(key, inputs.ByKind):
        return _kinds(key)
    if isinstance(key, TableList):
        return f"{mark}[[{at}]]\n{_body(key.item, f'{at}.', mark)}"
    if not isinstance(key, Table):
        written = f"{key.key} = {toml.inline(CHOSEN[at])}" if at in CHOSEN else key.written
        return f"{mark}{written}  # {_about(key)}\n"
    body = _body(key, f"{at}.", mark)
    holds_only_tables = all(isinstance(each, Table) for each in key.keys.values())
    header = "" if holds_only_tables else f"{mark}[{at}]\n"
    return f"\n# {key.meaning}\n{REASONS.get(at, '')}{header}{body}"


def _about(key: Key) -> str:
    return "; ".join(filter(None, (key.meaning, key.limits)))


def _kinds(key: inputs.ByKind) -> str:
    """All kinds of a table, commented out."""
    scale = inputs.SCALE
    lines = [
        f"\n# {key.meaning}:\n# then [sweep] holds only friction_law and scale, and [solver] no settle\n"
    ]
    lines.append(f"# sweep.{scale.written}  # {scale.meaning}\n")
    for name, kind in key.kinds.items():
        lines.append(f"# kind {name}: {kind.meaning}\n# [{key.key}]\n# {inputs.KIND} = {toml.inline(name)}\n")
        inner = (each for group in kind.groups[1:] for each in group)
        lines += (f"# {each.written}  # {_about(each)}\n" for each in inner)
    return "".join(lines)
