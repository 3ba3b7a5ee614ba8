"""Dry friction between the bolster and its lateral guide, which moves with the side frame.

    R = -force sign(z')           on the bolster, force constant

set-valued at z' = 0 under the Coulomb law; under the regularised laws R = -force z'/v_t inside |z'| <= v_t.
Neutral and default: force = 0. With frictionless wedges this is Den Hartog's oscillator (1930).
"""

from wedgesweep.compiled import compiled, inlined
from wedgesweep.effects.base import EXPERIMENTAL, Effect
from wedgesweep.quantity import Quantity

EFFECT = Effect(
    name="guide_friction",
    family="missing-force",
    branch=EXPERIMENTAL,
    meaning="constant dry friction on the bolster from its lateral guide",
    quantities=(Quantity("force_N", 0.0, "friction force of the guide", minimum=0.0, search=(0.0, 10.0)),),
)


@inlined
def force(velocity, branch, p):
    """Force on the bolster (N, up positive) at z' = ``velocity`` on the given slip branch."""
    if branch == 0 and not p.set_valued:
        return -p.guide_friction_force * velocity / p.threshold_velocity
    return -p.guide_friction_force * branch


@compiled
def slope(branch, p):
    """Derivative of ``force`` with respect to z' (N s/m)."""
    if branch == 0 and not p.set_valued:
        return -p.guide_friction_force / p.threshold_velocity
    return 0.0
