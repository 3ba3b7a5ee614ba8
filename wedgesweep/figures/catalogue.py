"""Which figures a folder holds. Every file there that defines ``NAME`` is one; no list names it."""

import ast
from dataclasses import dataclass
from importlib import import_module
from inspect import getdoc, signature
from pathlib import Path
from types import ModuleType
from typing import Any

CONSTANTS = ("NAME", "DESCRIPTION", "NEEDS", "CASE_LISTS", "ANY_AXES", "TESTS")


@dataclass(frozen=True)
class FigureKind:
    """A figure as its file declares it.

    ``needs`` are the variables and attributes that a sweep's dataset must have, and ``case_lists`` tells
    whether the figure also draws a dataset that is a list of cases instead of a grid; ``any_axes``, whether
    it draws several models at once. ``tests``: the kind of tests of a diagnosis that it draws, "" for all.
    """

    name: str
    description: str
    module: str
    needs: tuple[str, ...] = ()
    case_lists: bool = False
    any_axes: bool = False
    tests: str = ""

    @property
    def picks(self) -> tuple[str, ...]:
        """Options of the figure, all of which have a default."""
        return tuple(signature(self.load().draw).parameters)[2:]

    @property
    def reading(self) -> str:
        """What to see in the figure, as the docstring of its ``draw`` says it."""
        words = " ".join(str(getdoc(self.load().draw)).partition("To see: ")[2].split())
        return words[:1].upper() + words[1:]

    def load(self) -> ModuleType:
        """Import the file of the figure, and with it matplotlib."""
        return import_module(self.module)


def declared(folder: str | Path, package: str) -> dict[str, FigureKind]:
    """Figures of a folder, which is a package of that name, by the name of the figure."""
    found = [(path.stem, _constants(path)) for path in sorted(Path(folder).glob("*.py"))]
    kinds = [
        FigureKind(module=f"{package}.{stem}", **{key.lower(): value for key, value in constants.items()})
        for stem, constants in found
        if "NAME" in constants
    ]
    return {kind.name: kind for kind in kinds}


def _constants(path: Path) -> dict[str, Any]:
    """Declarations at the top of a file, read without running it: matplotlib loads slowly."""
    assignments = [
        statement
        for statement in ast.parse(path.read_text(encoding="utf-8")).body
        if isinstance(statement, ast.Assign)
    ]
    named = [(ast.unparse(assignment.targets[0]), assignment.value) for assignment in assignments]
    return {name: ast.literal_eval(value) for name, value in named if name in CONSTANTS}
