"""A force of displacement and velocity that was measured, not derived: a table, interpolated by cubics.

A diagnosis fits it where no effect with a name explains the tests. Its nodes are even in displacement, Z
(``displacement``) to either side of a ``centre``, and closer together at low velocities: even in w with
w = (1 + GRADING) t / (|t| + GRADING), t = v/V (``velocity``). Between nodes it is a product of cubic splines
in z and in v (not-a-knot: de Boor, 1978), which have all cubic polynomials among them, beyond the nodes
constant. The step at v = 0 is none of it: that is dry friction, of the faces or of the guide.
Neutral: velocity = 0. Default: none, the ranges and the forces at the nodes must be given.
"""

from collections.abc import Mapping
from itertools import pairwise
from math import nan
from typing import Any

import numpy as np

from wedgesweep.compiled import by_record, function_of, inlined, inner
from wedgesweep.effects.base import NUMERICAL, Effect
from wedgesweep.equations.symbols import Meaning
from wedgesweep.quantity import Quantity

NAME = "empirical_force"
# Number of nodes over displacement and over velocity. Between them a force with two and a half periods over
# the stroke (cogging) is off by 2 % of its size, with nine places by 21 %; with 13 speeds a bump of friction
# a tenth of the largest velocity wide was found to 22 % in place of 1.5 %.
PLACES, SPEEDS = 11, 21
# Nodes are 4 times as close together at rest as at the largest velocity.
GRADING = 1.0
# Key of the forces (N) at the nodes, a row for each displacement, and the coefficients of the splines (N)
# that a record has in their place.
TABLE, COEFFICIENTS = "forces_N", "coefficients"

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
FIELDS = [(COEFFICIENTS, np.float64, (PLACES * SPEEDS,))]


def nodes(displacement: float, velocity: float, centre: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Displacements (PLACES,) and velocities (SPEEDS,) of the nodes, in the units of the ranges."""
    even = np.linspace(-1.0, 1.0, SPEEDS)
    graded = GRADING * even / (1.0 + GRADING - np.abs(even))
    return centre + displacement * np.linspace(-1.0, 1.0, PLACES), velocity * graded


def _knots(places: np.ndarray) -> np.ndarray:
    """Knots (n + 4,) of n splines through nodes: all but the second at each end, the ends four times."""
    return np.r_[[places[0]] * 4, places[2:-2], [places[-1]] * 4]


def _splines(knots: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Cubic B-splines (m, n) of n + 4 knots at places (m,), by de Boor's recursion."""
    # Which stretch between knots a place is in; the last one has both of its ends.
    stretch = np.clip(np.searchsorted(knots, at, side="right"), 4, knots.size - 4) - 1
    found = np.eye(knots.size - 1)[stretch]
    for degree in range(1, 4):
        width = knots[degree:] - knots[:-degree]
        share = (at[:, None] - knots[:-degree]) / np.where(width > 0.0, width, np.inf)
        rising, falling = share * found, np.where(width > 0.0, 1.0 - share, 0.0) * found
        found = rising[:, :-1] + falling[:, 1:]
    return found


_PLACES, _SPEEDS = nodes(1.0, 1.0)
_OF_PLACES, _OF_SPEEDS = _knots(_PLACES), _knots(_SPEEDS)
# Coefficients (n, n) of the splines that are 1 at one node and 0 at the others, a column for each node.
_THROUGH_PLACES = np.linalg.inv(_splines(_OF_PLACES, _PLACES))
_THROUGH_SPEEDS = np.linalg.inv(_splines(_OF_SPEEDS, _SPEEDS))


def interpolation(places: np.ndarray, speeds: np.ndarray) -> np.ndarray:
    """Weights (n, PLACES SPEEDS) of the nodes at places and speeds (n,), in units of the ranges."""
    over_place = _splines(_OF_PLACES, np.clip(places, -1.0, 1.0)) @ _THROUGH_PLACES
    over_speed = _splines(_OF_SPEEDS, np.clip(speeds, -1.0, 1.0)) @ _THROUGH_SPEEDS
    return (over_place[:, :, None] * over_speed[:, None, :]).reshape(len(places), -1)


def coefficients(forces: np.ndarray) -> tuple[float, ...]:
    """Coefficients of the splines through forces (PLACES SPEEDS,) at the nodes."""
    found = _THROUGH_PLACES @ np.reshape(forces, (PLACES, SPEEDS)) @ _THROUGH_SPEEDS.T
    return tuple(found.ravel().tolist())


def table(given: Mapping[str, Any]) -> dict[str, Any]:
    """What a record has of the forces (SI) of a table of a config."""
    return {COEFFICIENTS: coefficients(given[TABLE])}


def _polynomials(knots: np.ndarray) -> np.ndarray:
    """Of each stretch between knots the four splines there: (stretches, 4, 4), coefficients by power."""
    found = []
    for i, (begin, end) in enumerate(pairwise(knots[3:-3])):
        after = (end - begin) * np.array([0.0, 0.25, 0.5, 0.75])
        values = _splines(knots, begin + after)[:, i : i + 4]
        found.append(np.linalg.solve(np.vander(after, increasing=True), values))
    return np.array(found)


_PLACE_KNOTS, _SPEED_KNOTS = _OF_PLACES[3:-4], _OF_SPEEDS[3:-4]
_PLACE_POLYNOMIALS, _SPEED_POLYNOMIALS = _polynomials(_OF_PLACES), _polynomials(_OF_SPEEDS)


def _elongation(z, y, p): ...


# What displacement counts from: a suspension's rest position, or where an oscillator's spring is relaxed.
by_record(_elongation, lambda fields: function_of(["z", "y", "p"], "z" if "oscillator" in fields else "y[0]"))


@inlined
def _stretch(even, count):
    """Number of the stretch between knots, at a coordinate in which nodes are even."""
    # The second and the last but one node are no knots.
    return min(max(int(0.5 * (even + 1.0) * (count - 1)) - 1, 0), count - 4)


@inlined
def _spline(polynomials, i, x, j):
    """Value of the spline ``j`` of the four that there are, ``x`` after the beginning of stretch ``i``."""
    own = polynomials[i]
    return own[0, j] + x * (own[1, j] + x * (own[2, j] + x * own[3, j]))


@inner
def _force(z, velocity, p):
    place = min(max((z - p.empirical_force.centre) / p.empirical_force.displacement, -1.0), 1.0)
    speed = min(max(velocity / p.empirical_force.velocity, -1.0), 1.0)
    row, column = _stretch(place, PLACES), _stretch((1.0 + GRADING) * speed / (abs(speed) + GRADING), SPEEDS)
    place, speed = place - _PLACE_KNOTS[row], speed - _SPEED_KNOTS[column]
    total = 0.0
    for i in range(4):
        along = 0.0
        for j in range(4):
            own = p.empirical_force.coefficients[(row + i) * SPEEDS + column + j]
            along += _spline(_SPEED_POLYNOMIALS, column, speed, j) * own
        total += _spline(_PLACE_POLYNOMIALS, row, place, i) * along
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
