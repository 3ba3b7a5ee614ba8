"""Measured data of a rig written again as those of a rig of another size."""

import csv
import tomllib
from pathlib import Path

from wedgesweep import toml
from wedgesweep.config import load
from wedgesweep.natural_units import LENGTH, TIME, VELOCITY

DIMENSIONS = {"time": TIME, "displacement": LENGTH, "velocity": VELOCITY}


def resized(example: Path, size, directory: Path) -> Path:
    """Path of the measured.toml of an example at another size, every number in the unit that it had."""
    given = tomllib.loads((example / "measured.toml").read_text())
    measurement = given["measurement"]
    directory.mkdir()
    model = size.config(load(example / measurement["model"]))
    (directory / measurement["model"]).write_text(toml.dumps(model.document))
    columns = {each["column"]: channel for channel, each in measurement["columns"].items()}
    for test in measurement["test"]:
        factors = {column: size.factor(DIMENSIONS[channel]) for column, channel in columns.items()}
        _write(example / test["file"], directory / test["file"], factors)
        test["frequency_hz"] /= size.time
        if "amplitude_mm" in test:
            test["amplitude_mm"] *= size.length
    (directory / "measured.toml").write_text(toml.dumps(given))
    return directory / "measured.toml"


def _write(source: Path, target: Path, factors: dict[str, float]) -> None:
    with source.open() as lines, target.open("w", newline="") as out:
        rows = csv.DictReader(lines)
        table = csv.DictWriter(out, rows.fieldnames)
        table.writeheader()
        for row in rows:
            table.writerow({name: repr(float(row[name]) * factors.get(name, 1.0)) for name in row})
