"""The recorded load of an oscillator's contact: its mean is the normal force of the model in each test."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from wedgesweep.measured.measurement import TestRecord

KEY = "oscillator.normal_force_N"
# Shares of the mean: what it may move by between PARTS of a record, the standard deviation of all of it, and
# that of the load cell's zero. Friction of the model has as large errors.
PARTS, MOVES, SWINGS, ZERO = 8, 0.1, 0.2, 0.05


def stated(tests: Sequence[TestRecord], at: str, problems: list[str]) -> list[TestRecord]:
    """Tests, found at ``at``, with their mean load (N) in place of its record; faults go to ``problems``."""
    found = []
    for test in tests:
        load = np.zeros(1) if test.normal_force is None else test.normal_force
        mean = float(load.mean())
        if fault := _fault(test, load, mean):
            problems.append(f"{at}: normal_force {fault}")
        else:
            found.append(replace(test, normal_force=None, model={**test.model, KEY: mean}))
    return found


def _fault(test: TestRecord, load: np.ndarray, mean: float) -> str:
    """Why a record (n,) is no load of a model, whose normal force is constant; empty if it is."""
    if mean <= 0.0:
        return f"is {mean:.3g} N on average, but what rubs presses; write sign = -1, or correct its zero"
    if KEY in test.model:
        return f"is recorded, and model states {KEY}; omit one of them"
    parts = [float(part.mean()) for part in np.array_split(load, min(PARTS, load.size))]
    if max(parts) - min(parts) > MOVES * mean or float(load.std()) > SWINGS * mean:
        return (
            f"moves from {min(load):.3g} to {max(load):.3g} N, and the model has one load in a test; use a "
            "part of the record by from_s and to_s"
        )
    if test.zero_std > ZERO * mean:
        return f"has a zero_std of more than {ZERO:.0%} of its mean ({mean:.3g} N); tare the load cell"
    return ""
