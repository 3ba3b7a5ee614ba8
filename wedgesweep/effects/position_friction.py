"""Friction that varies along the stroke, as of a bore that is not round, or of a rod worn in the middle.

Two harmonics of the place: at a wavelength of several strokes friction rises or falls along them. They scale
all dry friction of the surface, which is never negative: where both would make it so, there is none.
Neutral and default: share = second = 0. Default: both phases 0; wavelength must be given.
"""

from math import nan, pi, sin

from wedgesweep.compiled import inlined, term
from wedgesweep.effects.base import NUMERICAL, OSCILLATOR, Effect
from wedgesweep.equations.symbols import Meaning
from wedgesweep.quantity import Quantity

EQUATIONS = (
    "mu -> mu (1 + s)  for s >= -1",
    "mu -> 0  for s < -1",
    "s = share sin(2 pi x/wavelength + share_phase) + second sin(4 pi x/wavelength + second_phase)",
)
SYMBOLS = {"s": Meaning("share by which friction differs from its mean")}

EFFECT = Effect(
    name="position_friction",
    family="friction-law",
    branch=NUMERICAL,
    systems=(OSCILLATOR,),
    of_loops=True,
    excludes=("series_compliance",),
    contains=("friction_level",),  # where the wave is long
    meaning="friction that varies along the stroke",
    acts_on=("guide_friction",),
    quantities=(
        Quantity("share", 0.0, "amplitude over the mean", minimum=0.0, search=(0.0, 0.9)),
        Quantity("share_phase_deg", 0.0, "phase at x = 0", search=(-180.0, 180.0)),
        Quantity(
            "wavelength_mm",
            nan,
            "length of a wave",
            above=0.0,
            off=1.0,
            search=(0.8, 12.0),
            logarithmic=True,
        ),
        Quantity("second", 0.0, "second harmonic over the mean", minimum=0.0, search=(0.0, 0.9)),
        Quantity("second_phase_deg", 0.0, "its phase at x = 0", search=(-180.0, 180.0)),
    ),
    extends=("share", "second"),
)


@inlined
def _factor(x, p):
    own = p.position_friction
    if own.share == 0.0 and own.second == 0.0:
        return 1.0
    factor = 1.0 + own.share * sin(2.0 * pi * x / own.wavelength + own.share_phase)
    if own.second != 0.0:
        factor += own.second * sin(4.0 * pi * x / own.wavelength + own.second_phase)
    return max(factor, 0.0)


@term("position_friction", off="friction")
def scaled(friction, x, p):
    """Friction (N) at a place x (m), from the mean along the stroke."""
    return _factor(x, p) * friction
