"""Wear of the columns: the wedges rise until both faces close again, and their springs slacken."""

import numpy as np
import pytest

from tests.physics.cases import OMEGA_N, TABLE_1, fast
from wedgesweep.systems.suspension import parameters

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
