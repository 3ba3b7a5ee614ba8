"""The files of a synthetic measurement: measured.toml, model.toml, a CSV per test, truth.json."""

import json
import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from wedgesweep import toml
from wedgesweep.config import Config
from wedgesweep.errors import InputError
from wedgesweep.files import beside


@dataclass(frozen=True, eq=False)
class Table:
    """Content of a CSV file: time in s, displacement in mm, velocity in mm/s, shape (n,) each.

    ``input``: as recorded, in its SI unit; ``force`` (N); None where not measured.
    """

    time: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray | None
    input: np.ndarray | None = None
    force: np.ndarray | None = None


def require_free(directory: Path) -> None:
    """Check before the work that a directory is empty or can be created; raises InputError."""
    if directory.exists() and (not directory.is_dir() or any(directory.iterdir())):
        raise InputError([f"{directory}: not an empty directory; choose another, or remove it"])
    if not directory.parent.is_dir():
        raise InputError([f"{directory.parent}: not a directory; create it"])


def write(
    directory: Path, measured: dict[str, Any], model: Config, tables: Sequence[Table], truth: dict[str, Any]
) -> None:
    """Write all files into a directory, or nothing."""
    with beside(directory) as partial:
        (partial / "measured.toml").write_text(toml.dumps(measured), encoding="utf-8")
        (partial / "model.toml").write_text(model.to_toml(), encoding="utf-8")
        (partial / "truth.json").write_text(json.dumps(truth, indent=1) + "\n", encoding="utf-8")
        for test, table in zip(measured["measurement"]["test"], tables, strict=True):
            _write_csv(partial / test["file"], table)
        os.replace(partial, directory)


def _write_csv(path: Path, table: Table) -> None:
    named = {
        "t": table.time,
        "d": table.displacement,
        "v": table.velocity,
        "u": table.input,
        "F": table.force,
    }
    columns = {name: each for name, each in named.items() if each is not None}
    formats = ["%.7f", *["%.7g"] * (len(columns) - 1)]
    content, header = np.column_stack(list(columns.values())), ",".join(columns)
    np.savetxt(path, content, fmt=formats, delimiter=",", header=header, comments="")
