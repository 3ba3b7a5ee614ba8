"""The tests of a data set: below and above resonance, no wedge lifts off, none stands still."""

from math import pi
from typing import NamedTuple

import numpy as np

from wedgesweep import config, parameters, response, tally
from wedgesweep.config import Config, toml
from wedgesweep.solvers import event_driven
from wedgesweep.solvers.march import workspace

# Frequencies (Hz) with the number of amplitudes at each; every set moves them a little.
TWELVE = ((5.0, 2), (8.0, 2), (11.0, 1), (20.0, 2), (24.0, 2), (28.0, 1), (32.0, 2))
PAPER = ((20.0, 1), (30.0, 1))
MOVED = 0.05
# Accelerations (m/s^2) of the side frame that are tried.
LADDER = np.geomspace(0.35, 4.0, 40)
LEAST_FORCE, MOST_STUCK = 0.3, 0.7
MODEL = """\
title = "system under test"
[suspension]
column_angle_deg = {lean}
[sweep]
friction_law = "{law}"
beta = 1.0
amplitude_mm = 0.1
"""
PLAN = event_driven.Plan(1, 128, True, 1e-6, 300)


class Test(NamedTuple):
    """One test of a plan."""

    frequency_hz: float
    amplitude_mm: float


def model(law: str, lean: float, effects: dict[str, dict[str, float]] | None = None) -> str:
    """Config text of a system with effects (numbers in key units)."""
    return MODEL.format(law=law, lean=lean) + toml.dumps({"effects": effects or {}})


def records(system: Config, law: str, tests: list[Test]) -> np.ndarray:
    """Parameter records of tests, shape (n,)."""
    rows = [
        parameters.record(
            law,
            1e-3 * test.amplitude_mm,
            2.0 * pi * test.frequency_hz,
            system.suspension,
            system.friction,
            system.effects,
        )
        for test in tests
    ]
    return np.concatenate(rows)


def motion(rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Smallest normal force (N) and share of time stuck of steady responses, (n,) each; NaN if it locks."""
    batch = event_driven.empty_batch(len(rows), 1, 0)
    settle = np.zeros(len(rows), np.int64)
    event_driven.run_batch(rows, settle, PLAN, tally.empty(), workspace(1e-7), batch)
    force, stuck = (response.NUMBERS.index(n) for n in ("minimum_normal_force", "stick_fraction"))
    numbers = np.where((batch.outcome == 0)[:, None], batch.numbers, np.nan)
    return numbers[:, force], numbers[:, stuck]


def draw(law: str, lean: float, grid: tuple, random: np.random.Generator) -> list[Test] | None:
    """Tests at the frequencies of ``grid``; None where no amplitude suits one of them."""
    system, tests = config.parse(model(law, lean)), []
    for nominal, count in grid:
        move = MOVED if len(grid) > len(PAPER) else 0.0
        frequency = round(nominal * (1.0 + random.uniform(-move, move)), 3)
        amplitudes = 1e3 * LADDER / (2.0 * pi * frequency) ** 2
        force, stuck = motion(records(system, law, [Test(frequency, a) for a in amplitudes]))
        fit = amplitudes[(force > LEAST_FORCE) & (stuck < MOST_STUCK)]
        if fit.size < 2:
            return None
        low, high = fit[0], fit[-1]
        shares = (0.1, 0.85) if count == 2 else (0.45,)
        for share in shares:
            part = share + random.uniform(-0.1, 0.1)
            tests.append(Test(frequency, float(f"{low * (high / low) ** part:.4g}")))
    return tests


def suits(system: Config, law: str, tests: list[Test]) -> bool:
    """Whether the true system, too, keeps its wedges pressed and moves in every test."""
    force, stuck = motion(records(system, law, tests))
    return bool(((force > 0.0) & (stuck < 0.95)).all())
