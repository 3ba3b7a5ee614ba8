"""Measured signals to the windows that are fitted."""

import numpy as np

from wedgesweep.diagnose import repeats
from wedgesweep.diagnose.noise_spectrum import FROM_REPEATS, NoiseSpectrum, of_noise, of_record
from wedgesweep.diagnose.transient.release import FEWEST, Recorded, Release, windows
from wedgesweep.diagnose.transient.transient_data import TransientData
from wedgesweep.measured import Measurement, TestRecord


def transient_data(measurement: Measurement) -> TransientData:
    """Windows of all tests."""
    tests = measurement.tests
    channels = [_channels(measurement, test) for test in tests]
    spectra = _spectra(tests, channels)
    fewest = FEWEST if len(tests) == 1 else 1
    found: list[Release] = []
    for number, (test, own, noise) in enumerate(zip(tests, channels, spectra, strict=True)):
        record = Recorded(test.name, own, test.sampling_rate, noise, number)
        found += windows(record, measurement.model_of(test), measurement.law, fewest)
    return TransientData(tuple(found), dict(measurement.uncertain), measurement.model_error)


def _channels(measurement: Measurement, test: TestRecord) -> np.ndarray:
    """Displacement and, where it is a measurement of its own, velocity, (C, n)."""
    recorded = (test.displacement, None if measurement.derived_velocity else test.velocity)
    return np.array([each for each in recorded if each is not None])


def _spectra(tests: tuple[TestRecord, ...], channels: list[np.ndarray]) -> list[list[NoiseSpectrum]]:
    """Noise of each channel of each test: from its repeats, or from the record itself."""
    found: list[list[NoiseSpectrum]] = [[of_record(each) for each in own] for own in channels]
    for rows in repeats.groups(tests):
        for place in range(len(channels[rows[0]])):
            left = repeats.differences([channels[row][place] for row in rows])
            noise = of_noise(left, FROM_REPEATS)
            for row in rows:
                found[row][place] = noise.up_to(found[row][place].highest)
    return found
