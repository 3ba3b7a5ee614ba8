"""Constant dry friction between the bolster and its lateral guide, which moves with the side frame.

It is set-valued at rest under the Coulomb law.
Neutral and default: force = 0. With frictionless wedges this is Den Hartog's oscillator (1930).
"""

from wedgesweep.compiled import inlined
from wedgesweep.effects.base import EXPERIMENTAL, Effect
from wedgesweep.quantity import Quantity

EQUATIONS = ("R = -force sign(v_z)",)
REMARK = "Under the regularised laws $R = -force v_z/v_t$ for $|v_z| <= v_t$."

EFFECT = Effect(
    name="guide_friction",
    family="missing-force",
    branch=EXPERIMENTAL,
    meaning="constant dry friction on the {mass} from {guide}",
    quantities=(Quantity("force_N", 0.0, "friction force of the guide", minimum=0.0, search=(0.0, 10.0)),),
)


@inlined
def acts(p):
    """Whether the guide rubs."""
    return p.guide_friction.force > 0.0


@inlined
def force(velocity, branch, p):
    """Force on the bolster (N, up positive) at z' = ``velocity`` on the given slip branch."""
    if branch == 0 and not p.friction.set_valued:
        return -p.guide_friction.force / p.friction.v_t * velocity
    return -p.guide_friction.force * branch
