"""Figs. 5-7: steady waveforms at one frequency, from small to large input amplitudes."""

import math

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from wedgesweep.figures import cases, labels, style, validity
from wedgesweep.figures.panels import Panels, Target, per_law

NAME = "response"
DESCRIPTION = "relative displacement over time and input amplitude at one beta (Figs. 5-7)"
NEEDS = ("displacement", "stuck", "stick_fraction", "omega_n")

ROWS = 12  # waveforms per panel by default: more would overlap
PERIODS = 3
HEIGHT = 0.75  # of the largest waveform about its middle, in distances between rows


def _normalised(ds: xr.Dataset) -> xr.DataArray:
    """Return (x - y) / a, or a motion over what it is compared with, centred between its extremes."""
    forced = labels.of(ds).forced
    waves = ds["displacement"] / (
        0.5 * ds["peak_to_peak"] / ds["amplitude_ratio"] if forced else ds["amplitude"]
    )
    return waves - 0.5 * (waves.max("phase") + waves.min("phase"))


def _even_rows(count: int) -> np.ndarray:
    """Take every n-th index, the last one (the largest amplitude) among them."""
    return np.arange(count)[:: -math.ceil(count / ROWS)][::-1]


def _draw_row(
    ax: Axes, time: np.ndarray, wave: np.ndarray, marks: dict[str, np.ndarray], row: int, color: str
) -> None:
    if np.isnan(wave).all():
        ax.text(time.mean(), row, "no result", fontsize=7, color=style.GREY, ha="center", va="center")
        return
    for shade, marked in marks.items():
        ax.plot(time, row + np.where(marked, wave, np.nan), color=shade, linewidth=5)
    ax.plot(time, row + wave, color=color, linewidth=1.2)


def _nice(value: float) -> float:
    """Find the largest of 1, 2, 5 times a power of ten not above the value."""
    power = 10.0 ** np.floor(np.log10(value))
    return power * max(step for step in (1, 2, 5) if step * power <= value * (1 + 1e-9))


def _draw_scale(ax: Axes, per_ratio: float, largest: float, words: labels.Labels) -> None:
    """Draw a bar beside the panel: how high a given motion is in these rows."""
    ratio = _nice(largest)
    where = {"transform": ax.get_yaxis_transform(), "clip_on": False}
    ax.plot([1.04, 1.04], [0.0, ratio * per_ratio], color="black", linewidth=2, **where)
    ax.text(
        1.07,
        0.5 * ratio * per_ratio,
        f"${words.motion}$\n= {ratio:g} ${words.scale}$",
        fontsize=8,
        va="center",
        **where,
    )


def _lowest_that_moves(ds: xr.Dataset) -> int:
    """Index of the lowest beta at which cases of half of the amplitudes slip (else of most of them)."""
    moving = (ds["stick_fraction"] < cases.SLIPS).mean(("friction_law", "amplitude")).values
    return int(np.argmax(moving >= min(0.5, moving.max())))


def _time(ds: xr.Dataset) -> np.ndarray:
    """Time (s) of the samples of a case."""
    return ds["phase"].values / (ds["beta"].item() * ds.attrs["omega_n"])


def _draw_law(ax: Axes, law: xr.Dataset, waves: xr.DataArray) -> None:
    """Draw a row for each amplitude of a law."""
    time = _time(law)
    color = style.law_style(law["friction_law"].item())["color"]
    for row in range(law.sizes["amplitude"]):
        case = law.isel(amplitude=row)
        _draw_row(ax, time, waves.isel(amplitude=row).values, validity.marked_samples(case), row, color)
        if remark := validity.remark(case):
            ax.text(time[-1], row + 0.3, remark.strip(), fontsize=6.5, color=style.GREY, ha="right")


def draw(
    target: Target, ds: xr.Dataset, beta: float | None = None, amplitudes: ArrayLike | None = None
) -> Panels:
    """Draw a row per amplitude (m), each divided by it, at the nearest beta or the lowest that moves."""
    place = _lowest_that_moves(ds) if beta is None else cases.nearest(ds["beta"], beta)[0]
    if amplitudes is None:
        rows = _even_rows(ds.sizes["amplitude"])
    else:
        rows = cases.nearest(ds["amplitude"], amplitudes)
    shown = slice(0, PERIODS * cases.samples_per_period(ds))
    ds = ds.isel(beta=place, amplitude=rows, phase=shown)
    waves = _normalised(ds)
    largest = float(np.nan_to_num(np.abs(waves).max()))
    per_ratio = HEIGHT / largest if largest > 0.0 else 1.0
    time = _time(ds)
    words = labels.of(ds)
    made, parts = per_law(target, ds, size=(3.2, max(2.4, 1.2 + 0.36 * len(rows))))
    axes = made.axes
    for ax, name, law in parts:
        _draw_law(ax, law, waves.sel(friction_law=name) * per_ratio)
    axes[0].set_yticks(range(len(rows)), [f"{a * words.factor:.3g}" for a in ds["amplitude"].values])
    axes[0].set(ylim=(-0.9, len(rows) - 0.1), xlim=(0.0, time[-1]))
    style.label(axes, "time [s]", words.amplitude)
    if largest > 0.0:
        _draw_scale(axes[-1], per_ratio, largest, words)
    frequency = style.frequency(ds["beta"].item(), ds.attrs["omega_n"])
    made.title(
        f"{words.name} ${words.motion}$ ({words.whose}) at {frequency}",
        f"a row for each amplitude, divided by {words.own_reference} and centred; "
        f"yellow: {labels.sticking(cases.laws(ds))}{validity.note_of_open(ds)}",
    )
    return made
