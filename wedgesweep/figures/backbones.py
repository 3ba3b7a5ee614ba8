"""Two panels, frequency and damping ratio over amplitude, with the backbones of some decays."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes

from wedgesweep import backbone
from wedgesweep.figures import style
from wedgesweep.figures.panels import Panels, Target, panels

READING = "lines: analytic signal; dots: turning points; bands and bars: noise (2 std)"
# Standard deviations that bands and bars show.
WIDE = 2.0


class Motion(NamedTuple):
    """A decay, its label and its colour; samples (n,) over an even time (s), in the unit of the axis."""

    name: str
    color: Any
    time: np.ndarray
    signal: np.ndarray


def draw(target: Target, motions: Sequence[Motion], label: str) -> Panels:
    """Draw the backbones of motions, over an axis with this label.

    Raises ValueError if none of them has a backbone.
    """
    made = panels(target, 2, columns=2, size=(3.9, 3.4), share=False)
    faults = [fault for motion in motions if (fault := _draw_motion(made.axes, motion))]
    if len(faults) == len(motions):
        raise ValueError(faults[0])
    for ax, name in zip(made.axes, ("frequency [Hz]", "damping ratio [1]"), strict=True):
        ax.set_xscale("log")
        style.log_ticks(ax.xaxis)
        ax.set_xlabel(label, fontsize=9)
        ax.set_ylabel(name, fontsize=9)
    made.axes[1].set_yscale("log")
    style.log_ticks(made.axes[1].yaxis)
    made.legend()
    return made


def _draw_motion(axes: Sequence[Axes], motion: Motion) -> str:
    """Draw both backbones of a motion; return why it has none, if so."""
    noise = backbone.noise_std(motion.signal)
    try:
        turns = backbone.turning_points(motion.time, motion.signal, noise)
    except ValueError as error:
        return f"{motion.name} {error}"
    points = backbone.from_turning_points(turns)
    lines = backbone.from_analytic_signal(motion.time, motion.signal, noise, turns)
    look = {"color": motion.color}
    for ax, which in zip(axes, ("frequency", "damping"), strict=True):
        (y, std), (line, line_std) = (
            (getattr(each, which), WIDE * getattr(each, f"{which}_std")) for each in (points, lines)
        )
        ax.errorbar(
            points.amplitude, y, std, fmt="o", markersize=3, elinewidth=0.8, label=motion.name, **look
        )
        ax.plot(lines.amplitude, line, linewidth=1.2, **look)
        ax.fill_between(lines.amplitude, line - line_std, line + line_std, alpha=0.25, linewidth=0.0, **look)
    return ""
