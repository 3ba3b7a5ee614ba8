"""The suspension's own methods beside those of all systems: rest in closed form, and power series."""

from wedgesweep.compiled import inlined
from wedgesweep.hybrid import interface
from wedgesweep.hybrid.interface import implement
from wedgesweep.hybrid.state import NO_EVENT
from wedgesweep.systems.suspension.modes import stuck
from wedgesweep.systems.suspension.series_slip import follow_series, has_series
from wedgesweep.systems.suspension.sticking import follow_stuck


@implement(interface.follow, "suspension")
@inlined
def follow(state, stop, p, keeping, recorder, work):
    """See the interface."""
    if stuck(state.mode, p):
        return follow_stuck(state, stop, p, keeping, recorder, work)
    if has_series(state.mode, p):
        return follow_series(state, stop, p, keeping, recorder, work)
    return False, state, NO_EVENT
