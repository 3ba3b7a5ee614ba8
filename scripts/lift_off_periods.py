"""What the paper's cases with unilateral joints do that repeat in no more than 8 periods of the input.

Each such case runs on from rest for thousands of periods. Its states once a period then tell whether it
repeats after a longer time, and a second run beside it, brought close again after each period, how fast small
differences grow: Lyapunov's exponent (Benettin et al., 1980), per period.

.venv/bin/python scripts/lift_off_periods.py
"""

from dataclasses import replace
from math import inf
from pathlib import Path

import numpy as np
from reproduce.runs import UNILATERAL, changed

from wedgesweep import config
from wedgesweep.solvers.period_map import memory, prepared, run_periods
from wedgesweep.sweep import variables
from wedgesweep.sweep.cases import solve_cases
from wedgesweep.systems import compact

PAPER = Path(__file__).parents[1] / "configs" / "paper.toml"
MOST_PERIODS = 1000
SETTLE, PERIODS, RTOL = 8000, 4000, 1e-10
# States over their natural sizes: distance of the second run, and of a state that counts as the same.
BESIDE, SAME = 1e-8, 1e-6
# Longest period that is looked for, and the exponent above which a motion is chaotic.
LONGEST, CHAOTIC = 1500, 5e-3


def without_period(name, study):
    """Records of the cases whose period was not found; prints how many cases have which period (0: none)."""
    cases, settings = study.records(), study.solver
    settings = replace(settings, duration=None, steady=True, max_periods=MOST_PERIODS)
    dtype = variables.record_dtype({"phase": 0, "harmonic": variables.HARMONICS, "part": 2})
    found = solve_cases(cases, np.arange(len(cases)), settings, inf, dtype)
    periods, counts = np.unique(found["period"][found["status"] == 0], return_counts=True)
    print(name, "joints, cases by period:", dict(zip(periods.tolist(), counts.tolist(), strict=True)))
    return cases[found["period"] == 0]


class Pair:
    """Two runs of a case beside each other."""

    def __init__(self, case):
        self.cases, self.room = prepared(compact(case)), memory(RTOL, 8, 1)
        self.size, self.y = self.cases.scales[0], np.zeros(self.cases.scales.shape[1])
        self.run(self.y, SETTLE)
        self.place_beside(np.ones(self.size.size))

    def run(self, y, periods=1):
        """Run some periods; which states may take other values there."""
        outcome = run_periods(self.cases, 0, periods, y, False, self.room)
        assert outcome == 0, outcome
        return self.room.free[: y.size].copy()

    def place_beside(self, direction):
        """Put the second run close to the first one."""
        self.other = self.y + direction * (BESIDE / np.linalg.norm(direction)) * self.size

    def period(self):
        """Run a period; the growth of the distance, as a logarithm."""
        free = self.run(self.y)
        self.run(self.other)
        apart = np.where(free, (self.other - self.y) / self.size, 0.0)
        distance = np.linalg.norm(apart)
        # At rest all differences may vanish.
        self.place_beside(apart if distance > 0.0 else np.where(free, 1.0, 1e-30))
        return np.log(max(distance, 1e-30) / BESIDE)


def followed(case):
    """Period of a case (0: longer than LONGEST, or none), and its exponent."""
    pair, states, growth = Pair(case), [], []
    for _ in range(PERIODS):
        growth.append(pair.period())
        states.append(pair.y / pair.size)
    last = np.array(states)[-2 * LONGEST :]
    periods = [n for n in range(1, LONGEST) if np.abs(last[n:] - last[:-n]).max() < SAME]
    return min(periods, default=0), np.mean(growth)


def kind(period, exponent):
    """What a motion is called."""
    if period:
        return "repeats after 8 periods or fewer" if period <= 8 else "repeats after more than 8 periods"
    return "chaotic" if exponent > CHAOTIC else "no period found"


def main() -> None:
    """Print what each case does, and how many do so."""
    study = config.load(PAPER)
    without_period("bilateral", changed(study, {"solver": {"method": "event-driven"}}))
    cases = without_period("unilateral", changed(study, UNILATERAL))
    kinds: dict[str, int] = {}
    for i in range(len(cases)):
        period, exponent = followed(cases[i : i + 1])
        name = kind(period, exponent)
        kinds[name] = kinds.get(name, 0) + 1
        law, given = cases["friction"]["law"][i], cases["input"][i]
        print(f"law {law} omega {given['omega']:.4g} rad/s a {1e3 * given['amplitude']:.4g} mm: ", end="")
        print(f"{name}, period {period}, exponent {exponent:.4f}")
    for name, count in kinds.items():
        print(f"{count}: {name}")


if __name__ == "__main__":
    main()
