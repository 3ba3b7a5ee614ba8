"""Where a run is, and how it got there."""

from typing import Any, NamedTuple

# How a run ends. A mode ends with the number of an event, from 0 up, or with one of the numbers below 0.
# HANDED_OVER: another system goes on (see period_map.run_case).
OK, NO_EVENT, LOCKED, FAILED, CHATTERING, HANDED_OVER = 0, -1, -2, -3, -4, -5


class State(NamedTuple):
    """Time (s), state vector, mode, the event that led to it or NO_EVENT, and the next step to try (s)."""

    t: float
    y: Any
    mode: Any
    last_event: Any
    step: float
