"""Share of the period near rest, measured and simulated: the plateaus of stick-slip."""

import numpy as np

from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.figures import style
from wedgesweep.figures.diagnosis import marks, rows
from wedgesweep.figures.panels import Panels, Target

NAME = "plateaus"
DESCRIPTION = "share of the period near zero velocity, measured and simulated"
TESTS = "steady"

# A sine stays below 5 % of its peak for this share of its period.
SINE = 2.0 * np.arcsin(0.05) / np.pi


def draw(target: Target, result: DiagnosisResult) -> Panels:
    """Draw the share of the period in which velocity stays below 5 % of its peak, a row per test.

    To see: tests far right of the dotted line, which is a sine's share, stick for part of the period. Where
    the measured dot is right of the base model's cross, the bench sticks and the simulation slips.
    """
    order = rows.known(result, "plateau")
    made = rows.make_panels(target, result, order, 1)
    ax = made.axes[0]
    ax.axvline(100.0 * SINE, color=style.GREY, linewidth=1.0, linestyle=":")
    place = {"textcoords": "offset points", "va": "bottom", "color": style.GREY}
    ax.annotate("sine", (100.0 * SINE, 0.0), (3, 2), xycoords=("data", "axes fraction"), fontsize=8, **place)
    rows.draw_values(ax, result, order, "plateau", 100.0)
    ax.set_xlim(left=0.0)
    ax.set_xlabel("share of the period near zero velocity [%]", fontsize=9)
    marks.legend(made, result, dots=True)
    made.title("Plateaus: share of the period below 5 % of the peak velocity")
    return made
