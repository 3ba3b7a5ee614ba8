"""Elastic creep of the column face before it slips, for every law (Dahl, 1968).

The bolster face keeps its law. Neutral: the limit length -> 0 is set-valued friction on the column face, the
base model under no regularised law; off where the table is absent (0 in the record). Default: none, length
must be given.
"""

from math import nan

from wedgesweep.compiled import inlined, term
from wedgesweep.effects.base import NUMERICAL, Effect
from wedgesweep.effects.states import SHARE, state
from wedgesweep.equations.symbols import Meaning
from wedgesweep.quantity import Quantity

EQUATIONS = ("mu_c = mu_d b", "b' = v_c/length (1 - b sign(v_c))")
SYMBOLS = {
    "b": Meaning("share of the bristles' deflection at which they slip"),
}
REMARK = "It replaces the law on this face."

EFFECT = Effect(
    name="presliding",
    family="friction-law",
    branch=NUMERICAL,
    meaning="elastic creep of the {face} before it slips (Dahl)",
    acts_on=("guide_friction",),
    quantities=(
        Quantity(
            "length_mm",
            nan,
            "slip over which friction builds up",
            above=0.0,
            off=0.0,
            search=(1e-4, 0.5),
            logarithmic=True,
        ),
    ),
    extends=("length",),
)


STATES = (SHARE,)
# Where bristles settle this many times faster than the input, a few long implicit steps take less time than
# many short explicit ones.
STIFF = 300.0


bristle = state("presliding", 0)


@term("presliding", off="False")
def acts(p):
    """Whether the column face has bristles."""
    return p.presliding.length > 0.0


@term("presliding", off="mu")
def coefficient(mu, y, p):
    """Coefficient of the column face, from that of the law."""
    return p.friction.mu_d * bristle(y, p) if acts(p) else mu


@inlined
def rates(column_slip, acceleration, mode, y, p):
    """Rate of the bristles' share (1/s); ``mode.column`` is the sign of the slip."""
    if not acts(p):
        return (0.0,)
    return (column_slip / p.presliding.length * (1.0 - bristle(y, p) * mode.column),)


@term("presliding", off="False")
def outruns(h, column_slip, p):
    """Whether the bristles alone limit an explicit step, h (s) long."""
    length, slip = p.presliding.length, abs(column_slip)
    return length > 0.0 and slip > STIFF * p.input.omega * length and slip * h > length
