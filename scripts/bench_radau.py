"""Time this project's Radau against the plain thing that a user would write first.

Plain: a Python right-hand side, one solve_ivp over the paper's 1.5 s, no Jacobian; Coulomb as
tanh(v / 0.02 mm/s). Each runs at the loosest tolerance of a ladder that keeps the amplitude ratio of every
case of a law within 1e-3 of its own limit at rtol 1e-9; for the smoothed Coulomb that is the limit of
the smoothed law, and what smoothing changes against set-valued Coulomb is printed beside.
"""

from itertools import product
from math import pi, tanh
from time import perf_counter

import numpy as np
from scipy.integrate import solve_ivp

from wedgesweep import parameters
from wedgesweep.simulate import Settings, respond

OMEGA_N = (5100 / 0.70) ** 0.5
LIMIT = 1e-3
LADDER = (3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 1e-6)
LAWS = ("coulomb", "static-dynamic", "exponential")
CASES = [*product((0.4, 0.8), (0.6e-3, 1.5e-3)), *product((1.472, 2.208), (0.05e-3, 0.2e-3))]
PERIODS_KEPT = 3


def plain_coefficient(law, velocity, p):
    """Signed coefficient of friction as one would type it from the paper."""
    speed = abs(velocity) / p["threshold_velocity"]
    if law == "coulomb":
        return p["dynamic"] * tanh(velocity / 0.02e-3)
    if speed <= 1.0:
        return p["static"] * velocity / p["threshold_velocity"]
    sliding = p["dynamic"] * np.sign(velocity)
    return sliding if law == "static-dynamic" else sliding * speed ** p["velocity_exponent"]


def plain_rate(t, y, law, p):
    """Derivative of (z, z'): the three equations of motion, for the signs that turn out consistent."""
    z, velocity = y
    base = -p["amplitude"] * p["omega"] ** 2 * np.sin(p["omega"] * t)
    r, q = p["column_ratio"], p["bolster_ratio"]
    wedge = p["wedge_preload"] - p["wedge_spring"] * r * p["cos_column"] * z
    wedge -= p["wedge_mass"] * (p["gravity"] + base)
    bolster = -p["bolster_spring"] * z - p["bolster_mass"] * (p["gravity"] + base)
    column_mu = plain_coefficient(law, r * velocity, p)
    bolster_mu = plain_coefficient(law, q * velocity, p)
    sin_g, cos_g, sin_i, cos_i = (
        p[name] for name in ("sin_column", "cos_column", "sin_included", "cos_included")
    )
    sin_a, cos_a = p["sin_wedge"], p["cos_wedge"]
    for column_sign, bolster_sign in product((1, -1), (1, -1)):
        mc, mb = column_sign * column_mu, bolster_sign * bolster_mu
        matrix = [
            [p["wedge_mass"] * r, mc, sin_i + mb * cos_i],
            [0.0, 1.0, mb * sin_i - cos_i],
            [p["bolster_mass"], 0.0, -2.0 * (sin_a + mb * cos_a)],
        ]
        acceleration, n_column, n_bolster = np.linalg.solve(matrix, [wedge * cos_g, wedge * sin_g, bolster])
        if column_sign * n_column >= 0.0 and bolster_sign * n_bolster >= 0.0:
            break
    return [velocity, acceleration]


def plain_ratio(record, law, rtol):
    """Amplitude ratio of one plain run from rest over 1.5 s."""
    p = {name: float(record[name][0]) for name in record.dtype.names}
    period = 2.0 * pi / p["omega"]
    end = Settings(kept_periods=PERIODS_KEPT).window(p["omega"]).end  # 1.5 s in whole periods
    times = end - period * np.linspace(PERIODS_KEPT, 0.0, PERIODS_KEPT * 256)
    atol = rtol * 1e-2 * np.array([p["amplitude"], p["amplitude"] * p["omega"]])
    run = solve_ivp(
        plain_rate,
        (0.0, end),
        [p["rest"], 0.0],
        "Radau",
        times,
        args=(law, p),
        rtol=rtol,
        atol=atol,
    )
    return np.ptp(run.y[0]) / 2.0 / p["amplitude"]


def our_ratio(record, law, rtol):
    """Amplitude ratio of the same case by wedgesweep."""
    settings = Settings(rtol=rtol, kept_periods=PERIODS_KEPT)
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
        records = [parameters.record(law, a, beta * OMEGA_N) for beta, a in CASES]
        our_ratio(records[0], law, 1e-3)
        exact, _ = timed(our_ratio, records, law, 1e-9)
        plain_exact = timed(plain_ratio, records, law, 1e-9)[0] if law == "coulomb" else exact
        plain = loosest(plain_ratio, records, law, plain_exact)
        ours = loosest(our_ratio, records, law, exact)
        gains.extend(plain[2] / ours[2])
        print(
            f"{law:15} {plain[0]:9.0e} {plain[1]:8.1e} {plain[2].mean():7.3f}"
            f" {ours[0]:11.0e} {ours[1]:8.1e} {ours[2].mean():7.3f}"
            f" {np.exp(np.log(plain[2] / ours[2]).mean()):7.2f}"
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
