"""No input: the mass is released from a displacement, with a velocity."""

from collections.abc import Mapping
from math import pi
from typing import Any

import numpy as np

from wedgesweep.inputs.sampled import Input


def made(given: Mapping[str, Any], natural: float) -> Input:
    """The input of a table [input]."""
    start = (given["displacement_mm"] * 1e-3, given["velocity_mm_per_s"] * 1e-3)
    return Input("displacement", np.zeros(2), given["duration_s"], natural / (2.0 * pi), start)
