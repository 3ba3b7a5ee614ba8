"""Single cases that no sweep holds: settled for longer, or with a changed config."""

from collections.abc import Mapping
from math import nan
from typing import Any

import numpy as np

from wedgesweep import simulate
from wedgesweep.config import Case, Config, from_document
from wedgesweep.reproduce.runs import MM, Run
from wedgesweep.response import NUMBERS
from wedgesweep.solvers.trajectory import CaseError
from wedgesweep.sweep.variables import HARMONICS

# Changes of a config: keys and values by table.
Changes = Mapping[str, Mapping[str, Any]]


def changed(config: Config, changes: Changes) -> Config:
    """The config with some keys changed; settling periods replace a duration."""
    document = {**config.document, **{name: config.document[name] | changes[name] for name in changes}}
    if "settle_periods" in changes.get("solver", {}):
        document["solver"] = {key: value for key, value in document["solver"].items() if key != "duration_s"}
    return from_document(document)


def mirrored_columns(config: Config) -> dict[str, dict[str, float]]:
    """The change that mirrors the column angle."""
    return {"suspension": {"column_angle_deg": -config.document["suspension"]["column_angle_deg"]}}


def record(config: Config, law: str, beta: float, millimetres: float) -> np.ndarray:
    """Parameter record of a case, shape (1,)."""
    return config.record(Case(law, beta, millimetres / MM))


def single(run: Run, law: str, beta: float, millimetres: float, changes: Changes) -> dict[str, float]:
    """Numbers (see response.NUMBERS, SI) of a case of the run's config with some changes.

    All are NaN if the case fails, so that no criterion holds.
    """
    config = changed(run.config, changes)
    try:
        found, _ = simulate.respond(record(config, law, beta, millimetres), config.solver, HARMONICS)
    except CaseError:
        return dict.fromkeys(NUMBERS.names or (), nan)
    return found.numbers
