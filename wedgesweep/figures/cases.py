"""Which cases of a dataset a figure draws, and the errors if they are not there; samples of a motion."""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

# Amplitudes shown by default are those at which enough cases slip instead of creeping.
SLIPS = 0.99  # stick fraction below which a case counts as slipping
# A value that is asked for is answered by the nearest one there, if that differs by less than this share.
FAR = 0.2
SLIPPING_SHARE = 0.25  # of the cases at an amplitude


def checked(ds: xr.Dataset, needs: Sequence[str], case_lists: bool) -> xr.Dataset:
    """Return a dataset with the dimensions of a grid; raise ValueError if the figure cannot draw it.

    A law, beta or amplitude that was selected as a single value gets its dimension back. A list of cases
    stays one, if the figure draws such lists.
    """
    if "case" in ds.dims and not case_lists:
        raise ValueError(
            "needs a grid of friction_law, beta and amplitude, "
            "but this dataset is a list of cases; phase-portrait draws such a list"
        )
    missing = [name for name in needs if name not in ds.variables and name not in ds.attrs]
    if missing:
        waveforms = {"displacement", "velocity", "stuck"} & set(missing)
        hint = "; run the sweep again with keep_waveforms = true" if waveforms else ""
        raise ValueError(f"the dataset has no {', '.join(missing)}{hint}")
    if "scale" in ds.coords:
        return ds.expand_dims([name for name in ("scale", "friction_law") if ds[name].ndim == 0])
    single = [name for name in ("amplitude", "beta", "friction_law") if ds[name].ndim == 0]
    ds = ds.expand_dims(single)
    if "beta" in single and "frequency" in ds.coords:
        ds = ds.assign_coords(frequency=("beta", [ds["frequency"].item()]))
    return ds


def laws(ds: xr.Dataset) -> list[str]:
    """Friction laws to draw, in the dataset's order."""
    return list(dict.fromkeys(str(name) for name in np.atleast_1d(ds["friction_law"].values)))


def of_law(ds: xr.Dataset, law: str) -> xr.Dataset:
    """Select the cases of a law, in capitals or not; raises ValueError if there are none."""
    present = laws(ds)
    if law.lower() not in present:
        raise ValueError(f"no friction law '{law}' in the dataset; it has " + ", ".join(present))
    if "friction_law" in ds.dims:
        return ds.sel(friction_law=[law.lower()])
    return ds.isel(case=ds["friction_law"].values == law.lower()) if "case" in ds.dims else ds


def nearest(there: xr.DataArray, wanted: ArrayLike) -> np.ndarray:
    """Return indices of the values nearest to the wanted ones, each once, in order of index.

    Raises ValueError if one is farther than FAR from all of them.
    """
    values = np.atleast_1d(there.values)
    places = []
    for value in np.atleast_1d(wanted):
        place = int(np.abs(values - value).argmin())
        if abs(values[place] - value) > FAR * abs(value):
            unit = there.attrs.get("units", "1").replace("1", "")
            span = f"{values.min():.4g} to {values.max():.4g} {unit}".rstrip()
            raise ValueError(f"no {there.name} near {value:.4g}; the dataset has {values.size} from {span}")
        places.append(place)
    return np.unique(places)


def spread(indices: Sequence[int] | np.ndarray, count: int) -> np.ndarray:
    """Keep at most ``count`` of the indices, first and last among them, evenly spread."""
    indices = np.asarray(indices)
    places = np.linspace(0, len(indices) - 1, min(count, len(indices)))
    return indices[places.round().astype(int)]


def pick_amplitudes(ds: xr.Dataset, amplitudes: ArrayLike | None, count: int) -> np.ndarray:
    """Return indices of the amplitudes (m) asked for; by default some at which something slips."""
    if amplitudes is not None:
        return nearest(ds["amplitude"], amplitudes)
    others = [dimension for dimension in ds["stick_fraction"].dims if dimension != "amplitude"]
    slipping = np.flatnonzero((ds["stick_fraction"] < SLIPS).mean(others) >= SLIPPING_SHARE)
    return spread(slipping if slipping.size else np.arange(ds.sizes["amplitude"]), count)


def samples_per_period(ds: xr.Dataset) -> int:
    """Count the waveform samples in one forcing period."""
    phase = ds["phase"].values
    return round(2.0 * np.pi / (phase[1] - phase[0]))


def one_scale(ds: xr.Dataset, scale: float | None) -> xr.Dataset:
    """Select the scale nearest to one, by default the largest."""
    place = ds.sizes["scale"] - 1 if scale is None else nearest(ds["scale"], scale)[0]
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
