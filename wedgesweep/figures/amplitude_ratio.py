"""Fig. 4: amplitude ratio over frequency for every law and input amplitude."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from wedgesweep.figures import cases, style

NAME = "amplitude-ratio"
DESCRIPTION = "amplitude ratio over frequency, all laws and amplitudes (Fig. 4)"

LOWEST = 0.01  # amplitude ratio; below it nothing moves that matters
FEW_BETAS = 40  # up to here every case gets a dot


def frictionless_ratio(ds: xr.Dataset, beta: np.ndarray) -> np.ndarray:
    """Compute the amplitude ratio of the suspension without friction, NaN next to its resonance.

    And everywhere, if there are effects with mechanics of their own.

    With the wedge travelling r z along the column, m = M_b + 2 M_w r^2 is the moving mass and
    M_b + 2 M_w r cos(gamma) the mass that the base acceleration u'' drives.
    """
    from wedgesweep import config

    # Whatever the law: it takes part in none of these numbers.
    p = config.parse(ds.attrs["config"]).record(config.Case("static-dynamic", 1.0, 1e-3))[0]
    driven = p["bolster_mass"] + 2.0 * p["wedge_mass"] * p["column_ratio"] * p["cos_column"]
    moving = p["bolster_mass"] + 2.0 * p["wedge_mass"] * p["column_ratio"] ** 2
    squared = (beta * ds.attrs["omega_n"] / ds.attrs["frictionless_resonance"]) ** 2
    detuning = np.abs(1.0 - squared)
    detuning[detuning < 1e-6] = np.nan
    return driven / moving * squared / detuning


def _limits(beta: np.ndarray) -> tuple[float, float]:
    """Limit the frequency axis to the betas, from 0 unless they start far from it."""
    low, high = beta.min(), beta.max()
    return (0.0 if low < 0.3 * high or low == high else 0.98 * low), 1.02 * high


def _draw_reference(ax, ds: xr.Dataset) -> None:
    beta = np.linspace(0.0, float(ds["beta"].max()), 2000)
    ratio = frictionless_ratio(ds, beta)
    if np.isnan(ratio).all():
        return
    ax.plot(beta, ratio, color="black", linestyle="--", linewidth=1, label="no friction", zorder=3)


def _draw_law(ax, law: xr.Dataset, norm) -> bool:
    marker = "." if law.sizes["beta"] <= FEW_BETAS else ""
    missing = False
    for amplitude in law["amplitude"].values:
        ratio = law["amplitude_ratio"].sel(amplitude=amplitude)
        color = style.SEQUENTIAL(norm(amplitude * style.MM))
        ax.plot(law["beta"], ratio, color=color, linewidth=1.1, marker=marker, markersize=3)
        missing |= style.mark_missing(ax, law["beta"].values[np.isnan(ratio.values)], style.VERMILLION)
    return missing


def draw(ds: xr.Dataset) -> Figure:
    """Draw a panel per law, the input amplitude as colour, the frictionless response dashed."""
    cases.require_grid(ds, NAME, "amplitude_ratio", "omega_n", "frictionless_resonance", "config")
    names = cases.laws(ds)
    norm = style.amplitude_norm(ds["amplitude"].values)
    top = 1.5 * float(np.fmax(ds["amplitude_ratio"].max(), 1.5))
    figure, axes = style.panels(len(names), size=(3.3, 3.8))
    axes[0].set_yscale("log")
    missing = False
    for ax, law in zip(axes, names, strict=True):
        missing |= _draw_law(ax, ds.sel(friction_law=law), norm)
        _draw_reference(ax, ds)
        style.add_hertz_axis(ax, ds)
        ax.set_title(law, fontsize=10)
    style.decimal_ticks(axes[0].yaxis)
    axes[0].set(xlim=_limits(ds["beta"].values), ylim=(LOWEST, top))
    if axes[0].get_legend_handles_labels()[0]:
        axes[0].legend(fontsize=8, loc="lower right", frameon=True, framealpha=0.9, edgecolor="none")
    style.label(axes, style.BETA, "amplitude ratio $|x-y|/a$")
    style.add_amplitude_bar(figure, axes, norm)
    style.title(
        figure,
        "Half peak-to-peak of $x-y$ (side frame minus bolster) over the input amplitude",
        f"ratios below {LOWEST} are off the scale"
        + ("; $\\times$ no result (failed or not run)" if missing else ""),
    )
    return figure
