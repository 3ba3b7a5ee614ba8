"""Steady responses of a system to tests, from a sweep over them."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from validation.rigs import Rig
from wedgesweep.config import from_document
from wedgesweep.sweep.run import Sweep

Effects = Mapping[str, Mapping[str, float]]
TONE = "stray_vibration"
HARMONICS, SAMPLES = 16, 128
STEADY = {"settle": "steady", "kept_periods": 2, "max_periods": 300}
# A response under a stray tone does not repeat. It is observed for about as long as a record is.
UNDER_TONE = {"settle_periods": 40, "kept_periods": 8}


class Test(NamedTuple):
    """Frequency and input amplitude (mm, of a force N) of one test."""

    frequency_hz: float
    amplitude: float


class System(NamedTuple):
    """A rig with effects, whose parameters are in the units of their keys."""

    law: str
    rig: Rig
    effects: Effects = {}  # noqa: RUF012 - never changed

    def document(self) -> dict[str, Any]:
        """Its config, but for the tests."""
        return self.rig.document(self.law, self.effects)

    def test_keys(self, test: Test) -> dict[str, float]:
        """A test as a config and a plan of tests write it."""
        return {"frequency_hz": test.frequency_hz, self.rig.amplitude_key: test.amplitude}


def run(system: System, tests: Sequence[Test]) -> xr.Dataset:
    """Dataset of the tests along the dimension ``case``; NaN where there is no steady response."""
    window = UNDER_TONE if TONE in system.effects else STEADY
    given = system.document()
    cases = [{"friction_law": system.law, **system.test_keys(test)} for test in tests]
    driven = {key: value for key, value in given["sweep"].items() if key == "excitation"}
    document = given | {
        "sweep": {"case": cases, **driven},
        "solver": {"method": "event-driven", "samples_per_period": SAMPLES, **window},
    }
    return Sweep(from_document(document), Path()).run_here()


def spectra(system: System, tests: Sequence[Test]) -> np.ndarray:
    """Complex harmonics of displacement (m) and velocity (m/s), shape (tests, 2, HARMONICS + 1).

    The last column is the amplitude of what does not repeat from period to period: the stray tone.
    NaN where there is no steady response.
    """
    ds = run(system, tests)
    signals = np.stack([ds["displacement"], ds["velocity"]], axis=1).astype(float)
    periods = signals.reshape(*signals.shape[:2], -1, SAMPLES)
    mean = periods.mean(axis=-2)
    tone = np.sqrt(2.0 * ((periods - mean[..., None, :]) ** 2).mean(axis=(-2, -1)))
    return np.concatenate([harmonics(mean), tone[..., None]], axis=-1)


def harmonics(period: np.ndarray) -> np.ndarray:
    """Complex harmonics of signals over one period, shape (..., samples) to (..., HARMONICS)."""
    return 2.0 / period.shape[-1] * np.fft.rfft(period)[..., 1 : HARMONICS + 1]
