"""Rest of a wedge: the band of base accelerations that Coulomb's law admits."""

import numpy as np
import pytest
from scipy.optimize import linprog

from tests.physics.cases import OMEGA_N, fast
from wedgesweep.systems.suspension import parameters
from wedgesweep.systems.suspension.rest import breakaway_inputs, rest_interval

LEANS = [(4.0, (-0.736869, 1.451031)), (-4.0, (-0.947180, 4.678984))]


def machine(column_angle, mu=0.29, **suspension):
    suspension |= {"column_angle": np.radians(column_angle)}
    return parameters.record("coulomb", 1e-3, 50.0, suspension=suspension, friction={"mu_d": mu})


def random_machine(draw):
    """Parameters of any size; some of them jam."""
    return parameters.record(
        "coulomb",
        1e-3,
        50.0,
        suspension={
            "bolster_mass": draw.uniform(0.1, 5.0),
            "wedge_mass": draw.uniform(0.0, 1.0),
            "wedge_spring": draw.uniform(0.0, 1e4),
            "wedge_angle": np.radians(draw.uniform(20.0, 70.0)),
            "column_angle": np.radians(draw.uniform(-15.0, 15.0)),
            "wedge_preload": draw.uniform(-2.0, 20.0),
            "damping": draw.choice(parameters.DAMPING),
        },
        friction={"mu_d": draw.uniform(0.02, 0.8)},
        effects={"guide_friction": {"force": draw.choice([0.0, 0.5])}},
    )


def by_programme(row, mu):
    """Ends of the interval by scipy, from the balance of the bodies as vectors."""
    s, g = row["suspension"], row["geometry"]
    t_c, n_c = (-g["sin_column"], g["cos_column"]), (g["cos_column"], g["sin_column"])
    t_b, p_b = (g["sin_wedge"], g["cos_wedge"]), (g["cos_wedge"], -g["sin_wedge"])
    shortening = (g["column_ratio"] * g["cos_column"] - g["spring_on_bolster"]) * g["rest"]
    spring = s["wedge_preload"] - s["wedge_spring"] * shortening
    wedge = spring - s["wedge_mass"] * s["gravity"]
    bolster = -s["bolster_spring"] * g["rest"] - s["bolster_mass"] * s["gravity"]
    bolster -= 2.0 * g["spring_on_bolster"] * spring
    # Unknown: N_c, T_c, N_b, T_b, guide, u''
    across = [n_c[0], t_c[0], -p_b[0], t_b[0], 0.0, 0.0]
    upward = [n_c[1], t_c[1], -p_b[1], t_b[1], 0.0, s["wedge_mass"]]
    of_bolster = [0.0, 0.0, 2.0 * p_b[1], -2.0 * t_b[1], -1.0, s["bolster_mass"]]
    cones = [[-mu, side, 0.0, 0.0, 0.0, 0.0] for side in (1.0, -1.0)]
    cones += [[0.0, 0.0, -mu, side, 0.0, 0.0] for side in (1.0, -1.0)]
    force = row["guide_friction"]["force"]
    bounds = [(0, None), (None, None), (0, None), (None, None), (-force, force), (None, None)]
    ends = []
    for sign in (1.0, -1.0):
        result = linprog(
            [0.0] * 5 + [sign],
            A_ub=cones,
            b_ub=np.zeros(4),
            A_eq=[across, upward, of_bolster],
            b_eq=[0.0, wedge, bolster],
            bounds=bounds,
        )
        ends.append(
            {0: result.x[5] if result.x is not None else np.nan, 3: -sign * np.inf}.get(result.status, np.nan)
        )
    return ends


@pytest.mark.parametrize(("column_angle", "interval"), LEANS)
def test_reference_machines(column_angle, interval):
    assert np.ravel(rest_interval(machine(column_angle), 0.29)) == pytest.approx(interval, abs=1e-6)
    # The least sticking is within the band, and without friction there is none.
    up, down = np.ravel(breakaway_inputs(machine(column_angle), 0.29))
    assert interval[0] - 1e-6 < up < 0.0 < down < interval[1] + 1e-6
    assert np.ravel(rest_interval(machine(column_angle), 0.0)) == pytest.approx([0.0, 0.0], abs=1e-12)


def test_interval_is_that_of_a_linear_programme():
    count, draw = 200, np.random.default_rng(200)
    rows = np.concatenate([random_machine(draw) for _ in range(count)])
    rows = rows[np.isfinite(rows["geometry"]["rest"])]
    mu = rows["friction"]["mu_d"]
    intervals = np.array(rest_interval(rows, mu)).T
    expected = np.array([by_programme(row, friction) for row, friction in zip(rows, mu, strict=True)])
    assert len(rows) > 0.9 * count
    assert np.isinf(expected).any()
    assert intervals == pytest.approx(expected, rel=1e-9, abs=1e-9, nan_ok=True)


@pytest.mark.parametrize("locked_in", [0.0, 0.5, 1.0])
@pytest.mark.parametrize(("column_angle", "interval"), LEANS)
def test_motion_begins_where_locked_in_forces_end(column_angle, interval, locked_in):
    """Between the least sticking of Coulomb's law and the end of the band."""
    least = np.ravel(breakaway_inputs(machine(column_angle), 0.29))
    limit = min(abs(low + locked_in * (high - low)) for low, high in zip(least, interval, strict=True))
    for share, sticks in ((0.999, True), (1.001, False)):
        record = parameters.record(
            "coulomb",
            share * limit / OMEGA_N**2,
            OMEGA_N,
            suspension={"column_angle": np.radians(column_angle)},
            effects={"jamming": {"locked_in": locked_in}},
        )
        # Once moved it may come to rest elsewhere, where it is held.
        assert (fast(record).numbers["mean_displacement"] == 0.0) == sticks
