"""Sobol indices: how much of the variance of a result each uncertain number explains, alone and in all."""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from wedgesweep.figures import models, over_axes, style
from wedgesweep.figures.panels import Panels, Target, panels

NAME = "sensitivity"
DESCRIPTION = "first-order and total Sobol indices of a variable, from samples with indices = true"
NEEDS = ("status", "config")
ANY_AXES = True

# Of the intervals, from resampled points.
CONFIDENCE, RESAMPLES, AT_A_TIME, SEED = 0.95, 1000, 100, 0
# Fewer points with a value, as a share, say nothing of the distribution that was drawn.
LEAST_SHARE = 0.9


class Indices(NamedTuple):
    """First-order and total indices of d numbers, (2, d), their confidence intervals, and points used."""

    values: np.ndarray
    low: np.ndarray
    high: np.ndarray
    points: int


def sobol_indices(values: np.ndarray, num: int) -> Indices:
    """Indices from values, shape (num (d + 2),), at the points of ``config.sample`` (Saltelli et al., 2010).

    Points where one of the d + 2 values is missing are left out. Raises ValueError if they are many.
    """
    parts = values.reshape(-1, num)
    parts = parts[:, np.isfinite(parts).all(axis=0)]
    points = parts.shape[1]
    if points < LEAST_SHARE * num:
        raise ValueError(
            f"{num - points} of {num} points lack a value; narrow the distributions, or draw another variable"
        )
    one, other, mixed = parts[0], parts[1], parts[2:]
    # The estimates do not depend on the mean, their scatter does.
    one, other, mixed = (each - 0.5 * (one.mean() + other.mean()) for each in (one, other, mixed))
    moments = np.stack([one + other, one**2 + other**2])
    terms = np.concatenate([moments, other * (mixed - one), 0.5 * (mixed - one) ** 2])
    if not moments[1].any():
        raise ValueError("all samples have the same value")
    random, drawn = np.random.default_rng(SEED), []
    for _ in range(RESAMPLES // AT_A_TIME):
        weights = random.multinomial(points, np.full(points, 1.0 / points), AT_A_TIME) / points
        drawn.append(_of_means(weights @ terms.T))
    tail = 50.0 * (1.0 - CONFIDENCE)
    low, high = np.percentile(np.concatenate(drawn), [tail, 100.0 - tail], axis=0)
    return Indices(_of_means(terms.mean(axis=1)), low, high, points)


def _of_means(means: np.ndarray) -> np.ndarray:
    """Indices, shape (..., 2, d), from the means of the terms, shape (..., 2 + 2 d)."""
    variance = 0.5 * means[..., 1] - 0.25 * means[..., 0] ** 2
    return means[..., 2:].reshape(*means.shape[:-1], 2, -1) / variance[..., None, None]


def _draw_panel(ax: Axes, found: Indices, names: list[str]) -> None:
    place = np.arange(len(names))
    for row, (label, color) in enumerate(
        (("alone (first order)", style.BLUE), ("in all (total)", style.VERMILLION))
    ):
        y = place + 0.36 * (row - 0.5)
        ax.barh(y, found.values[row], 0.34, color=color, label=label)
        ax.hlines(y, found.low[row], found.high[row], color="black", linewidth=1.2)
    ax.axvline(0.0, color=style.GREY, linewidth=0.8)
    ax.set_yticks(place, names, fontsize=8)
    ax.set_ylim(len(names) - 0.5, -0.5)


def draw(
    target: Target,
    ds: xr.Dataset,
    facet: str | None = None,
    variable: str | None = None,
    at: Mapping[str, Any] | None = None,
) -> Panels:
    """Draw the indices of a variable, a panel for each law or each value of ``facet``."""
    from wedgesweep import config

    given = config.parse(ds.attrs["config"]).document["sweep"].get("sample", {})
    if not given.get("indices"):
        raise ValueError("needs [sweep.sample] with indices = true")
    variable = variable or over_axes.size_of_motion(ds)
    over_axes.variable_of(ds, variable)
    names = [name for name in models.varied(ds) if ds[name].dims == ("sample",)]
    parts, chosen = over_axes.samples(ds, facet, at)
    made = panels(target, len(parts), size=(3.4, 1.2 + 0.35 * len(names)))
    points = given["num"]
    for ax, (title, part) in zip(made.axes, parts, strict=True):
        found = sobol_indices(part[variable].values.astype(float), given["num"])
        _draw_panel(ax, found, [name.replace("_", " ") for name in names])
        ax.set_title(title, fontsize=10)
        points = min(points, found.points)
    style.label(made.axes, "share of the variance [1]", "")
    made.legend()
    left_out = f", {given['num'] - points} left out that lack a value" if points < given["num"] else ""
    note = f"lines: {100.0 * CONFIDENCE:g} % intervals; {given['num']} points{left_out}"
    made.title(f"Sobol indices: {over_axes.meaning(ds, variable)}", chosen, note)
    return made
