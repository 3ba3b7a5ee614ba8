"""Pictures of a dataset: one figure per file, drawn from the dataset alone.

A file that defines ``NAME``, ``DESCRIPTION`` and ``draw(ds, **options) -> Figure`` is a figure;
nothing else has to know of it. Options are in SI units, as the dataset is; mm exist on axes only.
"""

import ast
import os
from importlib import import_module
from pathlib import Path

FORMATS = (".png", ".pdf", ".svg")
DOTS_PER_INCH = 200


def _constants(path: Path) -> dict[str, str]:
    """Literals assigned at the top of a file, read without running it: matplotlib loads slowly."""
    return {
        ast.unparse(statement.targets[0]): ast.literal_eval(statement.value)
        for statement in ast.parse(path.read_text(encoding="utf-8")).body
        if isinstance(statement, ast.Assign) and isinstance(statement.value, ast.Constant)
    }


def _declared() -> dict[str, tuple[str, str]]:
    """Find module and description of every figure by the kind that it draws."""
    files = sorted(Path(__file__).parent.glob("*.py"))
    found = [(path.stem, _constants(path)) for path in files if path.stem != "__init__"]
    return {
        constants["NAME"]: (stem, constants["DESCRIPTION"])
        for stem, constants in found
        if "NAME" in constants
    }


_DECLARED = _declared()
DESCRIPTIONS = {kind: description for kind, (_, description) in _DECLARED.items()}


def __getattr__(name: str):
    """``FIGURES`` (kind -> module) loads matplotlib, so it is made when first asked for."""
    if name != "FIGURES":
        message = f"module {__name__!r} has no attribute {name!r}"
        raise AttributeError(message)
    return {kind: import_module(f"{__name__}.{stem}") for kind, (stem, _) in _DECLARED.items()}


def save(figure, path: str | Path) -> None:
    """Write a figure as PNG, PDF or SVG, by the suffix; an interrupted write leaves no broken file.

    Raises
    ------
    ValueError
        The suffix is none of ``FORMATS``.
    """
    path = Path(path)
    if path.suffix.lower() not in FORMATS:
        valid = ", ".join(FORMATS)
        message = f"{path}: cannot write '{path.suffix}'; the suffix must be one of {valid}"
        raise ValueError(message)
    partial = path.with_name(f".{path.name}.{os.getpid()}.partial")
    try:
        figure.savefig(partial, format=path.suffix.lower()[1:], dpi=DOTS_PER_INCH)
        partial.replace(path)
    finally:
        partial.unlink(missing_ok=True)
