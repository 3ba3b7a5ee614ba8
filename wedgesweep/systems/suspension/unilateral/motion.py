"""State of a wedge that may lift off: gaps at both faces beside the motion of the bolster.

Coordinates: x = z - z_rest of the bolster, and the gaps g_c at the column and g_b at the bolster face. With
S, c = sin, cos(alpha + gamma) the wedge lies at w = A t_c - g_c n_c against the side frame,

    A = r z - (g_b + c g_c) / S,    w_z = A cos(gamma) - g_c sin(gamma)

A closed contact has a gap of 0 at a rate of 0, both exact. The gaps are the last states, so that those before
them are the states of the suspension with bilateral joints.
"""

from typing import Any

from wedgesweep.compiled import by_type, contracted_of, inlined
from wedgesweep.effects import fixture_resonance, lift_off, states
from wedgesweep.excitation import acceleration
from wedgesweep.hybrid import interface
from wedgesweep.systems.suspension.modes import VELOCITY, X
from wedgesweep.systems.suspension.newton import applied_forces
from wedgesweep.systems.suspension.unilateral.contacts import Motion

UNILATERAL = lift_off.NAME
# The states of the gaps, from the end of a state vector.
COLUMN_GAP, COLUMN_RATE, BOLSTER_GAP, BOLSTER_RATE = range(-4, 0)
GAPS = (states.LENGTH, states.VELOCITY) * 2

states.add_last(UNILATERAL, GAPS)
interface.adds_states(UNILATERAL, lambda fields: len(states.kinds(fields)))


def without_gaps(y: Any) -> Any:
    """The states before those of the gaps."""
    raise NotImplementedError


@by_type(without_gaps)
def _without_gaps(y):
    return contracted_of(("y",), f"({', '.join(f'y[{i}]' for i in range(len(y) - len(GAPS)))},)")


@inlined
def with_gaps(y, gaps):
    """The state with other states of the gaps, a tuple of four."""
    return without_gaps(y) + gaps


@inlined
def velocities(y, p):
    """Motion (m/s) against the side frame."""
    g, column, bolster = p.geometry, y[COLUMN_RATE], y[BOLSTER_RATE]
    along = g.column_ratio * y[VELOCITY] - (bolster + g.cos_included * column) / g.sin_included
    return Motion(along, column, y[VELOCITY])


@inlined
def wedge_rise(y, p):
    """Rise w_z of the wedge against the side frame (m)."""
    g, column, bolster = p.geometry, y[COLUMN_GAP], y[BOLSTER_GAP]
    along = g.column_ratio * (g.rest + y[X]) - (bolster + g.cos_included * column) / g.sin_included
    return along * g.cos_column - column * g.sin_column


@inlined
def free_accelerations(t, y, segment, guide, p):
    """Accelerations without contact forces (m/s^2), against the side frame.

    ``segment`` of the travel of the bolster, and its slip branch in the ``guide``.
    """
    s, g = p.suspension, p.geometry
    wedge, bolster = applied_forces(wedge_rise(y, p), y, segment, guide, p)
    frame = acceleration(t, p)
    if fixture_resonance.acts(p):
        # All forces but that of the table act between the side frame and what it carries.
        frame = (fixture_resonance.force(y, p) - bolster - 2.0 * wedge) / s.side_frame_mass
    rise = wedge / s.wedge_mass - frame
    return Motion(rise * g.cos_column, -rise * g.sin_column, bolster / s.bolster_mass - frame)


@inlined
def _carried(p):
    """Mass (kg) of the side frame and all that it carries."""
    s = p.suspension
    return s.side_frame_mass + s.bolster_mass + 2.0 * s.wedge_mass


@inlined
def frame_acceleration(t, motion, y, p):
    """Acceleration (m/s^2) of the side frame against its table; ``motion``: accelerations against it."""
    if not fixture_resonance.acts(p):
        return 0.0
    return (fixture_resonance.force(y, p) - momentum(motion, p)) / _carried(p) - acceleration(t, p)


@inlined
def frame_jump(change, p):
    """Change of the side frame's velocity (m/s) in an impact; ``change``: of velocities against it."""
    return -momentum(change, p) / _carried(p) if fixture_resonance.acts(p) else 0.0


@inlined
def kinetic_energy(y, p):
    """Kinetic energy (J) of both wedges, bolster and side frame against the table."""
    s, motion, frame = p.suspension, velocities(y, p), fixture_resonance.velocity(y, p)
    own = 0.5 * s.bolster_mass * motion.rise**2 + s.wedge_mass * (motion.along**2 + motion.gap**2)
    return own + frame * (momentum(motion, p) + 0.5 * _carried(p) * frame)


@inlined
def momentum(motion, p):
    """Vertical momentum (N s) of both wedges and the bolster against the side frame."""
    s, g = p.suspension, p.geometry
    rising = g.cos_column * motion.along - g.sin_column * motion.gap
    return s.bolster_mass * motion.rise + 2.0 * s.wedge_mass * rising


@inlined
def momentum_against_table(y, p):
    """Vertical momentum (N s) of wedges, bolster and side frame against the table."""
    return momentum(velocities(y, p), p) + _carried(p) * fixture_resonance.velocity(y, p)
