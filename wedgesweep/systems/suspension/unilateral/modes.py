"""Modes of a wedge that may lift off: which contacts are closed, and which faces slip or stick.

A mode is a ``ContactMode`` whose signs of the normal forces are 1 for a closed contact and 0 for an open
one. The branch of an open face is 0. Contacts that touch (gap and rate are 0), with the slip that they have,
are such a mode as well, for which ``resolve`` finds the one that follows; under a set-valued law branch 0
means there that a face or the guide does not slip. The bolster may rest against its guide, or slip there,
while contacts are open.
"""

from wedgesweep import friction
from wedgesweep.compiled import inlined, inner
from wedgesweep.effects import fixture_resonance, guide_friction, states
from wedgesweep.hybrid.vectors import replaced
from wedgesweep.systems.shared import LOOK_AHEAD, ROUNDING
from wedgesweep.systems.suspension.events import CLOCK
from wedgesweep.systems.suspension.modes import BOLSTER, COLUMN, DIRECTION, HELD, VELOCITY, ContactMode, X
from wedgesweep.systems.suspension.modes import stuck as both_stuck
from wedgesweep.systems.suspension.unilateral.contacts import (
    FORWARD,
    OPEN,
    STICK,
    Faces,
    bolster_slip,
    motion_of,
    rounding,
    solve,
    weight,
)
from wedgesweep.systems.suspension.unilateral.motion import (
    BOLSTER_GAP,
    BOLSTER_RATE,
    COLUMN_GAP,
    COLUMN_RATE,
    frame_acceleration,
    free_accelerations,
    velocities,
    with_gaps,
)

# Places of the event functions as for bilateral joints, with the gaps in place of the sign of z' and of the
# time at rest. They are not a pair, as one of them may close right after the other.
COLUMN_CLOSES, BOLSTER_CLOSES = 2 * DIRECTION, CLOCK
# Slip below this share of the input velocity counts as none under a set-valued law.
STILL = 1e-11
# If no mode is certain at an instant, MOMENTS later ones are tried, each FARTHER times as far ahead.
MOMENTS, FARTHER = 4, 30.0


@inlined
def closed(mode):
    """Whether both contacts are closed: then the equations are those of bilateral joints."""
    return mode.column_sign == 1 and mode.bolster_sign == 1


@inlined
def stuck(mode, p):
    """Whether set-valued friction holds the bolster."""
    return closed(mode) and both_stuck(mode, p)


@inlined
def rests_in_guide(mode, p):
    """Whether a guide that rubs holds the bolster under a set-valued law."""
    return p.friction.set_valued and mode.guide == 0 and guide_friction.acts(p)


@inlined
def is_open(y):
    """Whether the column face and the bolster face are open: not closed, and not about to open."""
    column = y[COLUMN_GAP] != 0.0 or y[COLUMN_RATE] != 0.0
    return column, y[BOLSTER_GAP] != 0.0 or y[BOLSTER_RATE] != 0.0


@inlined
def slip_branch(slip, nothing, p):
    """Slip branch of a face; ``nothing`` (m/s): slip that counts as none under a set-valued law."""
    if not p.friction.set_valued:
        return friction.branch_at(slip, p)
    if abs(slip) <= nothing:
        return 0
    return 1 if slip > 0.0 else -1


@inner
def touching(y, segment, p):
    """Contacts of a state that touch, and their slip branches; ``segment`` of the travel."""
    column, bolster = is_open(y)
    motion, nothing = velocities(y, p), STILL * states.scales(p)[VELOCITY]
    if not (column or bolster):
        nothing = 0.0 if y[VELOCITY] != 0.0 else nothing
    column_branch = slip_branch(motion.along, nothing, p)
    bolster_branch = slip_branch(bolster_slip(motion, p), nothing, p)
    guide, signs = slip_branch(y[VELOCITY], 0.0, p), (0 if column else 1, 0 if bolster else 1)
    return ContactMode(column_branch, bolster_branch, guide, 0, signs[0], signs[1], segment, 0)


@inlined
def signed_coefficient(slip, branch, clock, y, p):
    """Signed coefficient of friction of a face that slips, or is on the ramp of a regularised law."""
    return friction.coefficient(slip, branch, friction.static(clock, y, p), p)


@inner
def _faces(y, contact, p):
    """The contact problem's faces at a state."""
    slipping, touches = not p.friction.set_valued, contact.column_sign == 1
    if not slipping:
        slipping = (contact.column if touches else contact.bolster) != 0
    guide_rests = rests_in_guide(contact, p)
    if not slipping:
        highest = friction.static(1, y, p)
        return Faces(touches, contact.bolster_sign == 1, False, highest, highest, guide_rests)
    motion, clock = velocities(y, p), 1 if contact.column == 0 else 0
    column = signed_coefficient(motion.along, contact.column, clock, y, p)
    bolster = signed_coefficient(bolster_slip(motion, p), contact.bolster, clock, y, p)
    return Faces(touches, contact.bolster_sign == 1, True, column, bolster, guide_rests)


@inner
def _later(t, y, motion, moment, p):
    """State after a moment (s) at constant accelerations of bolster and side frame, and rates of the gaps."""
    column, bolster = y[COLUMN_RATE], y[BOLSTER_RATE]
    gaps = y[COLUMN_GAP] + moment * column, column, y[BOLSTER_GAP] + moment * bolster, bolster
    later = fixture_resonance.later(y, moment, frame_acceleration(t, motion, y, p), p)
    later = replaced(later, X, y[X] + moment * y[VELOCITY] + 0.5 * moment * moment * motion.rise)
    return with_gaps(replaced(later, VELOCITY, y[VELOCITY] + moment * motion.rise), gaps)


@inlined
def _branch(state, branch, slipping):
    """Slip branch of a face in a solution."""
    if state == OPEN:
        return 0
    if slipping:
        return branch
    return 0 if state == STICK else (1 if state == FORWARD else -1)


@inner
def _mode(found, contact, faces, p):
    column = _branch(found.column, contact.column, faces.slipping)
    bolster = _branch(found.bolster, contact.bolster, faces.slipping)
    column_sign, bolster_sign = 1 if found.column != OPEN else 0, 1 if found.bolster != OPEN else 0
    clock = 1 if column == 0 else 0
    if p.friction.set_valued:
        clock = 1 if found.column == STICK and found.bolster == STICK else 0
    guide = found.guide if faces.guide_rests else contact.guide
    return ContactMode(column, bolster, guide, 0, column_sign, bolster_sign, contact.segment, clock)


@inner
def resolve(t, y, contact, p):
    """The mode that follows for contacts which touch now, and whether it is unique."""
    guide, segment = contact.guide, contact.segment
    free, faces = free_accelerations(t, y, segment, guide, p), _faces(y, contact, p)
    found, certain = solve(free, faces, p)
    moment, doubtful = LOOK_AHEAD / p.input.omega, ROUNDING * weight(p)
    for _ in range(MOMENTS):
        # Loads that nearly cancel each other leave rounding errors of their own size, not of their sum's.
        if certain > 0 and found.margin > doubtful:
            break
        later = _later(t, y, motion_of(found, free, faces, p), moment, p)
        there, faces = free_accelerations(t + moment, later, segment, guide, p), _faces(later, contact, p)
        found, certain = solve(there, faces, p)
        moment *= FARTHER
    unique = certain == 1 or (certain == 0 and found.margin >= -rounding(free, p))
    return _mode(found, contact, faces, p), unique


@inlined
def _with_branches(contact, column, bolster):
    return replaced(replaced(contact, COLUMN, column), BOLSTER, bolster)


@inner
def without_jump(t, y, contact, p):
    """The same contacts, with faces that a jump held on the branch that their slip moves into."""
    column, bolster = contact.column, contact.bolster
    if abs(column) != HELD and abs(bolster) != HELD:
        return contact
    outer = _with_branches(contact, _beyond_jump(column), _beyond_jump(bolster))
    free, faces = free_accelerations(t, y, contact.segment, contact.guide, p), _faces(y, outer, p)
    motion = motion_of(solve(free, faces, p)[0], free, faces, p)
    slip = bolster_slip(motion, p)
    return _with_branches(contact, _entered(column, motion.along), _entered(bolster, slip))


@inlined
def _beyond_jump(branch):
    """The branch beyond the jump that holds a face."""
    return branch // HELD if abs(branch) == HELD else branch


@inlined
def _entered(branch, acceleration):
    """The branch that a face enters from the jump that held it, at a slip acceleration."""
    if abs(branch) != HELD:
        return branch
    return branch // HELD if branch * acceleration >= 0.0 else 0
