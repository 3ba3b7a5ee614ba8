"""How well each candidate explains the tests, the best first."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from wedgesweep.diagnosed import NO_BETTER, Diagnosed
from wedgesweep.figures import style

NAME = "candidates"
DESCRIPTION = "penalised misfit of every candidate, the best first"

MOST = 20


def shown(found: Diagnosed) -> list[dict[str, Any]]:
    """Return the best candidates that were fitted, and the base model wherever it stands."""
    fitted = [
        each
        for each in found.document["candidates"]
        if each["penalised"] is not None and each["status"] != NO_BETTER
    ]
    return [each for place, each in enumerate(fitted) if place < MOST or not each["effects"]]


def _look(each: dict[str, Any], least: float) -> dict[str, Any]:
    adequate = each["p"] is not None and each["p"] >= least
    color = style.VERMILLION if not each["effects"] else style.BLUE
    return {"color": color, "markerfacecolor": color if adequate else "white", "marker": "o"}


def _name(each: dict[str, Any]) -> str:
    name = " + ".join(each["effects"]) or "base model"
    return name if each["status"] == "fitted" else f"{name} ({each['status']})"


def draw(found: Diagnosed) -> Figure:
    """Draw how far each candidate's penalised misfit is behind the best; linear up to 10, then logarithmic.

    To see: in the grey zone candidates are tied with the best. Filled: what it leaves may be noise (p
    high enough for a name); open: it leaves misfit that noise hardly explains, however good its rank.
    """
    rows = shown(found)
    if not rows:
        message = f"{NAME}: no candidate could be fitted"
        raise ValueError(message)
    gap, least = (found.document["method"][key] for key in ("gap", "adequate_p"))
    behind = np.array([each["penalised"] for each in rows]) - min(each["penalised"] for each in rows)
    figure, (ax,) = style.panels(1, size=(6.2, 1.1 + 0.24 * len(rows)), margin=(0.8, 0.8))
    ax.axvspan(-0.05 * gap, gap, color="0.88", linewidth=0, label="tied with the best")
    for place, (each, value) in enumerate(zip(rows, behind, strict=True)):
        ax.plot([0.0, value], [place, place], color="0.75", linewidth=1.0, zorder=1)
        ax.plot(value, place, markersize=6, markeredgewidth=1.4, zorder=2, **_look(each, least))
    ax.set_xscale("symlog", linthresh=gap)
    ax.set_xlim(-0.05 * gap, max(1.6 * behind.max(), 3.0 * gap))
    ax.set_yticks(range(len(rows)), [_name(each) for each in rows])
    ax.set_ylim(len(rows) - 0.4, -0.6)
    style.label([ax], "penalised misfit behind the best [1]", "")
    round_mark = {"marker": "o", "linestyle": "none", "color": style.BLUE}
    handles = [
        Line2D([], [], color="0.88", linewidth=8),
        Line2D([], [], **round_mark),
        Line2D([], [], markerfacecolor="white", markeredgewidth=1.4, **round_mark),
    ]
    words = [f"tied with the best (within {gap:g})", "leaves noise only", "leaves misfit"]
    figure.legend(handles, words, loc="outside lower center", ncols=3, fontsize=9, frameon=False)
    behind_rows = len(found.document["candidates"]) - len(rows)
    style.title(
        figure,
        "Candidates by penalised misfit, the best first",
        f"{behind_rows} more are not shown (worse, or not fitted)" if behind_rows else "",
    )
    return figure
