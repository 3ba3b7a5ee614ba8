"""Unilateral joints: their cost against bilateral ones, and against siconos where some lift off.

The cases are the paper's: those in which nothing lifts off, then all 1,800; and those with so much friction
that some states could lock, where neither kind of joints does and nothing lifts off. Both kinds of joints run
interleaved. Times are processor times. Siconos (Debian's python3-siconos) steps some cases with lift-off at
the longest of some steps that keeps amplitude ratios within a limit of those at a tolerance of 1e-9;
wedgesweep at the loosest tolerance that does. Where siconos is not installed, the output says that this is
skipped.
"""

from math import inf
from pathlib import Path
from time import process_time

import compare_siconos
import numpy as np
from reproduce.runs import changed

from wedgesweep import config
from wedgesweep.config import Case
from wedgesweep.friction import LAW_NAMES
from wedgesweep.simulate import Settings
from wedgesweep.sweep import variables
from wedgesweep.sweep.cases import solve_cases
from wedgesweep.systems.suspension import parameters

PAPER = Path(__file__).parents[1] / "configs" / "paper.toml"
OMEGA_N = 85.35650555
ROUNDS, REPEATED = 15, 40
# Of the closed cases those that Radau runs, and their periods.
EVERY, FEW_PERIODS = 40, 4
EFFECT = {"viscous_damping": {"coefficient_N_s_per_m": 8.0}}
ROUGH = {"friction": {"static": 0.46, "dynamic": 0.4}}
OPEN = [Case("coulomb", beta, a) for beta, a in ((0.75, 4.75e-3), (0.9, 1e-3), (1.2, 1e-3), (1.3, 2.2e-3))]
LIMIT = 5e-3
STEPS, LADDER = (250, 500, 1000, 2000, 4000), (1e-3, 1e-4, 1e-5, 1e-6)
DTYPE = variables.record_dtype({"phase": 0, "harmonic": variables.HARMONICS, "part": 2})


def records(cases, law, joints):
    """Parameter records of (beta, amplitude)."""
    made = [parameters.record(law, a, beta * OMEGA_N, {"joints": joints}) for beta, a in cases]
    return np.concatenate(made)


def timed(rows, settings):
    """Results of cases, and the processor time (s)."""
    began = process_time()
    found = solve_cases(rows, np.arange(len(rows)), settings, inf, DTYPE)
    return found, process_time() - began


def of_paper(**changes):
    """The paper's study with both kinds of joints, and other changes by section."""
    changes = {"solver": {"method": "event-driven"}} | changes
    return [
        changed(config.load(PAPER), changes | {"suspension": {"joints": each}}) for each in parameters.JOINTS
    ]


def stays_closed(rows):
    """In which cases no contact opens from rest to the end of the paper's 1.5 s."""
    closed, omega = np.zeros(len(rows), bool), rows["input"]["omega"]
    for one in np.unique(omega):
        periods = max(int(np.ceil(1.5 * one / (2.0 * np.pi))), 4)
        whole = Settings(method="event-driven", duration=None, settle_periods=0, kept_periods=periods)
        closed[omega == one] = timed(rows[omega == one], whole)[0]["lift_off_fraction"] == 0.0
    return closed


def compared(name, both, settings, rounds):
    """Print the speed of the second records over that of the first, and by how much their results differ."""
    results = [timed(rows, settings)[0] for rows in both]  # also compiles
    off = np.abs(results[1]["amplitude_ratio"] - results[0]["amplitude_ratio"]).max()
    times = np.array([[timed(rows, settings)[1] for rows in both] for _ in range(rounds)])
    print(f"{name:32} {len(both[0]):5} {np.median(times[:, 0] / times[:, 1]):8.3f} {off:8.0e}")


def closed_cases():
    """Print speeds where no contact opens."""
    both = of_paper()
    rows = [each.records() for each in both]
    still, laws = stays_closed(rows[1]), rows[0]["friction"]["law"]
    damped = [each.records() for each in of_paper(effects=EFFECT)]
    radau = Settings(method="radau", duration=None, settle_periods=FEW_PERIODS, kept_periods=2)
    print(f"{'Nothing lifts off':32} cases    speed  largest difference")
    for number, law in enumerate(LAW_NAMES):
        chosen = np.flatnonzero(still & (laws == number))
        compared(law, [each[chosen] for each in rows], both[0].solver, ROUNDS)
        few = chosen[::EVERY]
        compared(f"{law}, radau", [each[few] for each in rows], radau, 3)
        compared(f"{law}, an effect", [np.tile(each[few], 4) for each in damped], both[0].solver, ROUNDS)
    compared("all 1,800", rows, both[0].solver, 5)
    rows = [each.records() for each in of_paper(**ROUGH)]
    answered = [timed(each, both[0].solver)[0]["status"] == 0 for each in rows]
    could_lock = rows[1]["geometry"]["always_well_posed"] == 0
    chosen = np.flatnonzero(could_lock & stays_closed(rows[1]) & answered[0] & answered[1])
    for number, law in enumerate(LAW_NAMES):
        few = chosen[laws[chosen] == number]
        if few.size:
            compared(f"{law}, could lock", [each[few] for each in rows], both[0].solver, ROUNDS)


def ours(rows, exact):
    """Tolerance, error and processor time per case at the loosest tolerance that is accurate enough."""
    for rtol in LADDER:
        settings = Settings(method="event-driven", rtol=rtol, duration=None, settle_periods=40)
        many = np.tile(rows, REPEATED)
        found, seconds = timed(many, settings)
        error = np.abs(found["amplitude_ratio"][: len(rows)] / exact - 1.0).max()
        if error <= LIMIT:
            break
    seconds = min(seconds, *(timed(many, settings)[1] for _ in range(ROUNDS)))
    return rtol, error, seconds / len(many)


def theirs(exact):
    """The same of siconos, by its steps per period; its start is not counted."""
    for steps in STEPS:
        found, seconds = compare_siconos.siconos(OPEN, steps)
        error = np.abs(found[:, 0] / exact - 1.0).max()
        if error <= LIMIT:
            break
    return steps, error, seconds / len(OPEN)


def main():
    """Print both comparisons."""
    closed_cases()
    if not compare_siconos.is_there():
        print("siconos: skipped, as it is not installed (apt-get install python3-siconos)")
        return
    rows = records([(case.beta, case.amplitude) for case in OPEN], "coulomb", parameters.UNILATERAL)
    settings = Settings(method="event-driven", rtol=1e-9, duration=None, settle_periods=40)
    exact = timed(rows, settings)[0]["amplitude_ratio"]
    ours(rows, exact)
    rtol, error, own = ours(rows, exact)
    steps, its_error, its = theirs(exact)
    print(f"Lift-off, {len(OPEN)} cases of 42 periods, largest error of the amplitude ratio <= {LIMIT:g}")
    print(f"wedgesweep: rtol {rtol:.0e}, error {error:.0e}, {1e3 * own:.3g} ms a case")
    print(f"siconos: {steps} steps a period, error {its_error:.0e}, {1e3 * its:.3g} ms a case")
    print(f"siconos over wedgesweep: {its / own:.0f} times the time")


if __name__ == "__main__":
    main()
