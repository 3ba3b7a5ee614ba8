"""The event-driven solver against Radau on random cases: 200 sines from rest, 100 inputs that do not repeat.

Compared are amplitude ratios after 20 periods, and all samples of a displacement over its largest. Radau runs
at rtol 1e-9 and 1e-10; where it moves by over 1e-7 between the two, it is no reference (a motion that
multiplies errors) and the case is listed. Everywhere else both must agree to 1e-6, and both must call the
same cases locked. Writes docs/agreement.txt; takes about 8 minutes on two cores.
"""

import sys
from collections import Counter
from dataclasses import replace
from math import pi
from pathlib import Path
from typing import NamedTuple

import joblib
import numpy as np

from wedgesweep import config, response, simulate
from wedgesweep.friction import LAW_NAMES
from wedgesweep.solvers import event_driven, radau
from wedgesweep.solvers.trajectory import CaseError, Window
from wedgesweep.systems.suspension import parameters

REPORT = Path(__file__).parent.parent / "docs" / "agreement.txt"
SEED = 2024
SETTLE_PERIODS, KEPT_PERIODS = 18, 2
OMEGA_N, NATURAL_HZ = 85.3565, 13.585
TIMEOUT = 600.0  # s
LIMIT, MOVED, MOST_MOVED = 1e-6, 1e-7, 0.02
EFFECTS = (
    {},
    {"cubic_stiffness": {"coefficient_N_per_mm3": 0.02}},
    {"viscous_damping": {"coefficient_N_s_per_m": 8.0}},
    {"presliding": {"length_mm": 0.05}},
    {"directional_friction": {"asymmetry": 0.3}},
    {"end_stop": {"clearance_mm": 3.0, "stiffness_N_per_mm": 8.0}},
)
KINDS = ("sine-sweep", "random", "release")


class Result(NamedTuple):
    """A case in words; how far the solvers are apart, and how far Radau moves between its tolerances.

    NaN without an answer. ``statuses``: event-driven, Radau at 1e-9 and at 1e-10.
    """

    case: str
    apart: float
    moved: float
    statuses: tuple[str, str, str]

    @property
    def agrees(self):
        return len(set(self.statuses)) == 1 and not self.apart > LIMIT

    def __str__(self):
        return (
            f"{self.case}: apart {self.apart:.1e}, Radau moves {self.moved:.1e} ({', '.join(self.statuses)})"
        )


def sine(number):
    """A case under a sine: its words, and a function (method, rtol) that gives its amplitude ratio."""
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
    window = Window(beta * OMEGA_N, SETTLE_PERIODS, KEPT_PERIODS, 64)

    def solve(method, rtol):
        solver = {"event-driven": event_driven.solve, "radau": radau.solve}[method]
        found = response.evaluate(solver(record, window, rtol, TIMEOUT), record, 1)
        return np.array([found.numbers["amplitude_ratio"]])

    words = f"{law}, beta {beta:.4f}, {amplitude * 1e3:.4f} mm, column angle {column_angle:+g} deg"
    forces = f"preload {preload:g} N, guide {guide:g} N"
    return f"{number:3} {words}, {forces}, mu {dynamic:.3f}/{static:.3f}", solve


def transient(number):
    """As ``sine``, under an input that does not repeat; the function gives samples over their largest."""
    given = config.from_document(document(number))
    case = given.records()

    def solve(method, rtol):
        settings = replace(given.solver, method=method, rtol=rtol, case_timeout=TIMEOUT)
        x = simulate.transient(case, settings.transient, 1.0, settings).samples.x
        return x / np.abs(x).max()

    law, kind = given.document["sweep"]["friction_law"][0], given.document["input"]["kind"]
    return ", ".join((f"{number:3} {given.system}", law, kind, *given.document["effects"])), solve


def document(number):
    """Config of a transient: an oscillator or a suspension, any law, kind of input and effect."""
    generator = np.random.default_rng(number)
    wedge, kind = number % 4 == 0, KINDS[generator.integers(len(KINDS))]
    natural = NATURAL_HZ if wedge else float(generator.uniform(2.0, 12.0))
    mass = float(generator.uniform(0.5, 4.0))
    own = {
        "mass_kg": mass,
        "spring_N_per_mm": mass * (2.0 * pi * natural) ** 2 / 1e3,
        "damping_N_s_per_m": float(generator.uniform(0.0, 4.0)),
        "normal_force_N": mass * float(generator.uniform(1.0, 8.0)),
        "contact": ("base", "ground")[generator.integers(2)],
    }
    effects = EFFECTS[generator.integers(len(EFFECTS))] if generator.random() < 0.6 else {}
    return {
        **({} if wedge else {"oscillator": own}),
        "effects": effects,
        "friction": {"static": 0.32, "dynamic": float(generator.uniform(0.1, 0.32))},
        "input": _input(kind, natural, generator, wedge),
        "sweep": {"friction_law": ("coulomb", "static-dynamic", "exponential")[generator.integers(3)]},
    }


def _input(kind, natural, generator, wedge):
    """A table [input] of about six natural periods."""
    duration = 6.0 / natural
    if kind == "release":
        return {"kind": kind, "displacement_mm": float(generator.uniform(1.0, 8.0)), "duration_s": duration}
    size = "m_per_s2" if wedge or generator.random() < 0.7 else "N"
    level = float(generator.uniform(2.0, 8.0))
    band = {"start_hz": 0.3 * natural, "stop_hz": 2.0 * natural, "duration_s": duration}
    if kind == "sine-sweep":
        return {"kind": kind, f"amplitude_{size}": level, **band}
    return {"kind": "random", f"rms_{size}": level, "seed": int(generator.integers(1000)), **band}


# Families of cases, and how many of each are run.
FAMILIES = {sine: 200, transient: 100}


def compared(family, number):
    """Result of a case."""
    words, solve = family(number)
    runs = (("event-driven", 1e-10), ("radau", 1e-9), ("radau", 1e-10))
    (ours, coarse, fine), statuses = zip(*(_attempted(solve, *each) for each in runs), strict=True)
    return Result(words, np.abs(ours - fine).max(), np.abs(coarse - fine).max(), statuses)


def _attempted(solve, method, rtol):
    """What ``solve`` gives, and the status; NaN where there is no answer."""
    try:
        return solve(method, rtol), "ok"
    except CaseError as error:
        return np.array([np.nan]), error.status


def report(name, results):
    """Lines on the cases of a family, and whether all is well."""
    moved = [each for each in results if each.moved > MOVED]
    held = [each for each in results if not each.moved > MOVED]
    apart = [each for each in held if not each.agrees]
    answered = np.array([each.apart for each in held if {*each.statuses} == {"ok"}])
    fine = not apart and len(moved) <= MOST_MOVED * len(results)
    statuses = ", ".join(f"{count} {each}" for each, count in Counter(r.statuses[0] for r in results).items())
    lines = [
        f"{len(results)} cases of {name}, event-driven: {statuses}",
        f"Radau moves by over {MOVED:g}: {len(moved)} (at most {MOST_MOVED * len(results):g} may)",
        *(f"  {each}" for each in moved),
        f"the others differ by {np.median(answered):.1e} (median), {np.quantile(answered, 0.95):.1e} (95 %), "
        f"{answered.max():.1e} (largest); limit {LIMIT:g}",
        f"disagreements: {len(apart)}",
        *(f"  {each}" for each in apart),
        f"verdict: {'agreement' if fine else 'NO agreement'}",
    ]
    return "\n".join(lines) + "\n", fine


def main():
    pool = joblib.Parallel(n_jobs=2, batch_size=1)
    text, well = f"{__doc__}\n", True
    for family, count in FAMILIES.items():
        results = pool(joblib.delayed(compared)(family, number) for number in range(count))
        told, fine = report(family.__name__, results)
        print(told, flush=True)
        text, well = f"{text}{told}\n", well and fine
    REPORT.write_text(text)
    sys.exit(not well)


if __name__ == "__main__":
    main()
