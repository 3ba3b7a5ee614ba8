"""Which figures a folder holds: every file that names one."""

import ast
from importlib import import_module
from pathlib import Path
from types import ModuleType


def declared(folder: Path) -> dict[str, tuple[str, str]]:
    """Module and description of every figure of a folder, by the kind that it draws."""
    found = [(path.stem, _constants(path)) for path in sorted(folder.glob("*.py"))]
    return {
        constants["NAME"]: (stem, constants["DESCRIPTION"])
        for stem, constants in found
        if "NAME" in constants
    }


def load(package: str, found: dict[str, tuple[str, str]]) -> dict[str, ModuleType]:
    """Import the modules of what ``declared`` found, by kind; loads matplotlib."""
    return {kind: import_module(f"{package}.{stem}") for kind, (stem, _) in found.items()}


def _constants(path: Path) -> dict[str, str]:
    """Literals assigned at the top of a file, read without running it: matplotlib loads slowly."""
    return {
        ast.unparse(statement.targets[0]): ast.literal_eval(statement.value)
        for statement in ast.parse(path.read_text(encoding="utf-8")).body
        if isinstance(statement, ast.Assign) and isinstance(statement.value, ast.Constant)
    }
