"""What is reported and stored of transients: starts, noise, and motions in time."""

from typing import TYPE_CHECKING, Any

import numpy as np

from wedgesweep.diagnose.evaluation import Point
from wedgesweep.diagnose.fit_data import Arrays
from wedgesweep.diagnose.transient.window import RecordWindow
from wedgesweep.measured.declarations import MOTIONS

if TYPE_CHECKING:
    from wedgesweep.diagnose.transient.transient_data import TransientData

BY_SAMPLE, BY_CHANNEL = ("test", "sample"), ("test", "channel", "sample")
CHANNEL_UNIT = "m, m/s or m/s^2"


def described(data: "TransientData", point: Point) -> list[dict[str, Any]]:
    """Numbers of each window for diagnosis.json, with the starts of a point."""
    starts = 1e3 * data.starts(point)
    return [
        {
            "begins_s": own.begins,
            "duration_s": own.step * own.channels.shape[1],
            "highest_hz": 0.5 * own.coefficients / (own.step * own.channels.shape[1]),
            "noise_from": own.spectra[0].source,
            "noise_correlation": own.spectra[0].correlation,
            "natural_periods": own.natural,
            "start_s": own.starts_at,
            "start_mm": start[0],
            "start_mm_per_s": start[1],
            **_noise(own),
        }
        for own, start in zip(data.windows, starts, strict=True)
    ]


def _noise(own: RecordWindow) -> dict[str, Any]:
    """Noise of a sample of each channel; null where it was not recorded."""
    keys = ("noise_displacement_mm", "noise_velocity_mm_per_s", "noise_acceleration_m_per_s2")
    std = {order: each.std for order, each in zip(own.orders, own.spectra, strict=True)}
    sizes = (1e3, 1e3, 1.0)
    return {
        key: size * std[order] if order in std else None
        for order, (key, size) in enumerate(zip(keys, sizes, strict=True))
    }


def arrays(data: "TransientData", simulated: np.ndarray) -> Arrays:
    """Motions in time; simulated coefficients (2, T, m) have the frequencies that are compared."""
    channels = max(len(own.channels) for own in data.windows)
    longest = max(own.channels.shape[1] for own in data.windows)
    measured = np.full((data.tests, channels, longest), np.nan)
    in_time = np.full((len(simulated), *measured.shape), np.nan)
    for t, own in enumerate(data.windows):
        size, count = len(own.channels), own.channels.shape[1]
        measured[t, :size, :count] = own.channels
        part = simulated[:, t, : size * own.coefficients]
        in_time[:, t, :size, :count] = own.in_time(part.reshape(-1, size, own.coefficients))
    time = np.array([own.begins + own.step * np.arange(longest) for own in data.windows])
    noise = np.array([[each.std for each in own.spectra] for own in data.windows])
    meaning = "simulated motion, with the fitted zero"
    variables = {
        "time": (BY_SAMPLE, time, "s", "time from the first sample of the record"),
        "measured": (BY_CHANNEL, measured, CHANNEL_UNIT, "measured motion"),
        "simulated": (("model", *BY_CHANNEL), in_time, CHANNEL_UNIT, meaning),
        "sample_noise": (BY_CHANNEL[:2], noise, CHANNEL_UNIT, "noise of a sample"),
    }
    orders = max((own.orders for own in data.windows), key=len)
    return Arrays(variables, {"channel": [MOTIONS[order] for order in orders]})
