"""State of a run, and the ways in which following a mode can end."""

from typing import Any, NamedTuple

# A run ends with OK or one of LOCKED to CHATTERING; a mode with the number of an event, from 0 up, or with a
# number below 0.
OK, NO_EVENT, LOCKED, FAILED, CHATTERING = 0, -1, -2, -3, -4


class State(NamedTuple):
    """Time (s), state vector, mode, the event that led to it or NO_EVENT, and the next step to try (s)."""

    t: float
    y: Any
    mode: Any
    last_event: Any
    step: float
