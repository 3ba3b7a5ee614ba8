"""Peak-to-peak over frequency of the suspects at their best, against what the experiment showed.

No figure of a dataset: it is drawn by ``wedgesweep reproduce`` from what it found.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from wedgesweep.figures import style

COLUMNS = 3
LEAST = 1e-3  # mm; what is below lies on the axis


def draw(
    hertz: Sequence[float],
    suspects: Sequence[Mapping[str, Any]],
    levels: Mapping[float, float],
    factor: float,
    jump_hertz: tuple[float, float],
) -> Figure:
    """Draw a panel per suspect: its sweep, its recordings, and the levels seen (mm, by frequency).

    A suspect is what chandiramani.document tells of it, None where there is no such response; ``factor`` is
    the tolerance of the levels, and the jump was seen within ``jump_hertz``.
    """
    figure, axes = style.panels(len(suspects), columns=COLUMNS, size=(3.1, 2.6))
    for ax, suspect in zip(axes, suspects, strict=True):
        ax.axvspan(*jump_hertz, color=style.YELLOW, alpha=0.35, linewidth=0)
        for frequency, level in levels.items():
            bar = [[level * (1.0 - 1.0 / factor)], [level * (factor - 1.0)]]
            ax.errorbar([frequency], [level], bar, color="black", capsize=3, linewidth=1.3)
        swept = _shown(suspect["peak_to_peak_mm"])
        ax.plot(hertz, swept, "-o", color=style.BLUE, markersize=2.5, linewidth=1.3)
        recorded = [suspect[name]["peak_to_peak"] for name in ("slow", "fast")]
        ax.plot(list(levels), _shown(recorded), "D", color=style.VERMILLION, markersize=5)
        ax.set_title(f"{suspect['words']}: {suspect['met']} of {len(suspect['distances'])}", fontsize=9)
        ax.set_yscale("log")
        style.decimal_ticks(ax.yaxis)
    style.label(axes, "frequency [Hz]", "peak-to-peak of $x-y$ [mm]", COLUMNS)
    figure.legend(handles=_key(), loc="outside lower center", ncols=4, fontsize=8, frameon=False)
    style.title(
        figure,
        "Peak-to-peak of the suspects at their best, against Chandiramani's experiment",
        "In the titles: how many of the observations each meets.",
    )
    return figure


def _shown(levels: Sequence[float | None]) -> np.ndarray:
    return np.maximum(np.array(levels, float), LEAST)


def _key() -> list[Line2D]:
    return [
        Line2D([], [], color="black", marker="_", linestyle="", label="measured level, with tolerance"),
        Line2D([], [], color=style.YELLOW, linewidth=6, alpha=0.5, label="measured jump"),
        Line2D([], [], color=style.BLUE, marker="o", markersize=3, label="sweep"),
        Line2D([], [], color=style.VERMILLION, marker="D", linestyle="", label="recording"),
    ]
