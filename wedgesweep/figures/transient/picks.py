"""Which scale of a dataset a figure draws, and where its motion crosses its mean and turns round."""

import numpy as np
import xarray as xr

from wedgesweep.figures import cases


def one_scale(ds: xr.Dataset, scale: float | None) -> xr.Dataset:
    """Select the scale nearest to one, by default the largest."""
    place = ds.sizes["scale"] - 1 if scale is None else cases.nearest(ds["scale"], scale)[0]
    return ds.isel(scale=place)


def rising(displacement: np.ndarray) -> np.ndarray:
    """Indices before the upward zero crossings of a motion about its mean in their midst."""
    centred = displacement - 0.5 * (np.nanmax(displacement) + np.nanmin(displacement))
    return np.flatnonzero((centred[:-1] < 0.0) & (centred[1:] >= 0.0))


def extremes(displacement: np.ndarray) -> np.ndarray:
    """Indices of the samples at which a motion turns round, shape (k,)."""
    slope = np.sign(np.diff(displacement))
    moving = np.flatnonzero(slope != 0.0)
    return moving[1:][slope[moving[1:]] != slope[moving[:-1]]]
