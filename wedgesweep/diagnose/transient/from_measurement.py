"""Measured signals to the free motions that are fitted."""

import numpy as np

from wedgesweep.diagnose.transient.release import Release, release
from wedgesweep.diagnose.transient.transient_data import TransientData
from wedgesweep.measured import Measurement, TestRecord


def transient_data(measurement: Measurement) -> TransientData:
    """Free motions of all tests."""
    releases = tuple(_release(measurement, test) for test in measurement.tests)
    return TransientData(releases, dict(measurement.uncertain), measurement.model_error)


def _release(measurement: Measurement, test: TestRecord) -> Release:
    recorded = (test.displacement, None if measurement.derived_velocity else test.velocity)
    channels = np.array([each for each in recorded if each is not None])
    return release(test.name, measurement.model_of(test), measurement.law, test.sampling_rate, channels)
