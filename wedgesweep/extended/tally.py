"""Running sums over the kept window of an extended run; see ``wedgesweep.tally``."""

from wedgesweep.compiled import compiled
from wedgesweep.excitation import table_acceleration
from wedgesweep.extended.faces import column_slip
from wedgesweep.extended.jumps import combined
from wedgesweep.extended.mechanics import forces, riding
from wedgesweep.extended.mode import VELOCITY, X, held, stuck
from wedgesweep.extended.power import damping_power, friction_power, supplied_power
from wedgesweep.tally import add_motion


@compiled
def forces_and_power(t, y, mode, p):
    """Forces on any mode, and the power (W) that friction takes."""
    if stuck(mode, p):
        return riding(t, y, mode, p), 0.0
    if held(mode):
        now, power, _ = combined(t, y, mode, p)
        return now, power
    now = forces(t, y, mode, p)
    return now, friction_power(t, y, mode, now, p)


@compiled
def sticks(y, mode, p):
    """Whether the column face sticks: bristles end no branch at the threshold velocity."""
    if abs(mode.column) == 1 and p.presliding_length > 0.0 and not p.set_valued:
        return abs(column_slip(y, p)) <= p.threshold_velocity
    return abs(mode.column) != 1


@compiled
def add(tally, t, y, weight, mode, p):
    """Add one point of the kept window; ``weight`` (s) as in a quadrature."""
    add_motion(tally, y[X], y[VELOCITY], weight, sticks(y, mode, p))
    now, power = forces_and_power(t, y, mode, p)
    tally.dissipated += weight * (power + damping_power(y, p))
    tally.supplied += weight * supplied_power(table_acceleration(t, p), y, p)
    if not stuck(mode, p):
        tally.normal_force = min(tally.normal_force, now.column, now.bolster)
        if now.column < 0.0 or now.bolster < 0.0:
            tally.lifted_time += weight
