"""Bristles of LuGre friction (lugre.py): a state of their own, as effects have them.

The state is the share b = z / (mu_d N / sigma_0), which is 1 in slow steady slip if mu_s = mu_d:

    b' = sigma_0/(mu_d N) (v - |v| b mu_d N / g(v)),    T = mu_d N (b + sigma_1/sigma_0 b') + sigma_2 v
"""

from wedgesweep.compiled import inlined, term
from wedgesweep.effects.states import SHARE, state
from wedgesweep.friction import lugre

NAME = "lugre"
STATES = (SHARE,)
# The part of a record: sigma_0 (N/m), sigma_1 and sigma_2 (N s/m), and mu_d N (N).
NUMBERS = ("stiffness", "damping", "viscous", "coulomb")

bristle = state(NAME, 0)


@term(NAME, off="False")
def acts(p):
    """Whether a record has bristles of this kind."""
    return p.lugre.stiffness > 0.0


@inlined
def _rate(v, y, p):
    """Rate (1/s) of the bristles' share, at a slip velocity (m/s)."""
    own = p.lugre
    if not acts(p) or own.coulomb == 0.0:
        return 0.0
    level = lugre.sliding(abs(v), p) / p.friction.mu_d
    return own.stiffness / own.coulomb * (v - abs(v) * bristle(y, p) / level)


@term(NAME, off="0.0")
def force(v, y, p):
    """Friction T (N) at a slip velocity (m/s)."""
    own = p.lugre
    bent = bristle(y, p) + own.damping / own.stiffness * _rate(v, y, p)
    return own.coulomb * bent + own.viscous * v


@inlined
def rates(column_slip, acceleration, mode, y, p):
    """Rate of the bristles' share (1/s)."""
    return (_rate(column_slip, y, p),)
