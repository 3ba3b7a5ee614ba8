"""Compiled functions of unilateral joints as Python calls them."""

from wedgesweep.compiled import compiled
from wedgesweep.hybrid import interface
from wedgesweep.systems.suspension import filippov, set_valued, transitions
from wedgesweep.systems.suspension.modes import HELD, ContactMode
from wedgesweep.systems.suspension.unilateral import contacts, impact, modes, motion
from wedgesweep.systems.suspension.unilateral.closed import stays_closed


@compiled
def struck(y, column, bolster, restitution, case):
    """Impact of a state in which the given contacts touch."""
    return impact.struck(y, column, bolster, restitution, case[0])


@compiled
def velocities(y, case):
    """Velocities of the wedge along and off the column, and of the bolster."""
    return motion.velocities(y, case[0])


@compiled
def solve(free, faces, case):
    """Reactions of a contact problem, and how many solutions it has."""
    return contacts.solve(free, faces, case[0])


@compiled
def resolve(t, y, case):
    """Mode of the contacts that touch in a state, and whether it is unique."""
    return modes.resolve(t, y, modes.touching(y, 0, case[0]), case[0])


@compiled
def well_posed_where_a_jump_holds(t, y, case):
    """Whether a state whose column slips at a jump is well-posed, by the interface and by its forces."""
    p = case[0]
    mode = ContactMode(HELD, 1, 0, 0, 1, 1, 0, 0)
    return interface.well_posed(t, y, mode, p), filippov.filippov_forces(t, y, mode, p)[2]


@compiled
def bilateral_mode(t, y, opening):
    """Whether a state of the mass is in a mode of bilateral joints, and their mode."""
    p = opening[0]
    mode, unique = transitions.initial_mode(t, y, p)
    return unique and stays_closed(y, mode, p), mode


@compiled
def contacts_at(t, y, opening):
    """Mode of contacts that are closed and may open, and whether it is unique."""
    state, p = (y[0], y[1], 0.0, 0.0, 0.0, 0.0), opening[0]
    return modes.resolve(t, state, modes.touching(state, 0, p), p)


@compiled
def breakaway_inputs(y, opening):
    """Base accelerations below and above which a bolster at rest breaks away; NaN if a face opens before."""
    forward = set_valued.breakaway_input(y, 1, 0, opening[0])
    return forward, set_valued.breakaway_input(y, -1, 0, opening[0])


@compiled
def motion_of(solution, free, faces, case):
    """Motion in a solution of a contact problem."""
    return contacts.motion_of(solution, free, faces, case[0])


@compiled
def kinetic_energy(y, case):
    """Kinetic energy against the table."""
    return motion.kinetic_energy(y, case[0])


@compiled
def rate_at(t, y, case):
    """Rate of a state in the mode in which a run begins there."""
    return interface.rate(t, y, interface.initial_mode(t, y, case[0])[0], case[0])[0]


@compiled
def reactions_of_closed(t, y, case):
    """Normal forces of two closed faces that slip upwards."""
    p = case[0]
    found = interface.contact_forces(t, y, ContactMode(1, -1, 1, 0, 1, 1, 0, 0), p)
    return found[0], found[1]


@compiled
def after_bolster_closes(y, case):
    """State after the bolster face hits; before, both contacts were open."""
    return interface.transition(0.0, y, ContactMode(0, 0, 0, 0, 0, 0, 0, 0), modes.BOLSTER_CLOSES, case[0])[0]
