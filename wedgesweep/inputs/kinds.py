"""The kinds of inputs that do not repeat; those of a few lines are here."""

from collections.abc import Mapping
from math import pi
from typing import Any

import numpy as np

from wedgesweep.inputs import random, record, sine_sweep
from wedgesweep.inputs.sampled import Input


def _ramp(given: Mapping[str, Any], natural: float) -> Input:
    """A base at a constant velocity, such as the end of a spring that is pulled."""
    duration = given["duration_s"]
    ends = np.array([0.0, given["velocity_mm_per_s"] * 1e-3 * duration])
    return Input("displacement", ends, duration, natural / (2.0 * pi))


def _release(given: Mapping[str, Any], natural: float) -> Input:
    """No input: the mass is released from a displacement, with a velocity."""
    start = (given["displacement_mm"] * 1e-3, given["velocity_mm_per_s"] * 1e-3)
    return Input("displacement", np.zeros(2), given["duration_s"], natural / (2.0 * pi), start)


MADE = {
    "sine-sweep": sine_sweep.made,
    "random": random.made,
    "ramp": _ramp,
    "record": record.made,
    "release": _release,
}


def made(given: Mapping[str, Any], natural: float) -> Input:
    """The input of a table [input], for a model of a natural frequency (rad/s).

    Raises ConfigError if a recording cannot be read.
    """
    return MADE[given["kind"]](given, natural)
