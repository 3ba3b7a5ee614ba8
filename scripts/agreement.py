"""The event-driven solver against Radau: 200 random cases from rest, 20 forcing periods, amplitude ratios.

Radau runs at rtol 1e-9 and 1e-10; where it moves by over 1e-7 between the two, it is no reference (a motion
that multiplies errors) and the case is listed. Everywhere else both must agree to 1e-6, and both must call
the same cases locked. Writes docs/agreement.txt; takes about 6 minutes on two cores.
"""

import sys
from collections import Counter
from math import pi
from pathlib import Path
from typing import NamedTuple

import joblib
import numpy as np

from wedgesweep import response
from wedgesweep.friction import LAW_NAMES
from wedgesweep.solvers import event_driven, radau
from wedgesweep.solvers.trajectory import CaseError, Window
from wedgesweep.systems.suspension import parameters

REPORT = Path(__file__).parent.parent / "docs" / "agreement.txt"
CASES, SEED = 200, 2024
SETTLE_PERIODS, KEPT_PERIODS = 18, 2
OMEGA_N = 85.3565
LIMIT, MOVED, MOST_MOVED = 1e-6, 1e-7, 0.02


class Result(NamedTuple):
    """A case in words, amplitude ratios of the event-driven solver and of Radau, statuses, lift-off fraction.

    Radau's ``coarse`` ratio is that at rtol 1e-9, ``fine`` at 1e-10; NaN without an answer.
    """

    case: str
    ours: float
    coarse: float
    fine: float
    statuses: tuple[str, str, str]
    lifted: float

    @property
    def apart(self):
        return abs(self.ours - self.fine)

    @property
    def moved(self):
        return abs(self.coarse - self.fine)

    @property
    def same_status(self):
        return len(set(self.statuses)) == 1

    @property
    def agrees(self):
        return self.same_status and not self.apart > LIMIT

    def __str__(self):
        return (
            f"{self.case}: apart {self.apart:.1e}, Radau moves {self.moved:.1e} ({', '.join(self.statuses)})"
        )


def random_case(number):
    """Case of a number: its parameters and a description."""
    generator = np.random.default_rng([SEED, number])
    law = LAW_NAMES[number % len(LAW_NAMES)]
    amplitude, beta = 10.0 ** generator.uniform(-5.0, -2.3), generator.uniform(0.15, 3.0)
    column_angle = float(generator.choice([-8.0, -4.0, 4.0, 8.0]))
    preload, guide = float(generator.choice([-1.0, 0.0, 0.0, 3.0])), float(generator.choice([0.0, 0.0, 0.3]))
    dynamic = generator.uniform(0.1, 0.35)
    static = dynamic * generator.uniform(1.0, 1.5)
    record = parameters.record(
        law,
        amplitude,
        beta * OMEGA_N,
        suspension={"column_angle": column_angle * pi / 180.0, "wedge_preload": preload},
        friction={"dynamic": dynamic, "static": static},
        effects={"guide_friction": {"force": guide}},
    )
    words = f"{law}, beta {beta:.4f}, {amplitude * 1e3:.4f} mm, column angle {column_angle:+g} deg"
    forces = f"preload {preload:g} N, guide {guide:g} N"
    return record, f"{number:3} {words}, {forces}, mu {dynamic:.3f}/{static:.3f}"


def ratio(solve, record, rtol):
    """Amplitude ratio, status and lift-off fraction; NaN where there is none."""
    window = Window(float(record["input"]["omega"][0]), SETTLE_PERIODS, KEPT_PERIODS, 64)
    try:
        numbers = response.evaluate(solve(record, window, rtol, 600.0), record, 1).numbers
    except CaseError as error:
        return np.nan, error.status, np.nan
    return numbers["amplitude_ratio"], "ok", numbers["lift_off_fraction"]


def compared(number):
    """Result of a case."""
    record, words = random_case(number)
    ours, here, lifted = ratio(event_driven.solve, record, 1e-10)
    coarse, at_coarse, _ = ratio(radau.solve, record, 1e-9)
    fine, at_fine, _ = ratio(radau.solve, record, 1e-10)
    return Result(words, ours, coarse, fine, (here, at_coarse, at_fine), lifted)


def report(results):
    """The text of docs/agreement.txt, and whether all is well."""
    answered = [each for each in results if each.statuses == ("ok", "ok", "ok")]
    moved = [each for each in results if each.moved > MOVED]
    apart = [each for each in results if not each.agrees and not each.moved > MOVED]
    settled = np.array([each.apart for each in answered if not each.moved > MOVED])
    fine = not apart and len(moved) <= MOST_MOVED * len(results)
    statuses = ", ".join(
        f"{count} {status}" for status, count in Counter(r.statuses[0] for r in results).items()
    )
    lines = [
        f"Event-driven (rtol 1e-10) against Radau (rtol 1e-10): {len(results)} random cases from rest;",
        f"amplitude ratios of the last {KEPT_PERIODS} of {SETTLE_PERIODS + KEPT_PERIODS} periods.",
        "",
        f"event-driven: {statuses}; moving: {sum(r.ours > 0.0 for r in answered)};",
        f"  with a negative normal force at some time: {sum(r.lifted > 0.0 for r in answered)}",
        f"Radau moves by over {MOVED:g} from rtol 1e-9 to 1e-10: {len(moved)} (at most "
        f"{MOST_MOVED * len(results):g} may)",
        *(f"  {each}" for each in moved),
        f"the others differ by {np.median(settled):.1e} (median), {np.quantile(settled, 0.95):.1e} (95 %), "
        f"{settled.max():.1e} (largest); limit {LIMIT:g}",
        f"disagreements: {len(apart)}",
        *(f"  {each}" for each in apart),
        f"verdict: {'agreement' if fine else 'NO agreement'}",
    ]
    return "\n".join(lines) + "\n", fine


def main():
    pool = joblib.Parallel(n_jobs=2, return_as="generator", batch_size=1)
    results = []
    for result in pool(joblib.delayed(compared)(number) for number in range(CASES)):
        results.append(result)
        if not result.agrees or result.moved > MOVED:
            print(result, file=sys.stderr, flush=True)
    text, fine = report(results)
    REPORT.write_text(text)
    print(text, end="")
    sys.exit(not fine)


if __name__ == "__main__":
    main()
