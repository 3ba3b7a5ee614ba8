"""Modes of the oscillator: which smooth piece of its equations holds."""

from typing import NamedTuple

from wedgesweep.compiled import inlined
from wedgesweep.effects import presliding
from wedgesweep.effects.damper_play import CROSSING
from wedgesweep.friction import lugre_bristles as bristles

# Displacement (m), against the base or the ground, and its rate: the first two states.
X, VELOCITY = 0, 1
# Branch of friction whose slip velocity a jump at +-v_t holds (Filippov), with the sign of that velocity.
HELD = 2


class Mode(NamedTuple):
    """Which smooth piece of the equations holds.

    ``column``: slip branch (-1, 0, 1, or +-HELD) of the rubbing face, by the name that effects know; 0 is
    stuck under a set-valued law; CROSSING: a rod crosses its play, and nothing rubs. ``direction``: sign of
    the slip where friction depends on it, or on its reversals, else 0. ``segment`` of the travel: see
    effects/travel.py. ``clock``: 1 while the time at rest runs.
    """

    column: int
    direction: int
    segment: int
    clock: int


@inlined
def creeps(p):
    """Whether bristles bend before the mass slips, so that it never sticks for good."""
    return presliding.acts(p) or bristles.acts(p)


@inlined
def stuck(mode, p):
    """Whether set-valued friction holds the mass to the rubbing surface."""
    return p.friction.set_valued != 0 and mode.column == 0


@inlined
def crosses(mode):
    """Whether the rod of the damper crosses its play."""
    return mode.column == CROSSING


@inlined
def slip(y, p):
    """Velocity of the mass against the rubbing surface (m/s)."""
    return y[VELOCITY] - p.oscillator.belt_velocity
