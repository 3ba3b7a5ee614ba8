"""What figures over any axes share: which axis is which, names and units, and everything else picked."""

from collections.abc import Mapping
from math import nan
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from wedgesweep.figures import cases, labels, models, style
from wedgesweep.quantity import Quantity

MOST_PANELS = 6
UNITS = {"degree": "deg"}


class Layout(NamedTuple):
    """Coordinates that a figure is drawn over; None where there is no axis left."""

    x: str
    other: str | None
    facet: str | None


def laid_out(
    ds: xr.Dataset,
    x: str | None,
    other: str | None,
    facet: str | None,
    at: Mapping[str, Any] | None,
    numbers: bool = False,
) -> tuple[xr.Dataset, Layout]:
    """Choose axes, the longest first where none is asked for, and pick one value of all that are left.

    ``numbers``: ``x`` and ``other`` have numbers, no names as of laws. Of a list of cases and of samples
    there are no axes; raises ValueError.
    """
    if "case" in ds.dims or "sample" in ds.dims:
        raise ValueError("needs axes; these are samples, or cases one by one")
    ds = models.at_values(ds, at)
    asked = {
        name: models.coordinate(ds, each)
        for name, each in (("x", x), ("other", other), ("facet", facet))
        if each
    }
    for name in asked.values():
        if ds[name].ndim != 1:
            raise ValueError(f"{name}: is no axis with several values here")
    for key, name in asked.items():
        if numbers and key != "facet" and not _has_numbers(ds, name):
            raise ValueError(f"{name}: has names, no numbers; give it to --facet")
    taken = [ds[name].dims[0] for name in asked.values()]
    if len(set(taken)) < len(taken):
        raise ValueError(f"{', '.join(asked.values())}: these go together along one axis; choose others")
    left = sorted((dim for dim in ds["status"].dims if dim not in taken), key=lambda dim: -ds.sizes[dim])
    numeric = [str(dim) for dim in left if _has_numbers(ds, str(dim))]
    chosen: dict[str, str | None] = {"x": asked.get("x") or next(iter(numeric), "beta")}
    for name, dims in (("other", numeric if numbers else left), ("facet", left)):
        free = (str(dim) for dim in dims if ds.sizes[dim] > 1 and dim not in chosen.values())
        chosen[name] = asked.get(name) or next(free, None)
    layout = Layout(str(chosen["x"]), chosen["other"], chosen["facet"])
    drawn = {ds[name].dims[0] for name in layout if name and ds[name].ndim}
    rest = [str(dim) for dim in ds["status"].dims if dim not in drawn]
    return ds.isel(models.default(ds, rest)), layout


def _has_numbers(ds: xr.Dataset, name: str) -> bool:
    return ds[name].dtype.kind not in "OUT"


def label(ds: xr.Dataset, name: str) -> str:
    """Words for an axis, with the unit in which ``values`` gives it."""
    own = {"beta": style.BETA, "frequency": "frequency [Hz]", "amplitude": labels.of(ds).amplitude}
    about = ds[name].attrs
    words = about.get("long_name", name.replace("_", " "))
    return own.get(name) or f"{words} [{unit(ds, name)}]"


def unit(ds: xr.Dataset, name: str) -> str:
    """Unit of an axis, for a reader."""
    units = str(ds[name].attrs.get("units", "1"))
    return UNITS.get(units, units)


def values(ds: xr.Dataset, name: str) -> np.ndarray:
    """Values of an axis for a reader: amplitudes in mm."""
    return ds[name].values * labels.of(ds).factor if name == "amplitude" else ds[name].values


def written(ds: xr.Dataset, name: str, value: Any) -> str:
    """One value of an axis in words."""
    if isinstance(value, str):
        return value
    if name == "amplitude":
        return labels.of(ds).size(float(value), 4)
    units = "" if unit(ds, name) == "1" else unit(ds, name)
    words = Quantity(name, nan, "").name.replace("_", " ")
    return f"{words} {float(value):.5g} {units}".rstrip()


def picked(ds: xr.Dataset, layout: Layout) -> str:
    """The values that were picked of what is not drawn, in words."""
    names = [
        name
        for name in ("friction_law", "beta", "frequency", "amplitude", *models.varied(ds))
        if name in ds.coords
    ]
    single = [name for name in names if ds[name].ndim == 0 and name not in layout]
    if "frequency" in single and "beta" in single:
        single.remove("beta")
    return ", ".join(written(ds, name, ds[name].item()) for name in single)


def panels_of(ds: xr.Dataset, facet: str | None) -> list[tuple[str, xr.Dataset]]:
    """Title and dataset of each panel: at most MOST_PANELS values of an axis."""
    if facet is None:
        return [("", ds)]
    dim = ds[facet].dims[0]
    places = cases.spread(np.arange(ds.sizes[dim]), MOST_PANELS)
    parts = (ds.isel({dim: place}) for place in places)
    return [(written(part, facet, part[facet].item()), part) for part in parts]


def size_of_motion(ds: xr.Dataset) -> str:
    """The variable that is drawn where none is asked for."""
    return "peak_to_peak" if "scale" in ds.coords else "amplitude_ratio"


def variable_of(ds: xr.Dataset, name: str) -> xr.DataArray:
    """A variable with one number a case; raises ValueError."""
    numbers = [
        str(each)
        for each in ds.data_vars
        if ds[each].dims == ds["status"].dims and ds[each].dtype.kind in "bfiu"
    ]
    if name not in numbers:
        raise ValueError(f"no variable {name} with a number for each case; there are {', '.join(numbers)}")
    return ds[name]


def short(ds: xr.Dataset, name: str) -> str:
    """Name of a variable, with its unit."""
    return f"{name.replace('_', ' ')} [{unit(ds, name)}]"


def meaning(ds: xr.Dataset, name: str) -> str:
    """What a variable is, with its unit."""
    if name == "stick_fraction":
        return f"share of time: {labels.sticking(cases.laws(ds))} [1]"
    about = ds[name].attrs
    return f"{about.get('long_name', name)} [{about.get('units', '1')}]"


def samples(
    ds: xr.Dataset, facet: str | None, at: Mapping[str, Any] | None, along: str | None = None
) -> tuple[list[tuple[str, xr.Dataset]], str]:
    """Title and dataset of each panel of a figure of samples, and what was picked of the other axes.

    The panels are those of ``facet``, by default the laws; ``along`` stays an axis beside the samples.
    """
    ds = models.at_values(ds, at)
    chosen = models.coordinate(ds, facet) if facet else "friction_law"
    kept = {"sample", *(ds[name].dims[0] for name in (chosen, along) if name and ds[name].ndim)}
    ds = ds.isel(models.default(ds, [str(dim) for dim in ds["status"].dims if dim not in kept]))
    numbers = {name for name in models.varied(ds) if "sample" in ds[name].dims}
    layout = Layout(along or "sample", chosen, None)
    parts = panels_of(ds, chosen if ds[chosen].ndim else None)
    return parts, picked(ds.drop_vars(numbers), layout)
