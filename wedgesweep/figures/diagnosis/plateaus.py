"""Share of the period near rest, measured and simulated: the plateaus of stick-slip."""

import numpy as np
from matplotlib.figure import Figure

from wedgesweep.diagnosed import Diagnosed
from wedgesweep.figures import style
from wedgesweep.figures.diagnosis import look, rows

NAME = "plateaus"
DESCRIPTION = "share of the period near zero velocity, measured and simulated"

# A sine of velocity stays below 5 % of its peak for this share of its period.
SINE = 2.0 * np.arcsin(0.05) / np.pi


def draw(found: Diagnosed) -> Figure:
    """Draw the share of the period in which velocity stays below 5 % of its peak, a row per test.

    To see: dots far right of the sine's line stick part of the time. A dot right of the base model's cross:
    the bench sticks where the simulation slips.
    """
    order = rows.shown(found, "plateau")
    figure, (ax,) = rows.panels(found, order, 1)
    ax.axvline(100.0 * SINE, color=style.GREY, linewidth=1.0, linestyle=":")
    ax.annotate("sine", (100.0 * SINE, 1.0), xycoords=("data", "axes fraction"), fontsize=8, ha="center")
    rows.draw_values(ax, found, order, "plateau", 100.0)
    ax.set_xlim(left=0.0)
    ax.set_xlabel("share of the period near zero velocity [%]", fontsize=9)
    look.legend(figure, found, dots=True)
    style.title(figure, "Plateaus: share of the period below 5 % of the peak velocity")
    return figure
