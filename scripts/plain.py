"""The suspension as one would first type it from the paper: a Python right-hand side for solve_ivp's Radau.

One solve_ivp over the whole run, no Jacobian, Newton's equations solved for each combination of signs of
the normal forces until one is consistent; Coulomb as tanh(v / 0.02 mm/s).
"""

from itertools import product
from math import tanh

import numpy as np
from scipy.integrate import solve_ivp
from workload import SMOOTHING, numbers, sample_times, turning_point_ratio


def coefficient(law, velocity, p):
    """Signed coefficient of friction."""
    speed = abs(velocity) / p["v_t"]
    if law == "coulomb":
        return p["mu_d"] * tanh(velocity / SMOOTHING)
    if speed <= 1.0:
        return p["mu_s"] * velocity / p["v_t"]
    sliding = p["mu_d"] * np.sign(velocity)
    return sliding if law == "static-dynamic" else sliding * speed ** p["exponent"]


def rate(t, y, law, p):
    """Derivative of (z, z'): the three equations of motion, for the signs that turn out consistent."""
    z, velocity = y
    base = -p["amplitude"] * p["omega"] ** 2 * np.sin(p["omega"] * t)
    r, q = p["column_ratio"], p["bolster_ratio"]
    wedge = p["wedge_preload"] - p["wedge_spring"] * r * p["cos_column"] * z
    wedge -= p["wedge_mass"] * (p["gravity"] + base)
    bolster = -p["bolster_spring"] * z - p["bolster_mass"] * (p["gravity"] + base)
    column_mu = coefficient(law, r * velocity, p)
    bolster_mu = coefficient(law, q * velocity, p)
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


def ratio(record, law, rtol):
    """Amplitude ratio of one run from rest over 1.5 s."""
    p = numbers(record)
    times = sample_times(p["omega"])
    atol = rtol * 1e-2 * np.array([p["amplitude"], p["amplitude"] * p["omega"]])
    run = solve_ivp(
        rate,
        (0.0, times[-1]),
        [p["rest"], 0.0],
        "Radau",
        times,
        args=(law, p),
        rtol=rtol,
        atol=atol,
    )
    return turning_point_ratio(times, *run.y, p["amplitude"])
