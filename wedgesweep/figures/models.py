"""One model of a dataset whose sweep varies it, for figures of frequency and amplitude."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from wedgesweep import formatting
from wedgesweep.figures import cases

# Dimensions that figures of frequency and amplitude draw.
OF_INPUT = ("friction_law", "beta", "frequency", "amplitude", "scale", "case")


def varied(ds: xr.Dataset) -> list[str]:
    """Coordinates that are numbers of the model."""
    return [str(name) for name in ds.coords if "key" in ds[name].attrs]


def of_one(ds: xr.Dataset, at: Mapping[str, Any] | None = None) -> xr.Dataset:
    """The dataset of one model, as if its sweep varied nothing else.

    ``at`` picks numbers by coordinate or key.
    By default the middle of each axis is taken, or where nothing slips there what slips most.
    """
    if not varied(ds) or "case" in ds.dims:
        return ds
    ds = at_values(ds, at)
    models = [dim for dim in ds["status"].dims if dim not in OF_INPUT]
    if "sample" in models:
        raise ValueError("needs a grid; these are samples")
    found = ds.isel(default(ds, models))
    return _alone(found)


def at_values(ds: xr.Dataset, at: Mapping[str, Any] | None) -> xr.Dataset:
    """Select the values nearest to some, by coordinate or dotted key; raises ValueError."""
    for name, value in (at or {}).items():
        place = coordinate(ds, name)
        if ds[place].ndim == 0:
            continue
        if ds[place].ndim > 1:
            raise ValueError(f"{name}: depends on {', '.join(map(str, ds[place].dims))}; pick one of these")
        if place == "friction_law":
            ds = cases.of_law(ds, str(value)).squeeze(ds[place].dims[0])
        elif ds[place].dtype.kind in "OUT":
            names = ds[place].values.tolist()
            if value not in names:
                raise ValueError(f"{name}: no {value}; the dataset has {', '.join(names)}")
            ds = ds.isel({ds[place].dims[0]: names.index(value)})
        else:
            ds = ds.isel({ds[place].dims[0]: cases.nearest(ds[place], float(value))[0]})
    return ds


def coordinate(ds: xr.Dataset, name: str) -> str:
    """The coordinate of a name or a dotted key; raises ValueError."""
    of_cases = [str(each) for each in ds.coords if set(ds[each].dims) <= set(ds["status"].dims)]
    known = {ds[each].attrs.get("key", each): each for each in of_cases} | {each: each for each in of_cases}
    if name not in known:
        raise ValueError(f"no axis {name}; there are {', '.join(of_cases)}")
    return known[name]


def default(ds: xr.Dataset, dims: list[str]) -> dict[str, int]:
    """A place on each axis: its middle, or where nothing slips there the places at which most cases slip."""
    middle = {dim: (ds.sizes[dim] - 1) // 2 for dim in dims}
    if "stick_fraction" not in ds or not dims:
        return middle
    slips = (ds["stick_fraction"] < cases.SLIPS).mean([dim for dim in ds["status"].dims if dim not in dims])
    if slips.isel(middle) > 0.0:
        return middle
    places = np.unravel_index(int(slips.transpose(*dims).values.argmax()), [ds.sizes[dim] for dim in dims])
    return dict(zip(dims, map(int, places), strict=True))


def _alone(ds: xr.Dataset) -> xr.Dataset:
    """A dataset of one model with the attributes of that model, and over beta where it was over frequency."""
    from wedgesweep import config
    from wedgesweep.config.physics import physics

    numbers = {ds[name].attrs["key"]: ds[name].item() for name in varied(ds)}
    whole = config.parse(ds.attrs["config"])
    model = whole.alone(whole.given(numbers))
    found = ds.drop_vars([name for name in (*varied(ds), "omega_n") if name in ds.coords])
    found = found.assign_attrs({**physics(model), "config": model.to_toml()})
    if "frequency" in found.dims:
        found = found.swap_dims(frequency="beta")
    chosen = ", ".join(f"{key} = {formatting.setting(value, 4)}" for key, value in numbers.items())
    return found.assign_attrs(model=chosen)
