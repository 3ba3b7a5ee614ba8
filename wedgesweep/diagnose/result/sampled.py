"""What is stored of tests that are compared sample by sample: loops and transients."""

from typing import Any

import numpy as np
import xarray as xr

from wedgesweep.diagnose.diagnosis import Diagnosis
from wedgesweep.diagnose.loop.loop_data import LoopData
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.result import stored
from wedgesweep.diagnose.result.estimates import finite
from wedgesweep.diagnose.result.stored import Variables
from wedgesweep.diagnose.transient.transient_data import TransientData
from wedgesweep.diagnose.transient.window import RecordWindow
from wedgesweep.sweep import labels

BY_SAMPLE, BY_CHANNEL = ("test", "sample"), ("test", "channel", "sample")
CHANNELS, CHANNEL_UNIT = ("displacement", "velocity", "acceleration"), "m, m/s or m/s^2"


def _fits(found: Diagnosis) -> dict[str, Fit]:
    return {"base": found.base.fit, "extended": found.extended}


def tests(found: Diagnosis, data: LoopData | TransientData) -> list[dict[str, Any]]:
    """Rows of the tests for diagnosis.json; errors are the rms of the residual over that of the response."""
    fits = _fits(found)
    errors = {name: data.error(fit.evaluation) for name, fit in fits.items()}
    own = _of_loops(data) if isinstance(data, LoopData) else _of_transients(data, found.extended)
    return [
        {
            "name": name,
            **own[t],
            "samples": int(data.observations[t]),
            **{f"error_{model}": finite(error[t]) for model, error in errors.items()},
            **{f"q_{model}": finite(fit.evaluation.chi2_by_test[t]) for model, fit in fits.items()},
            "dof": int(data.dof[t]),
        }
        for t, name in enumerate(data.names)
    ]


def _of_loops(data: LoopData) -> list[dict[str, Any]]:
    recordings = [data.recordings[number] for number, _ in data.chosen]
    return [
        {
            "lowpass_hz": finite(own.low_pass.cutoff),
            "noise_force_N": finite(own.noise),
            "noise_from": own.spectrum.source,
            "noise_correlation": finite(own.spectrum.correlation),
            "noise_velocity_mm_per_s": finite(1e3 * own.motion.noise[1]),
        }
        for own in recordings
    ]


def _of_transients(data: TransientData, fit: Fit) -> list[dict[str, Any]]:
    """What is special to transients in the rows; starts are those of the extended model."""
    starts = 1e3 * data.starts(fit.point)
    return [
        {
            "begins_s": finite(own.begins),
            "duration_s": finite(own.step * own.channels.shape[1]),
            "highest_hz": finite(0.5 * own.coefficients / (own.step * own.channels.shape[1])),
            "noise_from": own.spectra[0].source,
            "noise_correlation": finite(own.spectra[0].correlation),
            "natural_periods": finite(own.natural),
            "start_s": finite(own.starts_at),
            "start_mm": finite(start[0]),
            "start_mm_per_s": finite(start[1]),
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
        key: finite(size * std[order]) if order in std else None
        for order, (key, size) in enumerate(zip(keys, sizes, strict=True))
    }


def dataset(found: Diagnosis, data: LoopData | TransientData) -> xr.Dataset:
    """Measured and simulated samples (SI units), NaN where nothing is compared."""
    simulated = np.array([data.with_zero(fit.evaluation) for fit in _fits(found).values()])
    about = {"kind": data.kind, **labels.attributes(data.model)}
    if isinstance(data, LoopData):
        return stored.dataset(found, _loops(data, simulated), {}, **about)
    channels = [CHANNELS[order] for order in _orders(data)]
    return stored.dataset(found, _transients(data, simulated), {"channel": channels}, **about)


def _loops(data: LoopData, simulated: np.ndarray) -> Variables:
    """Forces along the imposed motion."""
    shown = np.where(data.seen, 1.0, np.nan)
    position, velocity = (
        data.padded([getattr(own.motion, name)[own.places] for own in data.recordings]) * shown
        for name in ("displacement", "velocity")
    )
    return {
        "displacement": (BY_SAMPLE, position, "m", "imposed displacement"),
        "velocity": (BY_SAMPLE, velocity, "m/s", "imposed velocity"),
        "measured_force": (BY_SAMPLE, data.measured * shown, "N", "measured force"),
        "simulated_force": (("model", *BY_SAMPLE), simulated * shown, "N", "simulated, with the fitted zero"),
        "force_noise": (
            ("test",),
            np.array([data.recordings[number].noise for number, _ in data.chosen]),
            "N",
            "noise of a compared force",
        ),
    }


def _orders(data: TransientData) -> tuple[int, ...]:
    """Derivatives of the displacement that any test recorded."""
    return max((own.orders for own in data.windows), key=len)


def _transients(data: TransientData, simulated: np.ndarray) -> Variables:
    """Motions in time; simulated ones have the frequencies that are compared."""
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
    return {
        "time": (BY_SAMPLE, time, "s", "time from the first sample of the record"),
        "measured": (BY_CHANNEL, measured, CHANNEL_UNIT, "measured motion"),
        "simulated": (
            ("model", *BY_CHANNEL),
            in_time,
            CHANNEL_UNIT,
            "simulated motion, with the fitted zero",
        ),
        "sample_noise": (
            ("test", "channel"),
            np.array([[each.std for each in own.spectra] for own in data.windows]),
            CHANNEL_UNIT,
            "noise of a sample",
        ),
    }
