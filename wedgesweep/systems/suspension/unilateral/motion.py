"""State of a wedge that may lift off: gaps at both faces beside the motion of the bolster.

Coordinates: x = z - z_rest of the bolster, and the gaps g_c at the column and g_b at the bolster face. With
S, c = sin, cos(alpha + gamma) the wedge lies at w = A t_c - g_c n_c against the side frame,

    A = r z - (g_b + c g_c) / S,    w_z = A cos(gamma) - g_c sin(gamma)

A closed contact has a gap of 0 at a rate of 0, both exact.
"""

from typing import Any

from numba.core import types
from numba.extending import overload

from wedgesweep.compiled import CONTRACTED, function_of, inlined
from wedgesweep.effects import hooks, lift_off, states, travel
from wedgesweep.excitation import acceleration
from wedgesweep.systems.suspension.modes import VELOCITY, X
from wedgesweep.systems.suspension.unilateral.contacts import Motion

UNILATERAL = lift_off.NAME
COLUMN_GAP, COLUMN_RATE, BOLSTER_GAP, BOLSTER_RATE = 2, 3, 4, 5

states.add_to_mass(UNILATERAL, (states.LENGTH, states.VELOCITY) * 2)


def gap_state(y: Any, place: int) -> float:
    """One of the states of the gaps; 0 in a vector that ends with the motion of the bolster."""
    raise NotImplementedError


@overload(gap_state, jit_options=CONTRACTED)
def _gap_state(y, place):
    if not isinstance(y, types.BaseTuple):
        return None
    return function_of(("y", "place"), "0.0" if len(y) == 2 else "y[place]")


@inlined
def velocities(y, p):
    """Motion (m/s)."""
    g, column, bolster = p.geometry, gap_state(y, COLUMN_RATE), gap_state(y, BOLSTER_RATE)
    along = g.column_ratio * y[VELOCITY] - (bolster + g.cos_included * column) / g.sin_included
    return Motion(along, column, y[VELOCITY])


@inlined
def wedge_rise(y, p):
    """Rise w_z of the wedge against the side frame (m)."""
    g, column, bolster = p.geometry, gap_state(y, COLUMN_GAP), gap_state(y, BOLSTER_GAP)
    along = g.column_ratio * (g.rest + y[X]) - (bolster + g.cos_included * column) / g.sin_included
    return along * g.cos_column - column * g.sin_column


@inlined
def free_accelerations(t, y, segment, p):
    """Accelerations without contact forces (m/s^2); ``segment`` of the travel of the bolster."""
    s, g, z, velocity = p.suspension, p.geometry, p.geometry.rest + y[X], y[VELOCITY]
    base = acceleration(t, p)
    wedge = s.wedge_preload - s.wedge_spring * wedge_rise(y, p) - s.wedge_mass * (s.gravity + base)
    bolster = hooks.force_on_mass(z, velocity, y, p) + hooks.damping(velocity, y, p)
    bolster += travel.force(y[X], segment, s.bolster_spring, p)
    bolster -= s.bolster_spring * z + s.bolster_mass * (s.gravity + base)
    return Motion(
        wedge * g.cos_column / s.wedge_mass, -wedge * g.sin_column / s.wedge_mass, bolster / s.bolster_mass
    )


@inlined
def kinetic_energy(motion, p):
    """Kinetic energy (J) of both wedges and the bolster against the side frame."""
    s = p.suspension
    return 0.5 * s.bolster_mass * motion.rise**2 + s.wedge_mass * (motion.along**2 + motion.gap**2)


@inlined
def momentum(motion, p):
    """Vertical momentum (N s) of both wedges and the bolster against the side frame."""
    s, g = p.suspension, p.geometry
    rising = g.cos_column * motion.along - g.sin_column * motion.gap
    return s.bolster_mass * motion.rise + 2.0 * s.wedge_mass * rising
