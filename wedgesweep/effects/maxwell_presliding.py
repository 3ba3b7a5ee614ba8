"""Dry friction that builds up elastically: springs with sliders in parallel (Maxwell-slip; Iwan, 1966).

Each of COUNT elements is Jenkins': a spring that slips at its own force. All slip forces are the same, and
the elongations at which the elements slip are spread evenly on a logarithmic scale: its three numbers can be
read off a loop, as its height, its slope after a reversal, and over how many decades of travel it bends.
(Segalman's power law, 2005, has one more, which only shows over decades of amplitude.) At spread = 0 it is
Jenkins' element, where stiffness -> infinity Coulomb's friction; near a spread of 2 its loops are hardly
different from those of ``presliding`` (Dahl) with ``guide_friction``, but they obey Masing's rules.
Neutral and default: force = 0. Default of the spread: 0; stiffness must be given.
"""

from math import nan

import numpy as np

from wedgesweep.compiled import inlined, term
from wedgesweep.effects.base import NUMERICAL, OSCILLATOR, Effect
from wedgesweep.effects.states import SLIDER, place_of
from wedgesweep.equations.symbols import Meaning
from wedgesweep.hybrid.vectors import replaced
from wedgesweep.quantity import Quantity

EQUATIONS = (
    "R = -force (b_1 + b_2 + b_3 + b_4 + b_5)/5",
    "b_i' = z'/d_i  for |b_i| < 1",
    "d_i = d_3 exp(0.4 spread (i - 3))",
    "force (1/d_1 + 1/d_2 + 1/d_3 + 1/d_4 + 1/d_5)/5 = stiffness",
)
SYMBOLS = {
    **{f"b_{i}": Meaning("force in an element as a share of that at which it slips") for i in "i12345"},
    **{f"d_{i}": Meaning("elongation at which an element slips", "m") for i in "i12345"},
    "i": Meaning("number of the element, 1 to 5"),
}
REMARK = "An element with $|b_i| = 1$ slips until $z'$ reverses."

EFFECT = Effect(
    name="maxwell_presliding",
    family="missing-force",
    branch=NUMERICAL,
    systems=(OSCILLATOR,),
    of_loops=True,
    excludes=("damper_play", "series_compliance"),
    contains=("guide_friction", "friction_level"),
    limits=("guide_friction", "friction_level"),
    meaning="dry friction behind springs that slip one after the other (Maxwell, Iwan)",
    quantities=(
        Quantity("force_N", 0.0, "friction force where all elements slip", minimum=0.0, search=(0.0, 10.0)),
        Quantity(
            "stiffness_N_per_mm",
            nan,
            "stiffness after a reversal",
            above=0.0,
            off=1.0,
            search=(2.0, 5000.0),
            logarithmic=True,
        ),
        Quantity("spread", 0.0, "half the range of ln d", minimum=0.0, maximum=6.0, search=(0.0, 3.0)),
    ),
    extends=("force",),
)

COUNT = 5  # elements: enough for a smooth loop (see the tests), and few enough to be fast
# Step of ln d from element to element, as a share of the spread: each stands for a fifth of the range.
STEP = 2.0 / COUNT
STATES = (SLIDER,) * COUNT
# Numbers that follow from the others: elongation (m) at which the first element slips, and the ratio of that
# of each other one to the one before it.
DERIVED = ("shortest", "ratio")

_first = place_of("maxwell_presliding", 0)


def prepare(p: np.void) -> None:
    """Fill in what follows from the other numbers."""
    own = p["maxwell_presliding"]
    growth = np.exp(STEP * own["spread"] * np.arange(COUNT))
    own["ratio"], own["shortest"] = growth[1], own["force"] / own["stiffness"] * np.mean(1.0 / growth)


@term("maxwell_presliding", off="False")
def acts(p):
    """Whether there are elements."""
    return p.maxwell_presliding.force > 0.0


@inlined
def _held(y, i, p):
    """Force in an element as a share of that at which it slips."""
    return min(max(y[_first(p) + i], -1.0), 1.0)


@inlined
def mean_share(y, p):
    """Force over that where all elements slip, positive against positive velocity."""
    total = 0.0
    for i in range(COUNT):
        total += _held(y, i, p)
    return total / COUNT


@inlined
def force_on_mass(z, velocity, y, p):
    """Force on the mass (N)."""
    return -p.maxwell_presliding.force * mean_share(y, p) if acts(p) else 0.0


@inlined
def power(velocity, y, p):
    """Power (W) that the elements take, what their springs store among it."""
    return p.maxwell_presliding.force * mean_share(y, p) * velocity if acts(p) else 0.0


@inlined
def _rate(i, y, p):
    own = p.maxwell_presliding
    return y[1] / (own.shortest * own.ratio**i) if acts(p) else 0.0


@inlined
def rates(column_slip, acceleration, mode, y, p):
    """Rates (1/s) of the shares, those of elements that slip among them: ``slipped`` takes that back."""
    return (_rate(0, y, p), _rate(1, y, p), _rate(2, y, p), _rate(3, y, p), _rate(4, y, p))


@term("maxwell_presliding", off="y")
def slipped(y, p):
    """The state vector as sliders leave it, which matters from the next reversal on."""
    for i in range(COUNT):
        y = replaced(y, _first(p) + i, _held(y, i, p))
    return y


@term("maxwell_presliding", off="following")
def moved(y, following, step, p):
    """The state vector ``following`` with the shares after a step (s) at the velocity of ``y``: exact."""
    if acts(p):
        moves = y[1] * step / p.maxwell_presliding.shortest
        for i in range(COUNT):
            following = replaced(following, _first(p) + i, y[_first(p) + i] + moves)
            moves /= p.maxwell_presliding.ratio
        following = slipped(following, p)
    return following
