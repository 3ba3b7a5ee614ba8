"""One period of the motion of a test."""

from typing import NamedTuple

import numpy as np
import xarray as xr


class Motion(NamedTuple):
    """Relative displacement (m) and velocity (m/s) over one period of the input."""

    displacement: np.ndarray
    velocity: np.ndarray


def motion(data: xr.Dataset, waveform: xr.DataArray, test: int) -> Motion:
    """Return the motion of a test; its velocity is differentiated where there is no such channel."""
    one = waveform.isel(test=test)
    displacement = one.sel(channel="displacement").values
    if "velocity" in data["channel"].values:
        velocity = one.sel(channel="velocity").values
        if np.isfinite(velocity).all():
            return Motion(displacement, velocity)
    return Motion(displacement, _rate(data, displacement, test))


def closed(values: np.ndarray) -> np.ndarray:
    """Repeat the first sample of a period at its end."""
    return np.append(values, values[:1])


def _rate(data: xr.Dataset, displacement: np.ndarray, test: int) -> np.ndarray:
    """Differentiate one period of a displacement (m); m/s."""
    orders = np.fft.rfftfreq(displacement.size, 1.0 / displacement.size)
    turn = 2j * np.pi * data["frequency"].values[test] * orders
    return np.fft.irfft(turn * np.fft.rfft(displacement), displacement.size)
