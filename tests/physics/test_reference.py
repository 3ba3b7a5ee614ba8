"""Agreement with an independent code, numbers of PHYSICS.md, and wear of the columns."""

import json
from pathlib import Path

import numpy as np
import pytest

from tests.physics.cases import OMEGA_N, TABLE_1, fast, steady
from wedgesweep.systems.suspension import equilibrium, parameters
from wedgesweep.systems.suspension.rest import breakaway_accelerations

ROWS = json.loads((Path(__file__).parents[1] / "data" / "steady.json").read_text())


def of_row(row):
    return parameters.record(row["friction_law"], row["amplitude_mm"] * 1e-3, row["beta"] * OMEGA_N)


def each(rows):
    return pytest.mark.parametrize(
        "row", rows, ids=lambda row: f"{row['friction_law']}-{row['beta']}-{row['amplitude_mm']}"
    )


@each(ROWS)
def test_steady_response(row):
    numbers = fast(of_row(row)).numbers
    assert numbers["amplitude_ratio"] == pytest.approx(row["amplitude_ratio"], abs=3e-6)
    assert numbers["stick_fraction"] == pytest.approx(row["stick_fraction"], abs=3e-4)


@pytest.mark.acceptance
@each(ROWS[::3])
def test_steady_response_by_radau(row):
    numbers = steady(of_row(row), settle_periods=row["settle_periods"])
    assert numbers["amplitude_ratio"] == pytest.approx(row["amplitude_ratio"], rel=1e-4)
    assert numbers["stick_fraction"] == pytest.approx(row["stick_fraction"], abs=0.005)
    assert numbers["peak_velocity"] * 1e3 == pytest.approx(row["peak_velocity_mm_per_s"], rel=1e-3)
    assert numbers["minimum_normal_force"] == pytest.approx(row["minimum_normal_force_N"], abs=1e-3)


@pytest.mark.parametrize(
    ("column_angle", "rest", "resonance"),
    [
        (0.06981317007977318, -1.0572017166e-3, 97.50648228),
        (-0.06981317007977318, -0.9342939466e-3, 100.61714194),
    ],
)
def test_rest_position_and_resonance(column_angle, rest, resonance):
    record = parameters.record("coulomb", 1e-3, 1.0, suspension={"column_angle": column_angle})
    assert record["geometry"]["rest"][0] == pytest.approx(rest, rel=1e-9)
    assert equilibrium.resonance(record[0]) == pytest.approx(resonance, rel=1e-9)


def test_linkage_ratios():
    record = parameters.record("coulomb", 1e-3, 1.0)
    assert record["geometry"]["column_ratio"][0] == pytest.approx(0.9187186996, rel=1e-9)
    assert record["geometry"]["bolster_ratio"][0] == pytest.approx(-0.1052737144, rel=1e-9)


@pytest.mark.parametrize(
    ("law", "beta", "amplitude_mm", "ratio"),
    [
        ("coulomb", 1.472, 0.05, 0.368),
        ("static-dynamic", 1.472, 0.05, 1.032),
        ("exponential", 1.472, 0.05, 1.373),
        ("static-dynamic", 1.75, 0.03, 0.444),
        ("coulomb", 1.75, 0.03, 0.055),
    ],
)
def test_laws_part_near_breakaway(law, beta, amplitude_mm, ratio):
    record = parameters.record(law, amplitude_mm * 1e-3, beta * OMEGA_N)
    assert fast(record).numbers["amplitude_ratio"] == pytest.approx(ratio, abs=1e-3)


@pytest.mark.parametrize("guide", [0.0, 0.3])
@pytest.mark.parametrize("excess", [-1e-6, 1e-3])
def test_motion_begins_at_the_breakaway_acceleration(excess, guide):
    omega, effects = 1.5 * OMEGA_N, {"guide_friction": {"force": guide}}
    limit = breakaway_accelerations(parameters.record("coulomb", 1e-3, omega, effects=effects))[0][0]
    record = parameters.record("coulomb", (1.0 + excess) * limit / omega**2, omega, effects=effects)
    numbers = steady(record, settle_periods=3)
    assert (numbers["stick_fraction"] < 1.0) == (excess > 0)
    assert (numbers["amplitude_ratio"] > 0.0) == (excess > 0)


def test_the_unit_of_velocity_is_a_factor_of_sliding_friction():
    """mu_d (v/unit)^-0.1: ten times the unit is 10^0.1 times mu_d, whatever the threshold."""
    for threshold in (1e-3, 3e-3):
        own = {"threshold_velocity": threshold, "static": 0.4}
        unit = parameters.record("exponential", 1e-3, 1.2 * OMEGA_N, friction={**own, "velocity_unit": 1e-2})
        more = {**own, "dynamic": 0.29 * 10.0**0.1}
        level = parameters.record("exponential", 1e-3, 1.2 * OMEGA_N, friction=more)
        assert fast(unit).numbers["peak_to_peak"] == pytest.approx(
            fast(level).numbers["peak_to_peak"], rel=1e-9
        )


ALPHA, GAMMA, WEAR = TABLE_1["wedge_angle"], TABLE_1["column_angle"], 0.4e-3


def record(suspension, effects=None):
    return parameters.record("coulomb", 1e-3, 0.6 * OMEGA_N, suspension, effects=effects or {})


@pytest.mark.parametrize("gamma", [GAMMA, 0.0, -GAMMA])
@pytest.mark.parametrize("z", [0.0, -1e-3])
def test_a_worn_wedge_closes_both_faces_higher_up(gamma, z):
    """Both contacts closed, w . n_c = wear and (w - z e_z) . p_b = 0, as two linear equations for w."""
    into_column, into_wedge = (np.cos(gamma), np.sin(gamma)), (np.cos(ALPHA), -np.sin(ALPHA))
    w = np.linalg.solve([into_column, into_wedge], [WEAR, z * into_wedge[1]])
    scale = 1.3
    suspension = {"column_angle": gamma, "wear": WEAR, "wedge_preload": 5.0}
    p = record(suspension, {"wedge_stiffness": {"scale": scale}, "preload": {"force": 2.0}})[0]
    s, g = p["suspension"], p["geometry"]
    force = s["wedge_preload"] - s["wedge_spring"] * g["column_ratio"] * g["cos_column"] * z
    assert force == pytest.approx(7.0 - scale * TABLE_1["wedge_spring"] * w[1], rel=1e-12)


def test_wear_lowers_the_bolster_and_its_damping():
    new, worn = (record({"wedge_preload": 3.0, "wear": wear}) for wear in (0.0, WEAR))
    assert worn[0]["geometry"]["rest"] < new[0]["geometry"]["rest"]
    slack = record({"wedge_preload": float(worn[0]["suspension"]["wedge_preload"])})
    assert fast(slack).numbers == fast(worn).numbers
    assert fast(worn).numbers["amplitude_ratio"] > fast(new).numbers["amplitude_ratio"]
