"""Which scales of a dataset a figure draws, and what its axes are called."""

import numpy as np
import xarray as xr

from wedgesweep.figures import cases, style


def one_scale(ds: xr.Dataset, scale: float | None) -> xr.Dataset:
    """Select the scale nearest to one, by default the largest."""
    place = ds.sizes["scale"] - 1 if scale is None else cases.nearest(ds["scale"], scale)[0]
    return ds.isel(scale=place)


def displacement(ds: xr.Dataset) -> str:
    """Label of the displacement."""
    return style.DISPLACEMENT if _of_suspension(ds) else f"displacement ${_symbol(ds)}$ [mm]"


def about(ds: xr.Dataset) -> str:
    """The sign of the displacement, or what it is measured against."""
    if _of_suspension(ds):
        return style.SIGN
    return "$x-u$: mass against its base" if _symbol(ds) == "x-u" else "$x$: mass against the ground"


def _of_suspension(ds: xr.Dataset) -> bool:
    return ds.attrs.get("system") != "oscillator"


def _symbol(ds: xr.Dataset) -> str:
    relative = ds.attrs["contact"] == "base" and ds.attrs["excitation"] != "force"
    return "x-u" if relative else "x"


def rising(displacement: np.ndarray) -> np.ndarray:
    """Indices before the upward zero crossings of a motion about its mean in their midst."""
    centred = displacement - 0.5 * (np.nanmax(displacement) + np.nanmin(displacement))
    return np.flatnonzero((centred[:-1] < 0.0) & (centred[1:] >= 0.0))


def extremes(displacement: np.ndarray) -> np.ndarray:
    """Indices of the samples at which a motion turns round, shape (k,)."""
    slope = np.sign(np.diff(displacement))
    moving = np.flatnonzero(slope != 0.0)
    return moving[1:][slope[moving[1:]] != slope[moving[:-1]]]
