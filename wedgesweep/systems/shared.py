"""Functions of the interface of hybrid systems that are the same for all systems here."""

from wedgesweep import excitation
from wedgesweep.compiled import inlined, inner
from wedgesweep.effects import states, stray_vibration
from wedgesweep.hybrid import interface
from wedgesweep.hybrid.vectors import weighted

# Phase (rad) after which a quantity that passes zero now exceeds rounding errors, and the share of a quantity
# that is no more than a rounding error.
LOOK_AHEAD, ROUNDING = 1e-8, 1e-11
# Short steps that the input needs to move a mass at rest through the effects' own states.
STEPS_FROM_REST = 4


@inner
def soon(t, y, moment, mode, p):
    """State some moments (s) later: where a run begins forces balance to within rounding errors."""
    for i in range(STEPS_FROM_REST):
        y = weighted(y, moment, (1.0,), (interface.rate(t + (i + 0.5) * moment, y, mode, p)[0],))
    return y


@inlined
def repeats(p):
    """A spurious tone has a period of its own."""
    return not stray_vibration.acts(p)


def implement_shared(owner: str) -> None:
    """Implement these functions for the records that have a field ``owner``."""
    for declared, written in (
        (interface.scales, states.scales),
        (interface.error_scales, states.error_scales),
        (interface.active, states.active),
        (interface.clocks, states.clocks),
        (interface.bristles, states.bristles),
        (interface.sliders, states.sliders),
        (interface.cycle, excitation.cycle),
        (interface.repeats, repeats),
    ):
        interface.implement(declared, owner)(written)
