"""Time this project's Radau against the plain thing that a user would write first.

Plain: a Python right-hand side, one solve_ivp over the paper's 1.5 s, no Jacobian; Coulomb as
tanh(v / 0.02 mm/s). Each runs at the loosest tolerance of a ladder that keeps the amplitude ratio of every
case of a law within 1e-3 of its own limit at rtol 1e-9; for the smoothed Coulomb that is the limit of
the smoothed law, and what smoothing changes against set-valued Coulomb is printed beside.
"""

from itertools import product
from time import perf_counter

import numpy as np
import plain
import workload

from wedgesweep.simulate import Settings, respond

LIMIT = 1e-3
LADDER = (3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 1e-6)
LAWS = ("coulomb", "static-dynamic", "exponential")
CASES = [*product((0.4, 0.8), (0.6e-3, 1.5e-3)), *product((1.472, 2.208), (0.05e-3, 0.2e-3))]


def our_ratio(record, law, rtol):
    """Amplitude ratio of the same case by wedgesweep."""
    settings = Settings(rtol=rtol, kept_periods=workload.PERIODS_KEPT)
    return respond(record, settings, harmonics=1)[0].numbers["amplitude_ratio"]


def timed(ratio, records, law, rtol):
    """Ratios of all cases, and the seconds that each took."""
    ratios, seconds = [], []
    for record in records:
        started = perf_counter()
        ratios.append(ratio(record, law, rtol))
        seconds.append(perf_counter() - started)
    return np.array(ratios), np.array(seconds)


def loosest(ratio, records, law, exact):
    """The first tolerance of the ladder that is accurate enough; its largest error and times."""
    for rtol in LADDER:
        ratios, seconds = timed(ratio, records, law, rtol)
        error = np.abs(ratios / exact - 1.0).max()
        if error <= LIMIT:
            break
    return rtol, error, seconds


def main():
    print(f"{len(CASES)} cases a law, 1.5 s from rest; error: largest of the amplitude ratio")
    print("law             plain rtol  error   s/case   ours rtol   error   s/case   ratio")
    gains = []
    for law in LAWS:
        records = workload.records(law, CASES)
        our_ratio(records[0], law, 1e-3)
        exact, _ = timed(our_ratio, records, law, 1e-9)
        plain_exact = timed(plain.ratio, records, law, 1e-9)[0] if law == "coulomb" else exact
        typed = loosest(plain.ratio, records, law, plain_exact)
        ours = loosest(our_ratio, records, law, exact)
        gains.extend(typed[2] / ours[2])
        print(
            f"{law:15} {typed[0]:9.0e} {typed[1]:8.1e} {typed[2].mean():7.3f}"
            f" {ours[0]:11.0e} {ours[1]:8.1e} {ours[2].mean():7.3f}"
            f" {np.exp(np.log(typed[2] / ours[2]).mean()):7.2f}"
        )
        if law == "coulomb":
            shift = np.abs(plain_exact / exact - 1.0)
            print(
                f"{'':15} smoothing changes the ratio by {np.median(shift):.1e} (median),"
                f" {shift.max():.1e} (largest)"
            )
    print(f"geometric mean of plain / ours over all cases: {np.exp(np.mean(np.log(gains))):.2f}")


if __name__ == "__main__":
    main()
