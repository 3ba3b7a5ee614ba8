"""Measured signals to the loops that are fitted."""

from wedgesweep.diagnose.loop.loop_data import LoopData
from wedgesweep.diagnose.loop.recording import recording
from wedgesweep.measured import Measurement


def loop_data(measurement: Measurement) -> LoopData:
    """Loops of all tests, in blocks."""
    recordings = tuple(
        recording(
            test.name,
            measurement.model_of(test),
            measurement.law,
            test.sampling_rate,
            (test.displacement, test.force),
            test.cutoff,
        )
        for test in measurement.tests
    )
    chosen = tuple((i, block) for i, own in enumerate(recordings) for block in range(len(own.blocks)))
    return LoopData(recordings, chosen, dict(measurement.uncertain), measurement.model_error)
