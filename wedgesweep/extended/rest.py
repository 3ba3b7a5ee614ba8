"""What the extended system needs of a parameter record, and where it rests without friction."""

from math import nan, pi, sqrt

import numpy as np

from wedgesweep import damper
from wedgesweep.compiled import compiled
from wedgesweep.extended.mechanics import Loads, reactions

ITERATIONS = 100
REACHED = 1e-15  # m


def prepare(p) -> None:
    """Fill in the derived numbers of an extended record, in place.

    The rest position is NaN where the springs have none (a cubic stiffness far below zero).
    """
    p["column_slip_ratio"] = p["cos_wedge"] / p["sin_included"]
    p["bolster_slip_ratio"] = p["cos_column"] / p["sin_included"]
    p["lift_ratio"] = p["cos_column"] * p["cos_wedge"] / p["sin_included"]
    stiffness, mass = p["column_compliance_stiffness"], p["column_compliance_mass"]
    p["column_damping"] = 2.0 * p["column_compliance_damping_ratio"] * sqrt(stiffness * mass)
    natural = 2.0 * pi * p["fixture_resonance_frequency"]
    p["fixture_stiffness"] = p["side_frame_mass"] * natural**2
    p["fixture_damping"] = 2.0 * p["fixture_resonance_damping_ratio"] * p["side_frame_mass"] * natural
    if p["cubic_stiffness_coefficient"] != 0.0 or stiffness > 0.0:
        p["rest"], p["column_rest"] = _static_place(p)
    p["never_locks"] = damper.never_locks(_determinant, p)


@compiled
def _determinant(column_mu, bolster_mu, p):
    """As ``damper.determinant``, with the degrees of freedom of columns and side frame."""
    unloaded = Loads(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    return -reactions(unloaded, column_mu, bolster_mu, 0.0, 0.0, p)[1]


@compiled
def _response(wedge, vertical, outward, p):
    """Frictionless accelerations z'' and Q'' under forces on wedge (up), bolster and column (outward).

    At rest the side frame does not accelerate, whatever carries it: with a fixture its
    acceleration is part of what must vanish, and both statements have the same root.
    """
    load = Loads(wedge * p.cos_column, wedge * p.sin_column, vertical, outward, 0.0, 0.0)
    now, _ = reactions(load, 0.0, 0.0, 0.0, 0.0, p)
    return np.array([now.acceleration, now.column_acceleration])


@compiled
def _static_place(p):
    """Newton's method for z and Q of the frictionless equilibrium (m); NaN where none holds by itself."""
    lift = p.column_ratio * p.cos_column
    z, way = p.rest, 0.0
    for _ in range(ITERATIONS):
        wedge = p.wedge_preload - p.wedge_spring * (lift * z + p.lift_ratio * way)
        cubic = p.cubic_stiffness_coefficient
        vertical = -(p.bolster_spring + cubic * z * z) * z - p.bolster_mass * p.gravity
        residual = _response(
            wedge - p.wedge_mass * p.gravity, vertical, -p.column_compliance_stiffness * way, p
        )
        by_z = _response(-p.wedge_spring * lift, -p.bolster_spring - 3.0 * cubic * z * z, 0.0, p)
        if p.column_compliance_stiffness == 0.0:
            dz, dway, stable = -residual[0] / by_z[0], 0.0, by_z[0] < 0.0
        else:
            by_way = _response(-p.wedge_spring * p.lift_ratio, 0.0, -p.column_compliance_stiffness, p)
            determinant = by_z[0] * by_way[1] - by_way[0] * by_z[1]
            dz = -(residual[0] * by_way[1] - by_way[0] * residual[1]) / determinant
            dway = -(by_z[0] * residual[1] - residual[0] * by_z[1]) / determinant
            stable = by_z[0] < 0.0 and determinant > 0.0
        z, way = z + dz, way + dway
        if abs(dz) + abs(dway) <= REACHED:
            return (z, way) if stable else (nan, nan)
    return nan, nan
