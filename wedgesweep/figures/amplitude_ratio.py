"""Fig. 4: amplitude ratio over frequency for every law and input amplitude."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import QuadMesh
from matplotlib.colors import LogNorm

from wedgesweep.figures import labels, style, validity
from wedgesweep.figures.maps import cell_edges
from wedgesweep.figures.panels import Panels, Target, per_law

NAME = "amplitude-ratio"
DESCRIPTION = "amplitude ratio over frequency, all laws and amplitudes (Fig. 4)"
NEEDS = ("amplitude_ratio", "omega_n", "frictionless_resonance", "config")

# Where spring and inertia cancel to this share there is no finite ratio to draw.
LEAST_STIFFNESS = 1e-6
LOWEST = 0.01  # of the axis; smaller ratios do not matter
FEW_BETAS = 40  # up to here every case gets a dot
# More cases of a law than this are drawn as a density: lines and marks would cover each other.
MOST_CASES, BINS = 10_000, 120


def frictionless_ratio(ds: xr.Dataset, beta: np.ndarray) -> np.ndarray:
    """Compute the amplitude ratio of the system without friction.

    With the wedge travelling r z along the column, m = M_b + 2 M_w r^2 is the moving mass and
    M_b + 2 M_w r cos(gamma) the mass that the base acceleration u'' drives. The ratio is NaN next to the
    resonance, and everywhere if an effect has mechanics of its own.
    """
    from wedgesweep import config
    from wedgesweep.systems.suspension.parameters import driven_mass, moving_mass

    # Any law will do: none of these numbers depends on it.
    p = config.parse(ds.attrs["config"]).record(config.Case("static-dynamic", 1.0, 1e-3))[0]
    if ds.attrs.get("system") == "oscillator":
        return _linear_ratio(p["oscillator"], beta * ds.attrs["omega_n"])
    squared = (beta * ds.attrs["omega_n"] / ds.attrs["frictionless_resonance"]) ** 2
    detuning = np.abs(1.0 - squared)
    detuning[detuning < 1e-6] = np.nan
    return driven_mass(p) / moving_mass(p) * squared / detuning


def _linear_ratio(own: np.void, omega: np.ndarray) -> np.ndarray:
    """Amplitude ratio of a mass on spring and damper without friction, over angular frequency (rad/s)."""
    inertia, support = own["mass"] * omega**2, own["spring"] + 1j * own["damping"] * omega
    total = np.abs(support - inertia)
    total[total < LEAST_STIFFNESS * own["spring"]] = np.nan
    if own["forced"]:
        return (own["spring"] or inertia) / total
    return np.abs(support) / total if own["absolute"] else inertia / total


def _limits(beta: np.ndarray) -> tuple[float, float]:
    """Limit the frequency axis to the betas, from 0 unless they start far from it."""
    low, high = beta.min(), beta.max()
    return (0.0 if low < 0.3 * high or low == high else 0.98 * low), 1.02 * high


def _draw_reference(ax: Axes, ds: xr.Dataset) -> None:
    from wedgesweep import config

    beta = np.linspace(0.0, float(ds["beta"].max()), 2000)
    ratio = frictionless_ratio(ds, beta)
    if np.isnan(ratio).all():
        return
    label = "no friction, joints held" if config.parse(ds.attrs["config"]).opens else "no friction"
    ax.plot(beta, ratio, color="black", linestyle="--", linewidth=1, label=label, zorder=3)


def _draw_density(ax: Axes, law: xr.Dataset, top: float) -> QuadMesh:
    """Draw the share of amplitudes at each frequency whose ratio lies in a bin, in place of lines."""
    ratios = law["amplitude_ratio"].transpose("beta", "amplitude").values
    edges = np.geomspace(LOWEST, top, BINS)
    counts = np.stack([np.histogram(row[np.isfinite(row)], edges)[0] for row in ratios], axis=1)
    shares = np.ma.masked_equal(counts / ratios.shape[1], 0.0)
    beta = cell_edges(law["beta"].values, False)
    # Most amplitudes may share a bin where nothing slips: a linear scale would show that alone.
    norm = LogNorm(1.0 / ratios.shape[1], 1.0)
    return ax.pcolormesh(beta, edges, shares, cmap=style.SEQUENTIAL, norm=norm, rasterized=True)


def _draw_law(ax: Axes, law: xr.Dataset, norm: LogNorm, factor: float) -> bool:
    marker = "." if law.sizes["beta"] <= FEW_BETAS else ""
    missing = False
    for amplitude in law["amplitude"].values:
        ratio = law["amplitude_ratio"].sel(amplitude=amplitude)
        color = style.SEQUENTIAL(norm(amplitude * factor))
        ax.plot(law["beta"], ratio, color=color, linewidth=1.1, marker=marker, markersize=3)
        validity.mark(ax, law["beta"].values, ratio.values, law.sel(amplitude=amplitude), color)
        missing |= style.mark_missing(ax, law["beta"].values[np.isnan(ratio.values)], style.VERMILLION)
    return missing


def _amplitude_norm(amplitudes: np.ndarray) -> LogNorm:
    """Scale the colours of input amplitudes (mm or N)."""
    low, high = amplitudes.min(), amplitudes.max()
    return LogNorm(low, high) if high > low else LogNorm(0.5 * low, 2.0 * high)


def _explain(made: Panels, ds: xr.Dataset, norm: LogNorm, missing: bool) -> None:
    """Draw the scale of the amplitudes, the legend of the marks, and the title."""
    words, alone = labels.of(ds), ""
    if ds.sizes["amplitude"] > 1:
        bar = made.colorbar(ScalarMappable(norm, style.SEQUENTIAL), words.amplitude)
        style.decimal_ticks(bar.ax.yaxis)
    else:
        alone = f", {words.size(ds['amplitude'].item(), 4)}"
    made.legend(validity.handles(ds))
    _title(made, ds, alone, "$\\times$ no result (failed or not run)" if missing else "")


def _title(made: Panels, ds: xr.Dataset, alone: str, note: str) -> None:
    words = labels.of(ds)
    made.title(
        f"Half peak-to-peak of ${words.motion}$ ({words.whose}) over {words.reference}{alone}",
        f"ratios below {LOWEST} are not shown",
        note,
        validity.shares(ds),
    )


def draw(target: Target, ds: xr.Dataset) -> Panels:
    """Draw a panel per law, the input amplitude as colour, the frictionless response dashed."""
    words = labels.of(ds)
    if not ds["amplitude"].all():
        raise ValueError("needs an input amplitude that the response can be compared with; there is one of 0")
    norm = _amplitude_norm(ds["amplitude"].values * words.factor)
    top = 1.5 * float(np.fmax(ds["amplitude_ratio"].max(), 1.5))
    made, parts = per_law(target, ds, size=(3.3, 3.8))
    axes = made.axes
    axes[0].set_yscale("log")
    missing, density = False, None
    for ax, _, law in parts:
        if ds["beta"].size * ds["amplitude"].size > MOST_CASES:
            density = _draw_density(ax, law, top)
        else:
            missing |= _draw_law(ax, law, norm, words.factor)
        _draw_reference(ax, ds)
        style.add_hertz_axis(ax, ds)
    style.decimal_ticks(axes[0].yaxis)
    axes[0].set(xlim=_limits(ds["beta"].values), ylim=(LOWEST, top))
    if axes[0].get_legend_handles_labels()[0]:
        axes[0].legend(fontsize=8, loc="lower right", frameon=True, framealpha=0.9, edgecolor="none")
    style.label(axes, style.BETA, words.ratio)
    if density is None:
        _explain(made, ds, norm, missing)
    else:
        made.colorbar(density, "share of the amplitudes [1]")
        _title(made, ds, "", "")
    return made
