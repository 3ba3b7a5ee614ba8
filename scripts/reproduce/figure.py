"""Peak-to-peak over frequency of each hypothesis at its best, and what the experiment showed.

Drawn from chandiramani.json.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from reproduce.observations import JUMP_HERTZ, LEVEL_FACTOR, LEVELS
from wedgesweep.figures import style
from wedgesweep.figures.panels import panels

COLUMNS = 3
LEAST = 1e-3  # mm; smaller levels are drawn at this one


def draw(hertz: Sequence[float], hypotheses: Sequence[Mapping[str, Any]]) -> Figure:
    """Draw a panel per hypothesis: its sweep, its recordings and the measured levels (mm, by frequency).

    A hypothesis is an entry of chandiramani.json, with None where there is no response.
    """
    made = panels(None, len(hypotheses), columns=COLUMNS, size=(3.1, 2.6))
    for ax, hypothesis in zip(made.axes, hypotheses, strict=True):
        ax.axvspan(*JUMP_HERTZ, color=style.YELLOW, alpha=0.35, linewidth=0)
        for frequency, level in LEVELS.items():
            bar = [[level * (1.0 - 1.0 / LEVEL_FACTOR)], [level * (LEVEL_FACTOR - 1.0)]]
            ax.errorbar([frequency], [level], bar, color="black", capsize=3, linewidth=1.3)
        swept = _shown(hypothesis["peak_to_peak_mm"])
        if (swept <= LEAST).any():
            ax.axhline(LEAST, color=style.GREY, linestyle=":", linewidth=1)
            ax.text(hertz[0], 1.15 * LEAST, f"drawn here: {LEAST:g} mm or less", fontsize=7, color=style.GREY)
        ax.plot(hertz, swept, "-o", color=style.BLUE, markersize=2.5, linewidth=1.3)
        recorded = [hypothesis[name]["peak_to_peak"] for name in ("slow", "fast")]
        ax.plot(list(LEVELS), _shown(recorded), "D", color=style.VERMILLION, markersize=5)
        count = f"{hypothesis['satisfied']} of {len(hypothesis['distances'])}"
        ax.set_title(f"{hypothesis['description']}: {count}", fontsize=9)
        ax.set_yscale("log")
        style.decimal_ticks(ax.yaxis)
    style.label(made.axes, "frequency [Hz]", "peak-to-peak of $x-y$ [mm]", COLUMNS)
    handles = _handles()
    made.legend(handles, [str(handle.get_label()) for handle in handles], columns=4)
    made.title(
        "Peak-to-peak of each hypothesis at its best, and Chandiramani's measurement",
        "The titles say how many of the observations each satisfies.",
    )
    return made.figure.figure


def _shown(levels: Sequence[float | None]) -> np.ndarray:
    return np.maximum(np.array(levels, float), LEAST)


def _handles() -> list[Line2D]:
    return [
        Line2D([], [], color="black", marker="_", linestyle="", label="measured level, with tolerance"),
        Line2D([], [], color=style.YELLOW, linewidth=6, alpha=0.5, label="measured jump"),
        Line2D([], [], color=style.BLUE, marker="o", markersize=3, label="sweep"),
        Line2D([], [], color=style.VERMILLION, marker="D", linestyle="", label="recording"),
    ]
