"""Play in the rod of a damper: it moves freely from one end of the play to the other (lost motion).

The damper has no mass. It rests where the rod left it, and follows at once when the rod meets an end of the
play. Behind the play are friction and, where it acts at the same velocity, all damping: not where a mass
rubs on the ground and its base moves. A run begins in the middle of the play.
Neutral and default: clearance = 0.
"""

from math import nan

from wedgesweep.compiled import inlined, term
from wedgesweep.effects.base import NUMERICAL, OSCILLATOR, Effect
from wedgesweep.effects.states import LENGTH, place_of, set_state, state
from wedgesweep.equations.symbols import Meaning
from wedgesweep.hybrid.vectors import replaced
from wedgesweep.quantity import Quantity

EQUATIONS = (
    "D = 0,  q' = v  for |q| < clearance",
    "D = mu N + c v,  q' = 0  for |q| = clearance,  q v > 0",
)
SYMBOLS = {
    "D": Meaning("force of the damper: friction, and damping at the same velocity", "N"),
    "q": Meaning("place of the rod in its play", "m"),
}

EFFECT = Effect(
    name="damper_play",
    family="contact",
    branch=NUMERICAL,
    systems=(OSCILLATOR,),
    excludes=("presliding", "guide_friction"),
    meaning="play in the rod of the damper, across which friction and damping do not act",
    quantities=(
        Quantity(
            "clearance_mm",
            0.0,
            "play either way from the middle",
            minimum=0.0,
            search=(1e-5, 1.0),
            logarithmic=True,
        ),
    ),
    extends=("clearance",),
)


STATES = (LENGTH,)
# Branch of no friction: the rod crosses the play. Others are numbers of branches of friction.
CROSSING = 3


# Place (m) of the rod in the play, and the state vector with another one.
rod = state("damper_play", 0)
with_rod = set_state("damper_play", 0)
_place = place_of("damper_play", 0)


@term("damper_play", off="False")
def acts(p):
    """Whether there is play."""
    return p.damper_play.clearance > 0.0


@term("damper_play", off="0.0")
def clearance(p):
    """Play either way (m)."""
    return p.damper_play.clearance


@term("damper_play", off="0")
def side(y, p):
    """End of the play (-1: lower, 1: upper) at which the rod is; 0: at none."""
    if not acts(p) or abs(rod(y, p)) < clearance(p):
        return 0
    return 1 if rod(y, p) > 0.0 else -1


@inlined
def pressing(y, end, p):
    """The state with the rod at an end of the play (-1, 1)."""
    return with_rod(y, end * clearance(p), p)


@inlined
def rod_after(y, distance, p):
    """Place (m) of the rod after a distance (m) of the mass from the damper."""
    return min(max(rod(y, p) + distance, -clearance(p)), clearance(p))


@inlined
def share_before_end(y, distance, p):
    """Share of a distance (m) after which a rod that crosses its play begins to press; NaN: it does not."""
    start, end = rod(y, p), clearance(p) if distance > 0.0 else -clearance(p)
    if start == end or abs(distance) < abs(end - start):
        return nan
    return (end - start) / distance


@term("damper_play", off="found")
def freed(found, y, p):
    """What may vary of a state, of which the rod does where it crosses the play."""
    return replaced(found, _place(p), side(y, p) == 0) if acts(p) else found


@inlined
def write_events(y, place, p, out):
    """Write the distances (m) of the rod to the lower and the upper end of the play."""
    out[place], out[place + 1] = clearance(p) + rod(y, p), clearance(p) - rod(y, p)


@inlined
def rates(column_slip, acceleration, mode, y, p):
    """Velocity (m/s) of the rod in the play."""
    return (column_slip if mode.column == CROSSING else 0.0,)
