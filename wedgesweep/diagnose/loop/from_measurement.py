"""Measured signals to the loops that are fitted."""

from wedgesweep.diagnose.loop.loop_data import LoopData
from wedgesweep.diagnose.loop.recording import Recording, recording
from wedgesweep.measured import Measurement, TestRecord


def loop_data(measurement: Measurement) -> LoopData:
    """Loops of all tests, in blocks."""
    recordings = tuple(_recording(measurement, test) for test in measurement.tests)
    chosen = tuple((i, block) for i, own in enumerate(recordings) for block in range(len(own.blocks)))
    return LoopData(recordings, chosen, dict(measurement.uncertain), measurement.model_error)


def _recording(measurement: Measurement, test: TestRecord) -> Recording:
    assert test.displacement is not None
    assert test.force is not None
    model = measurement.model_of(test)
    signals = test.displacement, test.force
    return recording(test.name, model, measurement.law, test.sampling_rate, signals, test.cutoff)
