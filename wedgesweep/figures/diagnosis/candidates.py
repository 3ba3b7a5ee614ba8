"""How well each candidate explains the tests, the best first."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from wedgesweep.diagnosis_result import NO_BETTER, DiagnosisResult
from wedgesweep.figures import style
from wedgesweep.figures.panels import Panels, Target, panels

NAME = "candidates"
DESCRIPTION = "penalised misfit of every candidate, the best first"

MOST_ROWS = 20
TIED = "0.88"  # grey of the range in which candidates are tied


def shown(result: DiagnosisResult) -> list[dict[str, Any]]:
    """Return the best candidates that were fitted, and the base model wherever it stands."""
    fitted = [
        each
        for each in result.document["candidates"]
        if each["penalised"] is not None and each["status"] != NO_BETTER
    ]
    return [each for place, each in enumerate(fitted) if place < MOST_ROWS or not each["effects"]]


def _mark(candidate: dict[str, Any], least: float) -> dict[str, Any]:
    adequate = candidate["p"] is not None and candidate["p"] >= least
    color = style.BLUE if candidate["effects"] else style.VERMILLION
    return {"color": color, "markerfacecolor": color if adequate else "white", "marker": "o"}


def _name(candidate: dict[str, Any]) -> str:
    name = " + ".join(candidate["effects"]) or "base model"
    return name if candidate["status"] == "fitted" else f"{name} ({candidate['status']})"


def _draw_rows(ax: Axes, rows: list[dict[str, Any]], behind: np.ndarray, least: float) -> None:
    for place, (each, value) in enumerate(zip(rows, behind, strict=True)):
        ax.plot([0.0, value], [place, place], color="0.75", linewidth=1.0, zorder=1)
        ax.plot(value, place, markersize=6, markeredgewidth=1.4, zorder=2, **_mark(each, least))
    ax.set_yticks(range(len(rows)), [_name(each) for each in rows])
    ax.set_ylim(len(rows) - 0.4, -0.6)


def draw(target: Target, result: DiagnosisResult) -> Panels:
    """Draw how far each candidate's penalised misfit is behind the best; linear up to 10, then logarithmic.

    To see: candidates in the grey range are tied with the best. A filled mark means that the candidate leaves
    no more than noise may leave, an open one that it leaves a misfit, however good its rank.
    """
    rows = shown(result)
    if not rows:
        raise ValueError("no candidate could be fitted")
    gap, least = (result.document["method"][key] for key in ("gap", "adequate_p"))
    behind = np.array([each["penalised"] for each in rows]) - min(each["penalised"] for each in rows)
    made = panels(target, 1, size=(6.2, 1.1 + 0.24 * len(rows)), margin=(0.8, 0.8))
    ax = made.axes[0]
    ax.axvspan(-0.05 * gap, gap, color=TIED, linewidth=0)
    _draw_rows(ax, rows, behind, least)
    ax.set_xscale("symlog", linthresh=gap)
    ax.set_xlim(-0.05 * gap, max(1.6 * behind.max(), 3.0 * gap))
    style.label([ax], "penalised misfit behind the best [1]", "")
    _legend(made, gap)
    left_out = len(result.document["candidates"]) - len(rows)
    note = f"{left_out} more {'is' if left_out == 1 else 'are'} not shown (worse, or not fitted)"
    made.title("Candidates by penalised misfit, the best first", note if left_out else "")
    return made


def _legend(made: Panels, gap: float) -> None:
    mark: dict[str, Any] = {"marker": "o", "linestyle": "none", "color": style.BLUE}
    handles = [
        Line2D([], [], color=TIED, linewidth=8),
        Line2D([], [], **mark),
        Line2D([], [], markerfacecolor="white", markeredgewidth=1.4, **mark),
    ]
    made.legend(handles, [f"tied with the best (within {gap:g})", "leaves only noise", "leaves a misfit"])
