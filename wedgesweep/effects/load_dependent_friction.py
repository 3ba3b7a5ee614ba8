"""Coefficients of friction that depend on the normal force (Hertzian contacts: exponent 1/3).

Each face has its own N; N and mu are solved together. That of an oscillator is given and differs from test to
test only, so that its coefficients are scaled (``factor``). Neutral and default: exponent = 0. Default:
reference = the normal force on the column face at frictionless rest, or the oscillator's own, not fitted.
"""

from collections.abc import Mapping
from math import nan

import numpy as np

from wedgesweep.compiled import term
from wedgesweep.effects.base import NUMERICAL, Effect
from wedgesweep.quantity import Quantity

EQUATIONS = ("mu -> mu (|N|/reference)^(-exponent)",)

EFFECT = Effect(
    name="load_dependent_friction",
    family="friction-law",
    branch=NUMERICAL,
    meaning="coefficients of friction that depend on the normal force",
    quantities=(
        Quantity(
            "exponent",
            0.0,
            "power by which the coefficients fall with load",
            minimum=-1.0,
            below=1.0,
            search=(-0.5, 0.6),
        ),
        Quantity(
            "reference_N",
            0.0,
            "normal force at which the coefficients are the nominal ones; 0: the column face's at rest, or "
            "an oscillator's",
            minimum=0.0,
        ),
    ),
    extends=("exponent",),
)


# A normal force is kept this far off zero (N).
LEAST_LOAD = 1e-30


@term("load_dependent_friction", off="False")
def acts(p):
    """Whether friction depends on the load."""
    return p.load_dependent_friction.exponent != 0.0


@term("load_dependent_friction", off="0.0")
def exponent(p):
    """Power by which the coefficients fall with load."""
    return p.load_dependent_friction.exponent


@term("load_dependent_friction", off="mu")
def coefficient(mu, normal, p):
    """T/N of a face at a normal force (N) of either sign."""
    if not acts(p):
        return mu
    load = max(abs(normal), LEAST_LOAD)
    return mu * (load / p.load_dependent_friction.reference) ** (-p.load_dependent_friction.exponent)


def factor(numbers: Mapping[str, float], normal: float, nominal: float) -> float:
    """Factor of the coefficients of an oscillator under a normal force (N), by the effect's numbers (SI)."""
    reference = numbers.get("reference", 0.0) or nominal
    if normal <= 0.0 or reference <= 0.0:
        return 1.0
    return float((normal / reference) ** -numbers.get("exponent", 0.0))


def bound(mu: float, p: np.void) -> float:
    """Largest coefficient: none is known, as it may grow without end towards lift-off."""
    return nan if p["load_dependent_friction"]["exponent"] != 0.0 else mu
