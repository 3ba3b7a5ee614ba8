"""Cases whose numbers are to be read with care, and their marks: hollow or grey."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from wedgesweep import formatting
from wedgesweep.figures import style
from wedgesweep.outcome import OPENS, lifted, unsettled

# Hollow: lift-off; grey: unsettled; a grey ring: both.
POINT = {"linestyle": "", "marker": "o", "markersize": 4.5, "zorder": 4}
HOLLOW: dict[str, Any] = {**POINT, "markerfacecolor": "white"}
PALE: dict[str, Any] = {**POINT, "color": "0.6"}
FEW_POINTS = 25


def opened(ds: xr.Dataset) -> xr.DataArray | None:
    """Whether a contact is open at each phase; None without waveforms, or where joints are held."""
    faces = ("normal_force_column", "normal_force_bolster")
    if OPENS not in ds or any(name not in ds for name in faces):
        return None
    return (ds[faces[0]] == 0.0) | (ds[faces[1]] == 0.0)


def marked_samples(case: xr.Dataset) -> dict[str, np.ndarray]:
    """Samples of a case at which it sticks, and at which a contact is open, by the colour that marks them."""
    found, opens = {style.STUCK: case["stuck"].values == 1}, opened(case)
    return found if opens is None else found | {style.OPEN: opens.values}


def note_of_open(ds: xr.Dataset) -> str:
    """What the colour of open contacts means, to go on with; empty where joints are held."""
    return "" if opened(ds) is None else "; blue: a contact is open"


def mark(ax: Axes, x: np.ndarray, y: np.ndarray, case: xr.Dataset, color: str) -> None:
    """Mark the points of a line of cases: hollow where a joint lifts off, grey where unsettled."""
    size = {} if len(x) <= FEW_POINTS else {"markersize": 2.8, "markeredgewidth": 0.7}
    hollow, grey = lifted(case).values, unsettled(case).values
    for at, look in (
        (hollow & ~grey, {**HOLLOW, "color": color}),
        (grey & ~hollow, PALE),
        (hollow & grey, {**PALE, **HOLLOW}),
    ):
        if at.any():
            ax.plot(x[at], y[at], **{**look, **size})


def shares(ds: xr.Dataset) -> str:
    """How many of the cases lift off and are unsettled, in words; empty if none does."""
    parts = [
        f"{int(marked.sum())} of {formatting.counted(marked.size, 'case')} {words}"
        for marked, words in (
            (lifted(ds), "with lift-off, outside of the model's validity"),
            (unsettled(ds), "did not settle"),
        )
        if marked.any()
    ]
    return "; ".join(parts)


def handles(ds: xr.Dataset) -> list[Line2D]:
    """Entries of a legend for the marks that are there."""
    found = []
    if lifted(ds).any():
        found.append(Line2D([], [], **{**HOLLOW, "color": "0.2"}, label="lift-off: outside of validity"))
    if unsettled(ds).any():
        found.append(Line2D([], [], **PALE, label="not settled"))
    if (lifted(ds) & unsettled(ds)).any():
        found.append(Line2D([], [], **{**PALE, **HOLLOW}, label="both"))
    return found


def remark(case: xr.Dataset) -> str:
    """What is to be known of a single case, in brackets; empty if nothing is."""
    parts = [
        words
        for marked, words in ((lifted(case), "lifts off"), (unsettled(case), "not settled"))
        if marked.item()
    ]
    return f" ({', '.join(parts)})" if parts else ""
