"""Functions of the interface of hybrid systems that are the same for all systems here."""

from wedgesweep import excitation
from wedgesweep.compiled import inlined
from wedgesweep.effects import states, stray_vibration
from wedgesweep.hybrid import interface


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
