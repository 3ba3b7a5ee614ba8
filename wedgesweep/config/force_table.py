"""The table of ``effects.empirical_force``: its keys, or a CSV file in their place.

The file has a row for each node, places from the lowest on and at each of them speeds from the lowest on.
When a config is read the file is replaced by what it holds.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from wedgesweep import rotation
from wedgesweep.config.keys import Number, Text
from wedgesweep.config.series import Numbers
from wedgesweep.config.tables import table
from wedgesweep.effects import empirical_force
from wedgesweep.effects.empirical_force import EFFECT, PLACES, SPEEDS, TABLE
from wedgesweep.readers import ReadError, text

PLACE, SPEED, CENTRE = EFFECT.quantities
FORCE = Number.new("force_N", "force at a node", 0.0)
FILE, HEADER = "table", (PLACE.key, SPEED.key, FORCE.key)
KEYS = table(
    EFFECT.name,
    EFFECT.described(),
    (
        Text(FILE, f"CSV file with columns {', '.join(HEADER)}", example="empirical-force.csv"),
        Number.of(PLACE, example=1.0),
    ),
    Number.of(SPEED, optional=True, example=50.0),
    Number.of(CENTRE),
    Numbers(
        TABLE, f"forces at {PLACES} x {SPEEDS} nodes, up positive", item=FORCE, optional=True, example=[0.0]
    ),
    optional=True,
)
# Places and speeds of a file may differ from the nodes by this share of the largest one.
ROUNDED = 1e-3


def expanded(given: Mapping[str, Any], directory: Path, problems: list[str]) -> Mapping[str, Any]:
    """A config with the table of its file, if it names one, relative to ``directory``."""
    effects = given.get("effects")
    own = effects.get(EFFECT.name) if isinstance(effects, dict) else None
    if not isinstance(own, dict):
        return given
    keys = [
        rotation.turned_key(key)[0] if rotation.turns(given) else key for key in (PLACE.key, SPEED.key, TABLE)
    ]
    at = f"effects.{EFFECT.name}"
    if isinstance(own.get(FILE), str):
        own = _of_file(directory / own[FILE], f"{at}.{FILE}", problems)
        own = rotation.written(own) if rotation.turns(given) else own
    elif {*keys} - own.keys():
        problems.append(f"{at}: write {FILE}, or all of {', '.join(keys)}")
    elif isinstance(own[keys[-1]], list) and len(own[keys[-1]]) != PLACES * SPEEDS:
        problems.append(f"{at}.{keys[-1]}: {len(own[keys[-1]])} forces; it must be {PLACES * SPEEDS}")
    return {**given, "effects": {**given["effects"], EFFECT.name: own}}


def written(displacement: float, velocity: float, centre: float, forces: np.ndarray) -> str:
    """The text of a file: ranges and centre in mm and mm/s, forces (PLACES, SPEEDS) in N."""
    places, speeds = empirical_force.nodes(displacement, velocity, centre)
    rows = [
        f"{place:.8g},{speed:.8g},{forces[i, j]:.8g}"
        for i, place in enumerate(places)
        for j, speed in enumerate(speeds)
    ]
    return "\n".join([",".join(HEADER), *rows]) + "\n"


def _of_file(file: Path, at: str, problems: list[str]) -> dict[str, Any]:
    try:
        read = text.read(file, HEADER)
        found = np.array([read.channels[name].values for name in HEADER])
    except ReadError as error:
        problems += [f"{at}: {problem}" for problem in error.problems]
        return {FILE: str(file)}
    except OSError as error:
        problems.append(f"{at}: {file}: {error.strerror}; give the path of a CSV file")
        return {FILE: str(file)}
    if found.shape[1] != PLACES * SPEEDS:
        problems.append(f"{at}: {file}: {found.shape[1]} rows; it must be {PLACES * SPEEDS}")
        return {FILE: str(file)}
    largest, centre = 0.5 * np.ptp(found[:2], axis=1), 0.5 * (found[0].min() + found[0].max())
    places, speeds = empirical_force.nodes(float(largest[0]), float(largest[1]), float(centre))
    expected = np.meshgrid(places, speeds, indexing="ij")
    for name, values, nodes, size in zip(HEADER, found, expected, largest, strict=False):
        off = ~(np.abs(values - nodes.ravel()) <= ROUNDED * size)
        if off.any():
            row = int(np.argmax(off))
            wanted = f"{nodes.ravel()[row]:.6g}"
            problems.append(
                f"{at}: {read.where(row)}: {name}: {values[row]:.6g} is no node; it must be {wanted}"
            )
    if not np.isfinite(found[2]).all():
        problems.append(f"{at}: {read.where(int(np.argmin(np.isfinite(found[2]))))}: no number; write one")
    ranges = {PLACE.key: float(largest[0]), SPEED.key: float(largest[1]), CENTRE.key: float(centre)}
    return {**ranges, TABLE: found[2].tolist()}
