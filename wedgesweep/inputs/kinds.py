"""The kinds of inputs that do not repeat."""

from collections.abc import Mapping
from typing import Any

from wedgesweep.inputs import ramp, random, record, release, sine_sweep
from wedgesweep.inputs.sampled import Input

MADE = {
    "sine-sweep": sine_sweep.made,
    "random": random.made,
    "ramp": ramp.made,
    "record": record.made,
    "release": release.made,
}


def made(given: Mapping[str, Any], natural: float) -> Input:
    """The input of a table [input], for a model of a natural frequency (rad/s).

    Raises ConfigError if a recording cannot be read.
    """
    return MADE[given["kind"]](given, natural)
