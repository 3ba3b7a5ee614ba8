"""Measured signals to the harmonics that are fitted."""

import numpy as np

from wedgesweep.diagnose.steady import tone
from wedgesweep.diagnose.steady.harmonic_data import HarmonicData
from wedgesweep.diagnose.steady.spectra import fitted, spectrum
from wedgesweep.effects import acting
from wedgesweep.measured import Measurement, TestRecord


def harmonic_data(measurement: Measurement) -> HarmonicData:
    """Spectra of all tests; a spurious tone is that of the base model, or it is looked for."""
    tests = measurement.tests
    signals = [_channels(test, measurement.derived_velocity) for test in tests]
    records = [(test.time, s, test.refined_frequency) for test, s in zip(tests, signals, strict=True)]
    found = tone.of(acting(measurement.model.effects)) or tone.find([fitted(*each) for each in records])
    spectra = tuple(spectrum(*each, found.frequency if found else None) for each in records)
    std = [test.amplitude_std if test.amplitude is not None else np.inf for test in tests]
    return HarmonicData(
        model=measurement.model,
        law=measurement.law,
        names=tuple(test.name for test in tests),
        spectra=spectra,
        amplitude=np.array([test.amplitude if test.amplitude else np.nan for test in tests]),
        amplitude_std=np.array(std),
        uncertain=dict(measurement.uncertain),
        tone=found.frequency if found else None,
        tone_std=found.std if found else 0.0,
        model_error=measurement.model_error,
    )


def _channels(test: TestRecord, derived_velocity: bool) -> np.ndarray:
    """Channels with information of their own, (C, n)."""
    if test.velocity is None or derived_velocity:
        return test.displacement[None]
    return np.array([test.displacement, test.velocity])
