"""Where a run is, and how it got there."""

from typing import Any, NamedTuple

# How a run may end; an event has a number from 0 up, and in its place a mode may end in one of the last
# three.
OK, NO_EVENT, LOCKED, FAILED, CHATTERING = 0, -1, -2, -3, -4


class State(NamedTuple):
    """Time (s), state vector, mode, the event that led to it (NO_EVENT: none), and the next step to try (s)."""

    t: float
    y: Any
    mode: Any
    last_event: int
    step: float
