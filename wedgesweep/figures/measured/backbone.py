"""Backbones of measured ring-downs."""

import numpy as np

from wedgesweep.figures import backbones, style
from wedgesweep.figures.panels import Panels, Target
from wedgesweep.measured import Measurement
from wedgesweep.measured.kinds import DISPLAY_UNITS

NAME = "backbone"
DESCRIPTION = "frequency and damping ratio over amplitude of each ring-down, with bands of its noise"


def draw(target: Target, measurement: Measurement) -> Panels:
    """Draw the backbone of the first response of every transient without an input."""
    free = [test for test in measurement.tests if test.kind == "transient" and test.input is None]
    if not free:
        raise ValueError('there is no ring-down: no test of kind = "transient" without an input')
    channel = next(iter(free[0].responses))
    size, unit = DISPLAY_UNITS[channel]
    colors = style.SEQUENTIAL(np.linspace(0.0, 1.0, len(free)))
    motions = [
        backbones.Motion(test.name, color, test.time, test.responses[channel] / size)
        for test, color in zip(free, colors, strict=True)
    ]
    made = backbones.draw(target, motions, f"amplitude of {channel} [{unit}]")
    made.title("Backbones of ring-downs", backbones.READING)
    return made
