"""Measured signals to the loops that are fitted."""

import numpy as np

from wedgesweep.diagnose import repeats
from wedgesweep.diagnose.loop.loop_data import LoopData
from wedgesweep.diagnose.loop.recording import Recording, recording
from wedgesweep.errors import InputError
from wedgesweep.measured import Measurement, TestRecord


def loop_data(measurement: Measurement) -> LoopData:
    """Loops of all tests, in blocks."""
    left: dict[int, list[np.ndarray]] = {}
    for rows in repeats.groups(measurement.tests):
        forces = [each for row in rows if (each := measurement.tests[row].force) is not None]
        left |= dict.fromkeys(rows, repeats.differences(forces))
    recordings = tuple(
        _recording(measurement, test, left.get(i, [])) for i, test in enumerate(measurement.tests)
    )
    chosen = tuple((i, block) for i, own in enumerate(recordings) for block in range(len(own.blocks)))
    return LoopData(recordings, chosen, measurement.uncertain_of_records, measurement.model_error)


def _recording(measurement: Measurement, test: TestRecord, differences: list[np.ndarray]) -> Recording:
    try:
        return recording(test, measurement.model_of(test), measurement.law, differences)
    except InputError as error:
        raise InputError([f"{test.file}: {problem}" for problem in error.problems]) from error
