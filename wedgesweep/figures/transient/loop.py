"""Force over displacement: the largest cycle is marked, with the energy that it encloses."""

from itertools import pairwise

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from wedgesweep.figures import cases, labels, style, validity
from wedgesweep.figures.panels import Panels, Target, per_law

NAME = "loop"
DESCRIPTION = "restoring force over displacement, with the area of the largest cycle in J, a panel per law"
NEEDS = ("displacement", "force", "time", "scale")


def area(displacement: np.ndarray, force: np.ndarray) -> float:
    """Energy (J) that a cycle encloses, its ends joined."""
    x, f = np.append(displacement, displacement[0]), np.append(force, force[0])
    return float(np.sum(0.5 * (f[1:] + f[:-1]) * np.diff(x)))


def largest_cycle(x: np.ndarray) -> slice | None:
    """The cycle of the largest peak-to-peak between two upward zero crossings; None without a whole one."""
    starts = cases.rising(x)
    if starts.size < 2:
        return None
    spans = [np.ptp(x[a:b]) for a, b in pairwise(starts)]
    place = int(np.argmax(spans))
    return slice(int(starts[place]), int(starts[place + 1]) + 1)


def _draw_loop(ax: Axes, case: xr.Dataset, color: str) -> None:
    x, force = case["displacement"].values, case["force"].values
    ax.plot(x * style.MM, force, color=style.GREY, linewidth=0.5, alpha=0.6)
    marked = "no whole cycle"
    if np.isfinite(x).all() and (cycle := largest_cycle(x)) is not None:
        ax.fill(x[cycle] * style.MM, force[cycle], color=color, alpha=0.15)
        ax.plot(x[cycle] * style.MM, force[cycle], color=color, linewidth=1.4)
        marked = f"marked cycle: {area(x[cycle], force[cycle]):.3g} J"
    whole = f"in all: {case['dissipated_energy'].item():.3g} J"
    ax.text(0.03, 0.97, f"{marked}\n{whole}", transform=ax.transAxes, fontsize=8, va="top")


def draw(target: Target, ds: xr.Dataset, scale: float | None = None) -> Panels:
    """Draw a panel per law at a scale, by default the largest."""
    chosen = cases.one_scale(ds, scale)
    made, parts = per_law(target, chosen)
    for ax, law, case in parts:
        _draw_loop(ax, case, style.law_style(law)["color"])
        ax.set_title(f"{law}{validity.remark(case)}", fontsize=10)
        ax.margins(y=0.12)
    style.label(made.axes, labels.of(ds).displacement, "restoring force [N]")
    made.title(f"Force over displacement at scale {chosen['scale'].item():.3g}", labels.of(ds).sign)
    return made
