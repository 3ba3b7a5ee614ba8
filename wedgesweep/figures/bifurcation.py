"""Poincare samples: the displacement once per forcing period, over frequency."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from wedgesweep.figures import cases, labels, style, validity
from wedgesweep.figures.panels import Panels, Target, per_law

NAME = "bifurcation"
DESCRIPTION = "Poincare samples over frequency at one amplitude, of 20 frequencies or more"
NEEDS = ("displacement", "omega_n")

FEWEST_BETAS, FEW_BETAS = 20, 60


def poincare_samples(ds: xr.Dataset) -> np.ndarray:
    """Take the displacement (m) at forcing phase 0, the kept periods along the last axis."""
    return ds["displacement"].transpose(..., "phase").values[..., :: cases.samples_per_period(ds)]


def _half_swing(law: xr.Dataset) -> np.ndarray:
    """Half the largest peak-to-peak (m) of any law at each beta, NaN where nothing moves; shape (betas,)."""
    waves = law["displacement"]
    swing = 0.5 * (waves.max("phase") - waves.min("phase"))
    largest = swing.max([name for name in swing.dims if name != "beta"]).values
    return np.where(largest > 0.0, largest, np.nan)


def _hatch_lifted(ax: Axes, law: xr.Dataset) -> None:
    """Hatch the frequencies at which a joint lifts off."""
    beta = law["beta"].values
    middles = 0.5 * (beta[1:] + beta[:-1])
    ends = np.concatenate([[beta[0]], middles, [beta[-1]]])
    for place in np.flatnonzero(validity.lifted(law).values):
        ax.axvspan(
            ends[place],
            ends[place + 1],
            facecolor="none",
            edgecolor="0.85",
            hatch="///",
            linewidth=0,
            zorder=0,
        )


def _draw_law(ax: Axes, law: xr.Dataset, scale: np.ndarray) -> bool:
    middle = 0.5 * (law["displacement"].max("phase") + law["displacement"].min("phase"))
    samples = (poincare_samples(law) - middle.values[:, None]) / scale[:, None]
    periods = samples.shape[-1]
    largest = 7.5 if law.sizes["beta"] <= FEW_BETAS else 3.5
    grey = validity.unsettled(law).values
    _hatch_lifted(ax, law)
    for period, values in enumerate(samples.T):
        # Rings that shrink from period to period keep coinciding samples visible.
        share = period / max(periods - 1, 1)
        look = {"markersize": largest * (1.0 - 0.65 * share), "markerfacecolor": "none"}
        color = style.SEQUENTIAL(0.95 - 0.95 * share)
        name = f"kept period {period + 1}"
        ax.plot(law["beta"][~grey], values[~grey], "o", color=color, label=name, **look)
        ax.plot(law["beta"][grey], values[grey], "o", color="0.75", zorder=1, **look)
    return style.mark_missing(ax, law["beta"].values[np.isnan(samples).all(axis=1)], style.GREY)


def draw(target: Target, ds: xr.Dataset, amplitude: float | None = None) -> Panels:
    """Draw a panel per law at the amplitude (m) nearest to the given one (default: the middle)."""
    if ds.sizes["beta"] < FEWEST_BETAS:
        raise ValueError(
            f"needs {FEWEST_BETAS} frequencies or more to show branches; there are {ds.sizes['beta']}"
        )
    place = ds.sizes["amplitude"] // 2 if amplitude is None else cases.nearest(ds["amplitude"], amplitude)[0]
    ds = ds.isel(amplitude=place)
    words, scale = labels.of(ds), _half_swing(ds)
    made, parts = per_law(target, ds, size=(3.3, 3.5))
    missing = False
    for ax, _, law in parts:
        missing |= _draw_law(ax, law, scale)
        style.add_hertz_axis(ax, ds)
    made.axes[0].set_ylim(-1.1, 1.1)
    style.label(made.axes, style.BETA, f"${words.motion}$ from its middle, over the largest half swing [1]")
    made.legend(columns=6)
    grey, lifted = (int(marked.sum()) for marked in (validity.unsettled(ds), validity.lifted(ds)))
    made.title(
        f"Displacement at forcing phase 0 (${words.input}$ = 0, rising) of each kept period, "
        f"{words.size(ds['amplitude'].item(), 4)}; the scale is that of each frequency",
        words.sign,
        "$\\times$ no result or no motion" if missing else "",
        f"grey: {grey} of {ds['status'].size} cases that did not settle" if grey else "",
        f"hatched: lift-off, outside of validity ({lifted} cases)" if lifted else "",
    )
    return made
