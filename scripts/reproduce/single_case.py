"""Single cases that no sweep holds: settled for longer, or with a changed config."""

from math import nan

import numpy as np

from reproduce.runs import MM, Changes, Run, changed
from wedgesweep import simulate
from wedgesweep.config import Case, Config
from wedgesweep.response import NUMBERS
from wedgesweep.solvers.trajectory import CaseError
from wedgesweep.sweep.variables import HARMONICS


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
