"""Impacts: a gap closes, and impulses change all velocities at once.

Moreau's impact law with one coefficient of restitution e for normal and tangential directions: with the
velocities v before and v+ after an impact, the weighted velocities v+ + e v and the impulses fulfil the
inequalities of ``contacts``. As these are homogeneous, v+ = v + (1 + e) (v0 - v), where v0 is the solution
for e = 0. Both contacts take part if both touch; the friction of a guide is finite, and does not. The energy
of an impact cannot grow: with the impulses P and the velocities v+ + e v at the contacts its change is
[P (v+ + e v) - (1 - e) P G P / 2] / (1 + e), G the positive inverse mass, and P (v+ + e v) <= 0.

Moreau, Unilateral contact and dry friction in finite freedom dynamics (1988); Leine and van de Wouw,
Stability and Convergence of Mechanical Systems with Unilateral Constraints (2008).
"""

from typing import Any, NamedTuple

from wedgesweep.compiled import inlined, inner
from wedgesweep.effects import fixture_resonance, states
from wedgesweep.hybrid.vectors import combination, replaced, weighted
from wedgesweep.systems.suspension.modes import VELOCITY
from wedgesweep.systems.suspension.unilateral.contacts import (
    OPEN,
    Faces,
    Motion,
    Reactions,
    bolster_gap,
    mobility,
    motion_under,
    rounding,
    solve,
)
from wedgesweep.systems.suspension.unilateral.modes import BOLSTER_CLOSES, COLUMN_CLOSES, STILL
from wedgesweep.systems.suspension.unilateral.motion import (
    BOLSTER_GAP,
    BOLSTER_RATE,
    COLUMN_GAP,
    COLUMN_RATE,
    frame_jump,
    velocities,
    with_gaps,
)

# A face that falls back more slowly than this share of the input velocity does not bounce: that ends the
# infinitely many impacts of a bouncing face.
SLOWEST_BOUNCE = 1e-6


class Impact(NamedTuple):
    """State after an impact, impulses (N s) on one wedge, and whether these are unique."""

    y: Any
    impulses: Reactions
    unique: bool


@inlined
def _gap_rate(state, before, after, restitution, nothing):
    """Rate of the gap of a contact after an impact: where an impulse acts exactly that of Newton's law.

    ``nothing`` (m/s): a rate that counts as none.
    """
    if state != OPEN:
        after = -restitution * before
    return 0.0 if abs(after) <= nothing else after


@inlined
def restitution_at(approach, p):
    """Coefficient of restitution at a speed of approach (m/s)."""
    slow = approach < SLOWEST_BOUNCE * states.scales(p)[VELOCITY]
    return 0.0 if slow else p.lift_off.restitution


@inner
def struck(y, column, bolster, restitution, p):
    """The impact of a state in which the contacts ``column`` and ``bolster`` (or one) touch, under mu_d."""
    before, mu = velocities(y, p), p.friction.mu_d
    found, certain = solve(before, Faces(column, bolster, False, mu, mu, False), p)
    unique = certain == 1 or (certain == 0 and found.margin >= -rounding(before, p))
    plastic = motion_under(before, mobility(p), found.reactions, p)
    part = 1.0 + restitution
    change = Motion(*combination(part, (1.0, -1.0), (plastic, before)))
    after = Motion(*weighted(before, 1.0, (1.0,), (change,)))
    rate_before = y[BOLSTER_RATE]
    nothing = STILL * (states.scales(p)[VELOCITY] + abs(before.gap) + abs(rate_before))
    column_rate = _gap_rate(found.column, before.gap, after.gap, restitution, nothing)
    bolster_rate = _gap_rate(found.bolster, rate_before, bolster_gap(after, p), restitution, nothing)
    velocity = after.rise
    if column_rate == 0.0 and bolster_rate == 0.0 and column and bolster and abs(velocity) <= nothing:
        velocity = 0.0
    gaps = (
        0.0 if column else y[COLUMN_GAP],
        column_rate if column else after.gap,
        0.0 if bolster else y[BOLSTER_GAP],
        bolster_rate if bolster else bolster_gap(after, p),
    )
    frame = fixture_resonance.velocity(y, p) + frame_jump(change, p)
    later = fixture_resonance.with_velocity(replaced(y, VELOCITY, velocity), frame, p)
    return Impact(with_gaps(later, gaps), Reactions(*combination(part, (1.0,), (found.reactions,))), unique)


@inner
def closing(y, mode, place, p):
    """The impact at the event in which a gap closes.

    A contact that has opened just now, and does not move apart yet, still takes part in it.
    """
    column = y[COLUMN_GAP] == 0.0 and y[COLUMN_RATE] <= 0.0
    bolster = y[BOLSTER_GAP] == 0.0 and y[BOLSTER_RATE] <= 0.0
    column = column or mode.column_sign == 1 or place == COLUMN_CLOSES
    bolster = bolster or mode.bolster_sign == 1 or place == BOLSTER_CLOSES
    approach = -(y[COLUMN_RATE] if place == COLUMN_CLOSES else y[BOLSTER_RATE])
    return struck(y, column, bolster, restitution_at(approach, p), p)
