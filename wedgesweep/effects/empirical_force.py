"""A force of displacement and velocity that was measured, not derived: a table, interpolated by cubics.

A diagnosis fits it where no effect with a name explains the tests. Its nodes are even in displacement, Z
(``displacement``) to either side of a ``centre``, and closer together at low velocities: even in w with
w = (1 + GRADING) t / (|t| + GRADING), t = v/V (``velocity``). Between nodes it is a product of Catmull and
Rom's cubics (1974), beyond them constant. The step at v = 0 is none of it: that is dry friction, of the faces
or of the guide.
Neutral: velocity = 0. Default: none, the ranges and the forces at the nodes must be given.
"""

from collections.abc import Mapping
from math import nan
from typing import Any

import numpy as np

from wedgesweep.compiled import by_record, function_of, inlined, inner
from wedgesweep.effects.base import NUMERICAL, Effect
from wedgesweep.equations.symbols import Meaning
from wedgesweep.quantity import Quantity

NAME = "empirical_force"
# Number of nodes over displacement and over velocity.
PLACES, SPEEDS = 7, 13
# Nodes are 4 times as close together at rest as at the largest velocity. With more grading a linear damper,
# which any other force may come with, would be off by more than 2 % between the last nodes.
GRADING = 1.0
# Key of the forces (N) at the nodes, a row for each displacement, and what they are in a record.
TABLE, FORCES = "forces_N", "forces"

EQUATIONS = ("R = f (z_r, v_z)",)
SYMBOLS = {"f": Meaning("the tabulated force", "N")}
EFFECT = Effect(
    name=NAME,
    family="missing-force",
    branch=NUMERICAL,
    meaning="a tabulated force of displacement and velocity on the {mass}",
    quantities=(
        Quantity("displacement_mm", nan, "from the centre to the outermost nodes", above=0.0, off=1.0),
        Quantity("velocity_mm_per_s", nan, "velocity of the outermost nodes", minimum=0.0, off=0.0),
        Quantity("centre_mm", 0.0, "displacement of the node in the middle"),
    ),
    extends=("velocity",),
)
# Numbers of a record that are no quantities.
FIELDS = [(FORCES, np.float64, (PLACES * SPEEDS,))]


def table(given: Mapping[str, Any]) -> dict[str, Any]:
    """The forces (SI) of a table of a config."""
    return {FORCES: tuple(given[TABLE])}


def nodes(displacement: float, velocity: float, centre: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Displacements (PLACES,) and velocities (SPEEDS,) of the nodes, in the units of the ranges."""
    even = np.linspace(-1.0, 1.0, SPEEDS)
    graded = GRADING * even / (1.0 + GRADING - np.abs(even))
    return centre + displacement * np.linspace(-1.0, 1.0, PLACES), velocity * graded


def _elongation(z, y, p): ...


# What displacement counts from: a suspension's rest position, or where an oscillator's spring is relaxed.
by_record(_elongation, lambda fields: function_of(["z", "y", "p"], "z" if "oscillator" in fields else "y[0]"))


def cubic(place: float, count: int) -> tuple[int, tuple[float, float, float, float]]:
    """First of the four nodes around a place from -1 to 1, and their weights; ``count``: number of nodes."""
    s = (min(max(place, -1.0), 1.0) + 1.0) * 0.5 * (count - 1)
    first = min(int(s), count - 2)
    s -= first
    before = 0.5 * s * (s * (2.0 - s) - 1.0)
    here = 0.5 * (s * s * (3.0 * s - 5.0) + 2.0)
    there = 0.5 * s * (s * (4.0 - 3.0 * s) + 1.0)
    after = 0.5 * s * s * (s - 1.0)
    # Beyond the ends the force goes on as a line.
    if first == 0:
        here, there, before = here + 2.0 * before, there - before, 0.0
    if first == count - 2:
        there, here, after = there + 2.0 * after, here - after, 0.0
    return first, (before, here, there, after)


_cubic = inlined(cubic)


def interpolation(places: np.ndarray, speeds: np.ndarray) -> np.ndarray:
    """Weights (n, PLACES SPEEDS) of the nodes at places and speeds (n,), in units of the ranges."""
    found = np.zeros((len(places), PLACES, SPEEDS))
    graded = (1.0 + GRADING) * speeds / (np.abs(speeds) + GRADING)
    for own, place, speed in zip(found, places.tolist(), graded.tolist(), strict=True):
        (row, over_place), (column, over_speed) = cubic(place, PLACES), cubic(speed, SPEEDS)
        rows = np.clip(np.arange(row - 1, row + 3), 0, PLACES - 1)
        columns = np.clip(np.arange(column - 1, column + 3), 0, SPEEDS - 1)
        np.add.at(own, np.ix_(rows, columns), np.outer(over_place, over_speed))
    return found.reshape(len(places), -1)


@inner
def _force(z, velocity, p):
    t = velocity / p.empirical_force.velocity
    graded = (1.0 + GRADING) * t / (abs(t) + GRADING)
    row, over_place = _cubic((z - p.empirical_force.centre) / p.empirical_force.displacement, PLACES)
    column, over_speed = _cubic(graded, SPEEDS)
    total = 0.0
    for i in range(4):
        place = min(max(row + i - 1, 0), PLACES - 1)
        for j in range(4):
            speed = min(max(column + j - 1, 0), SPEEDS - 1)
            total += over_place[i] * over_speed[j] * p.empirical_force.forces[place * SPEEDS + speed]
    return total


@inlined
def force_on_mass(z, velocity, y, p):
    """Force on the mass (N, up positive) at z (m) and z' (m/s)."""
    if p.empirical_force.velocity == 0.0:
        return 0.0
    return _force(_elongation(z, y, p), velocity, p)


@inlined
def power(velocity, y, p):
    """Power (W) that the force takes beyond what it takes at the same place when at rest."""
    if p.empirical_force.velocity == 0.0:
        return 0.0
    return (_force(y[0], 0.0, p) - _force(y[0], velocity, p)) * velocity
