"""A small dataset with every variable of a sweep, made without solving anything.

The waveforms are those of a linear oscillator with its crests cut off (stuck there), so that small
inputs stick, large ones slip, and the laws differ. One case failed; large inputs lift off.
"""

import numpy as np
import xarray as xr

from wedgesweep.sweep.labels import SUSPENSION
from wedgesweep.sweep.variables import HARMONICS, STATUSES, VARIABLES

LAWS = ("coulomb", "static-dynamic", "exponential")
BETAS = (0.1, 0.3, 0.4, 0.6, 0.8, 1.0, 1.2, 1.4, 1.75, 2.2, 2.6, 3.0, *np.linspace(3.1, 3.8, 8))
AMPLITUDES = (1e-5, 5e-5, 2e-4, 5e-4, 1e-3, 4e-3)
PERIODS, SAMPLES = 3, 64
FAILED = {"friction_law": 1, "beta": 6, "amplitude": 4}

OMEGA_N = 85.3564930313
RESONANCE = 97.50648228
BREAKAWAY = 0.66

CONFIG = """\
title = "synthetic"
[friction]
dynamic = 0.29
static = 0.32
[sweep]
friction_law = ["coulomb", "static-dynamic", "exponential"]
beta = 1.0
amplitude_mm = 0.1
"""


def build(laws=LAWS, betas=BETAS, amplitudes=AMPLITUDES, failed=FAILED) -> xr.Dataset:
    """Make a grid dataset (SI); ``failed`` holds the indices of a case without result, or None."""
    coordinates = {
        "friction_law": list(laws),
        "beta": np.asarray(betas, float),
        "amplitude": np.asarray(amplitudes, float),
        "phase": 2.0 * np.pi * np.arange(PERIODS * SAMPLES) / SAMPLES,
        "harmonic": np.arange(1, HARMONICS + 1),
        "part": ["real", "imaginary"],
    }
    ds = xr.Dataset(coords=coordinates)
    ds = ds.assign_coords(frequency=ds["beta"] * OMEGA_N / (2.0 * np.pi))
    values = _values(ds)
    for variable in VARIABLES:
        dims = ("friction_law", "beta", "amplitude", *variable.dims)
        full = values.get(variable.name, xr.zeros_like(_blank(ds, dims)))
        full = (full + _blank(ds, dims)).transpose(*dims)
        text = variable.dtype == "str"
        data = np.full(full.shape, "", object) if text else full.values.astype(variable.dtype)
        about = {"units": variable.units, "long_name": variable.long_name.format(**SUSPENSION)}
        ds[variable.name] = dims, data, about
    ds["status"].attrs |= {
        "flag_values": np.arange(len(STATUSES), dtype="i1"),
        "flag_meanings": " ".join(STATUSES),
    }
    if failed is not None:
        _fail(ds, failed)
    ds.attrs = {
        "title": "synthetic",
        "config": CONFIG,
        "omega_n": OMEGA_N,
        "frictionless_resonance": RESONANCE,
        "breakaway_acceleration": BREAKAWAY,
    }
    return ds


def as_cases(ds: xr.Dataset, count: int = 4) -> xr.Dataset:
    """Take some cases of a grid dataset as a list of cases."""
    places = np.linspace(0, ds["status"].size - 1, count).astype(int)
    index = np.unravel_index(places, ds["status"].shape)
    at = {name: xr.DataArray(i, dims="case") for name, i in zip(ds["status"].dims, index, strict=True)}
    return ds.isel(at)


def without_waveforms(ds: xr.Dataset) -> xr.Dataset:
    """Keep the dataset with the metrics only."""
    return ds.drop_dims(["phase", "harmonic"])


def _blank(ds: xr.Dataset, dims: tuple[str, ...]) -> xr.DataArray:
    return xr.DataArray(np.zeros([ds.sizes[name] for name in dims]), dims=dims)


def _values(ds: xr.Dataset) -> dict[str, xr.DataArray]:
    """Compute what is not simply zero."""
    a, beta, phase = ds["amplitude"], ds["beta"], ds["phase"]
    friction = xr.DataArray([1.0, 0.9, 0.8][: ds.sizes["friction_law"]], dims="friction_law")
    squared = (beta * OMEGA_N / RESONANCE) ** 2
    linear = squared / np.hypot(1.0 - squared, 0.2)
    breakaway = friction * BREAKAWAY / (beta * OMEGA_N) ** 2
    moving = (1.0 - breakaway / a).clip(0.0)
    lag = np.arctan2(0.2, 1.0 - squared)
    # A sine with its crests cut off: flat (stuck) there, the flatter the nearer to breakaway.
    cut = 0.3 + 0.7 * moving
    sine = np.sin(phase - lag)
    swing = a * linear * moving
    stuck = (np.abs(sine) > cut) | (moving <= 0.0)
    velocity = swing * beta * OMEGA_N * np.cos(phase - lag) / cut
    return {
        "amplitude_ratio": linear * moving,
        "peak_to_peak": 2.0 * swing,
        "peak_velocity": swing * beta * OMEGA_N,
        "stick_fraction": stuck.mean("phase"),
        "stick_phases": 2.0 * (stuck.mean("phase") > 0.0),
        "periodicity": 0.1 * (beta == 0.6) * (a > 3e-4),
        "period": -1.0 + 0.0 * a,
        "lift_off_fraction": (0.4 * (a * beta**2 > 5e-4)).where(moving > 0.0),
        "displacement": swing * sine.clip(-cut, cut) / cut,
        "velocity": velocity.where(~stuck, 0.0),
        "stuck": stuck,
        "phase_lag": lag,
    }


def _fail(ds: xr.Dataset, at: dict[str, int]) -> None:
    """Turn one case into a failure: a status, a message and NaN."""
    at = {name: min(place, ds.sizes[name] - 1) for name, place in at.items()}
    for name in ds.data_vars:
        if ds[name].dtype.kind == "f":
            ds[name][at] = np.nan
    ds["stuck"][at] = 0
    ds["status"][at] = STATUSES.index("time_limit")
    ds["message"][at] = "stopped after 60 s"
