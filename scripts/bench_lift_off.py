"""Unilateral joints: their cost against bilateral ones where none opens, and against siconos where some do.

Where nothing lifts off both kinds of joints run interleaved on the same cases. Times are processor times.
Siconos (Debian's python3-siconos) steps the same cases at the longest of some steps that keeps amplitude
ratios within a limit of those at a tolerance of 1e-9; wedgesweep at the loosest tolerance that does.
Skipped, and told, where siconos is not installed.
"""

from math import inf
from time import process_time

import compare_siconos
import numpy as np

from wedgesweep.config import Case
from wedgesweep.simulate import Settings
from wedgesweep.sweep import variables
from wedgesweep.sweep.cases import solve_cases
from wedgesweep.systems.suspension import parameters

OMEGA_N = 85.35650555
# Closed throughout: frequency ratios and amplitudes (m).
CLOSED = [(beta, a) for beta in (0.4, 1.472, 1.75, 2.208) for a in (2e-5, 5e-5, 1e-4)]
ROUNDS, REPEATED = 15, 40
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


def closed(law):
    """Speed of unilateral joints over that of bilateral ones where no contact opens."""
    settings = Settings(method="event-driven", duration=None, settle_periods=30, kept_periods=2)
    both = [np.tile(records(CLOSED, law, joints), REPEATED) for joints in parameters.JOINTS]
    results = [timed(rows, settings)[0] for rows in both]  # also compiles
    assert not results[1]["lift_off_fraction"].any()
    off = np.abs(results[1]["amplitude_ratio"] - results[0]["amplitude_ratio"]).max()
    times = np.array([[timed(rows, settings)[1] for rows in both] for _ in range(ROUNDS)])
    print(f"{law:15} {np.median(times[:, 0] / times[:, 1]):6.3f}  {off:.0e}")


def ours(rows, exact):
    """Tolerance, error and processor time per case at the loosest tolerance that is accurate enough."""
    for rtol in LADDER:
        settings = Settings(method="event-driven", rtol=rtol, duration=None, settle_periods=40)
        many = np.tile(rows, REPEATED)
        found, seconds = timed(many, settings)
        error = np.abs(found["amplitude_ratio"][: len(rows)] / exact - 1.0).max()
        if error <= LIMIT:
            break
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
    print("Nothing lifts off: speed of unilateral over bilateral joints (interleaved), largest difference")
    for law in ("coulomb", "static-dynamic", "exponential"):
        closed(law)
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
