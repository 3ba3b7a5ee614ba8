"""A base that moves at a constant velocity, such as the end of a spring that is pulled."""

from collections.abc import Mapping
from math import pi
from typing import Any

import numpy as np

from wedgesweep.inputs.sampled import Input


def made(given: Mapping[str, Any], natural: float) -> Input:
    """The input of a table [input]."""
    duration = given["duration_s"]
    ends = np.array([0.0, given["velocity_mm_per_s"] * 1e-3 * duration])
    return Input("displacement", ends, duration, natural / (2.0 * pi))
