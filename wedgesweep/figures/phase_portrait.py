"""Steady motion in the plane of displacement and velocity, a panel per case."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from wedgesweep.figures import cases, labels, style, validity
from wedgesweep.figures.panels import Panels, Target, panels

NAME = "phase-portrait"
DESCRIPTION = "velocity over displacement of several cases, stuck parts marked"
NEEDS = ("displacement", "velocity", "stuck", "stick_fraction", "omega_n")
CASE_LISTS = True

AMPLITUDES = 3
MOST_PANELS = 12
STILL = 1e-6  # peak-to-peak over input amplitude, below which nothing moves


def _from_grid(ds: xr.Dataset, beta: float | None, amplitudes: ArrayLike | None) -> list[xr.Dataset]:
    """Take cases row by row: an amplitude per row, a law per column."""
    ds = ds.isel(beta=_default(ds) if beta is None else cases.nearest(ds["beta"], beta)[0])
    ds = ds.isel(amplitude=cases.pick_amplitudes(ds, amplitudes, AMPLITUDES))
    return [
        ds.isel(amplitude=place).sel(friction_law=name)
        for place in range(ds.sizes["amplitude"])
        for name in cases.laws(ds)
    ]


def _default(ds: xr.Dataset) -> int:
    """Index of the beta nearest to 0.4, of those at which something slips."""
    distance = np.abs(ds["beta"].values - 0.4)
    slips = (ds["stick_fraction"] < cases.SLIPS).any(("friction_law", "amplitude")).values
    return int(np.where(slips | ~slips.any(), distance, np.inf).argmin())


def _from_list(ds: xr.Dataset, beta: float | None, amplitudes: ArrayLike | None) -> list[xr.Dataset]:
    """Keep the cases of a list that have the nearest values of what is asked for."""
    keep = np.ones(ds.sizes["case"], bool)
    for name, wanted in (("beta", beta), ("amplitude", amplitudes)):
        values = ds[name].values
        if wanted is not None:
            keep &= np.isin(values, values[cases.nearest(ds[name], wanted)])
    return [ds.isel(case=place) for place in np.flatnonzero(keep)]


def _size(case: xr.Dataset) -> float:
    """Size (mm) that a motion is compared with: the input amplitude, 1 mm under a force."""
    return 1.0 if labels.of(case).forced else case["amplitude"].item() * style.MM


def _draw_still(ax: Axes, case: xr.Dataset, omega_n: float) -> None:
    """Give a case that does not move, or has no result, axes of the size of its input."""
    reach = np.array([-1.0, 1.0]) * _size(case)
    middle = np.nan_to_num(case["displacement"].values[0] * style.MM)
    ax.set(xlim=middle + reach, ylim=reach * case["beta"].item() * omega_n)
    note = "no result" if np.isnan(case["displacement"]).all() else "no motion"
    ax.text(0.5, 0.6, note, transform=ax.transAxes, ha="center", fontsize=8, color=style.GREY)


def _draw_case(ax: Axes, case: xr.Dataset, omega_n: float) -> None:
    law, amplitude = case["friction_law"].item(), case["amplitude"].item()
    x, v = case["displacement"].values * style.MM, case["velocity"].values * style.MM
    ax.plot(x, v, color=style.law_style(law)["color"], linewidth=1.2, zorder=2)
    for color, marked in validity.marked_samples(case).items():
        ax.plot(x[marked], v[marked], "o", color=color, markersize=7, markeredgewidth=0, zorder=1)
    # Written so that NaN counts as still.
    if not np.ptp(x) > STILL * _size(case):
        _draw_still(ax, case, omega_n)
    ax.locator_params(nbins=5)
    frequency = style.frequency(case["beta"].item(), omega_n)
    ax.set_title(
        f"{law}, {labels.of(case).size(amplitude, 3)}\n{frequency}{validity.remark(case)}", fontsize=9
    )


def draw(
    target: Target, ds: xr.Dataset, beta: float | None = None, amplitudes: ArrayLike | None = None
) -> Panels:
    """Draw the nearest beta (default 0.4 on a grid) and amplitudes (m), or a list of cases."""
    choose = _from_list if "case" in ds.dims else _from_grid
    found = choose(ds, beta, amplitudes)
    if not found:
        raise ValueError("no case of the dataset has this beta and amplitude together")
    shown = found[:MOST_PANELS]
    columns = 3 if "case" in ds.dims else len(cases.laws(ds))
    made = panels(target, len(shown), columns=columns, size=(2.9, 2.5), share=False)
    for ax, case in zip(made.axes, shown, strict=True):
        _draw_case(ax, case, ds.attrs["omega_n"])
    words = labels.of(ds)
    style.label(made.axes, words.displacement, words.velocity, columns)
    left_out = f"; first {len(shown)} of {len(found)} cases" if len(found) > len(shown) else ""
    made.title(
        f"Phase portraits; yellow: {labels.sticking(cases.laws(ds))}{validity.note_of_open(ds)}{left_out}",
        words.sign,
    )
    return made
