"""The files of a synthetic measurement: measured.toml, model.toml, a CSV per test, truth.json."""

import json
import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from wedgesweep.config import Config, toml
from wedgesweep.errors import InputError
from wedgesweep.files import beside


@dataclass(frozen=True, eq=False)
class Table:
    """Content of a CSV file: time in s, displacement in mm, velocity in mm/s, shape (n,) each.

    ``input``: as recorded, in its SI unit, or None.
    """

    time: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray
    input: np.ndarray | None = None


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
    columns, header = [table.time, table.displacement, table.velocity], "t,d,v"
    if table.input is not None:
        columns, header = [*columns, table.input], f"{header},u"
    formats = ["%.7f", *["%.7g"] * (len(columns) - 1)]
    np.savetxt(path, np.column_stack(columns), fmt=formats, delimiter=",", header=header, comments="")
