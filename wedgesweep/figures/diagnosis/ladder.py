"""How accurately no effect, one, two and more explain the tests, rivals beside the best."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from wedgesweep import formatting
from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.figures import style
from wedgesweep.figures.diagnosis import marks
from wedgesweep.figures.panels import Panels, Target, panels

NAME = "ladder"
DESCRIPTION = "accuracy of the best explanations with no effect, one, two and more, and of their rivals"

COLORS = (style.VERMILLION, style.BLUE, style.GREEN, style.PURPLE)
SIZES = ("no effect", "one effect", "two effects", "more effects")
UNRESOLVED = "0.9"  # grey of what is below the noise floor
LABEL = {"facecolor": "white", "edgecolor": "none", "pad": 0.5}
# Room between the rows of one size and the next, in rows.
BETWEEN = 0.6


class Row(NamedTuple):
    """An explanation at its height; accuracies in per cent, 0 for noise alone, None for none."""

    place: float
    effects: Sequence[str]
    accuracy: float
    best: bool
    held_out: float | None

    @property
    def color(self) -> str:
        return COLORS[min(len(self.effects), len(COLORS) - 1)]


def rows_of(result: DiagnosisResult) -> list[Row]:
    """Explanations that are adequate at some accuracy, the best of each size and then its rivals."""
    rows: list[Row] = []
    for number, level in enumerate(result.document.get("ladder", [])):
        rated = [each for each in (level, *level["rivals"]) if each["accuracy"] is not None]
        for i, each in enumerate(rated):
            place = len(rows) + BETWEEN * number
            predicted = each.get("accuracy_held_out")
            held_out = None if predicted is None else 100.0 * predicted
            rows.append(
                Row(place, each["effects"], 100.0 * each["accuracy"], each is level and i == 0, held_out)
            )
    return rows


def _lines(result: DiagnosisResult) -> dict[str, tuple[float, str]]:
    """Values (per cent) at which there is a vertical line, each with its style."""
    method = result.document["method"]
    found = {
        "noise floor": (method.get("noise_floor"), "-"),
        "model error": (method.get("model_error"), "--"),
    }
    return {name: (100.0 * value, dashes) for name, (value, dashes) in found.items() if value}


def _draw_rows(ax: Axes, rows: Sequence[Row], left: float) -> None:
    for row in rows:
        noise = row.accuracy <= left
        x = left if noise else row.accuracy
        look: dict[str, Any] = {"marker": "<" if noise else "o", "markersize": 7 if row.best else 5}
        face = row.color if row.best else "white"
        ax.plot(x, row.place, color=row.color, markerfacecolor=face, clip_on=False, zorder=3, **look)
        if row.held_out is not None:
            held_out = max(row.held_out, left)
            ax.plot(held_out, row.place, zorder=2, **marks.BAR)
            x = max(x, held_out)
        text = "only noise" if noise else f"{formatting.short(row.accuracy, 2)} %"
        weight = "bold" if row.best else "normal"
        place = {"xytext": (8, 0), "textcoords": "offset points", "va": "center", "zorder": 4}
        ax.annotate(text, (x, row.place), fontsize=8, fontweight=weight, bbox=LABEL, **place)
    best = [row for row in rows if row.best]
    path = [max(row.accuracy, left) for row in best], [row.place for row in best]
    ax.plot(*path, color="0.6", linewidth=1.0, zorder=1)
    ax.set_yticks([row.place for row in rows], [" + ".join(row.effects) or "base model" for row in rows])
    ax.set_ylim(rows[-1].place + 0.6, -0.6)


def draw(target: Target, result: DiagnosisResult) -> Panels:
    """Draw the smallest relative model error with which each explanation is adequate.

    To see: filled marks are the best explanations with no effect, one, two and more, open ones their
    rivals, bars the accuracy on tests that the fit has not seen. Further left is better; below the noise
    floor differences are not resolved.
    """
    rows = rows_of(result)
    if not rows:
        raise ValueError("no explanation has an accuracy; 'wedgesweep diagnose' of this version finds it")
    lines = _lines(result)
    shown = [size for row in rows for size in (row.accuracy, row.held_out) if size and size > 0.0]
    shown += [value for value, _ in lines.values() if value > 0.0]
    left, right = 0.5 * min(shown, default=1.0), 3.0 * max(shown, default=1.0)
    made = panels(target, 1, size=(6.2, 1.1 + 0.25 * (rows[-1].place + 1.0)), margin=(0.8, 0.8))
    ax = made.axes[0]
    ax.set_xscale("log")
    ax.set_xlim(left, right)
    for name, (value, dashes) in lines.items():
        if name == "noise floor":
            ax.axvspan(left, value, color=UNRESOLVED, linewidth=0, zorder=0)
        ax.axvline(value, color="0.3", linestyle=dashes, linewidth=1.2, zorder=1)
    _draw_rows(ax, rows, left)
    style.log_ticks(ax.xaxis)
    style.label([ax], "model error that explains all tests [% of the response]", "")
    _legend(made, rows, lines)
    made.title("Accuracy of the best explanations, and of their rivals", "further left is better")
    return made


def _legend(made: Panels, rows: Sequence[Row], lines: dict[str, tuple[float, str]]) -> None:
    sizes = np.unique([min(len(row.effects), len(COLORS) - 1) for row in rows])
    mark: dict[str, Any] = {"marker": "o", "linestyle": "none"}
    handles = [Line2D([], [], color=COLORS[size], **mark) for size in sizes]
    labels = [f"best with {SIZES[size]}" for size in sizes]
    if not all(row.best for row in rows):
        handles.append(Line2D([], [], color="0.4", markerfacecolor="white", **mark))
        labels.append("rival")
    if any(row.held_out is not None for row in rows):
        handles.append(Line2D([], [], **marks.BAR))
        labels.append("on held-out tests")
    handles += [Line2D([], [], color="0.3", linestyle=dashes) for _, dashes in lines.values()]
    labels += list(lines)
    made.legend(handles, labels)
