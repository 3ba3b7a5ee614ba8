"""The response and its envelope: over the frequency of a sine sweep, else over time."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from wedgesweep.figures import cases, labels, style, validity
from wedgesweep.figures.panels import Panels, Target, per_law

NAME = "envelope"
DESCRIPTION = "response with its envelope, over frequency (sine sweep) or time, a panel per law"
NEEDS = ("displacement", "time", "scale")

COUNT = 3


def _draw_case(ax: Axes, place: np.ndarray, case: xr.Dataset, color: str, label: str) -> None:
    """Draw a response, pale, between its envelopes: lines through its highest and lowest points."""
    x = case["displacement"].values * style.MM
    ax.plot(place, x, color=color, linewidth=0.4, alpha=0.35)
    if not np.isfinite(x).all():
        return
    turns = cases.extremes(x)
    middle = x.mean()
    for side, name in ((1.0, label), (-1.0, None)):
        at = turns[side * (x[turns] - middle) > 0.0]
        ax.plot(place[at], x[at], color=color, linewidth=1.3, label=name)


def draw(target: Target, ds: xr.Dataset, scale: float | None = None) -> Panels:
    """Draw a panel per law, with the response at a few scales, or at the nearest one."""
    swept = "input_frequency" in ds.coords
    place = (ds["input_frequency"] if swept else ds["time"]).values
    places = cases.spread(np.arange(ds.sizes["scale"]), COUNT)
    if scale is not None:
        places = cases.nearest(ds["scale"], scale)
    colors = style.SEQUENTIAL(np.linspace(0.0, 0.85, len(places)))
    made, parts = per_law(target, ds)
    for ax, _, law in parts:
        # Large responses first, so that small ones stay visible.
        for number in reversed(range(len(places))):
            case = law.isel(scale=places[number])
            _draw_case(ax, place, case, colors[number], f"scale {case['scale'].item():.3g}")
        ax.set_xlim(min(place[0], place[-1]), max(place[0], place[-1]))
    label = "frequency of the input [Hz]" if swept else "time [s]"
    style.label(made.axes, label, labels.of(ds).displacement)
    handles, names = made.axes[0].get_legend_handles_labels()
    made.legend(handles[::-1], names[::-1], columns=COUNT)
    made.title("Response and its envelope", labels.of(ds).sign, validity.shares(ds))
    return made
