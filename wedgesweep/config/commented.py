"""The template: a config with every key, its default and its meaning."""

from wedgesweep.config import inputs
from wedgesweep.config.keys import Key
from wedgesweep.config.tables import GridOrList, Table, TableList

HEAD = """\
# Config of wedgesweep. The ending of a key names its unit. Only [sweep] is required; all other keys are shown
# with their defaults. To switch an effect on, remove the "# " before its table and keys.

"""


def template(root: Table) -> str:
    """TOML text of a complete config; what is optional or an alternative is commented out."""
    return HEAD + _body(root, "", "")


def _body(table: Table, path: str, mark: str) -> str:
    return "".join(
        _entry(key, path, "# " if mark or key.optional or place else "")
        for group in table.groups
        for place, key in enumerate(group)
    )


def _entry(key: Key, path: str, mark: str) -> str:
    at = path + key.key
    if isinstance(key, GridOrList):
        only_listed = (each for each in key.listed.keys.values() if each.key not in key.grid.keys)
        lists = "".join(_entry(each, f"{at}.", "# ") for each in only_listed)
        return f"{_entry(key.grid, path, mark)}\n# Instead of a grid, cases one by one:\n{lists}"
    if isinstance(key, inputs.ByKind):
        return inputs.template()
    if isinstance(key, TableList):
        return f"{mark}[[{at}]]\n{_body(key.item, f'{at}.', mark)}"
    if not isinstance(key, Table):
        return f"{mark}{key.written}  # {'; '.join(filter(None, (key.meaning, key.limits)))}\n"
    body = _body(key, f"{at}.", mark)
    holds_only_tables = all(isinstance(each, Table) for each in key.keys.values())
    header = "" if holds_only_tables else f"{mark}[{at}]\n"
    return f"\n# {key.meaning}\n{header}{body}"
