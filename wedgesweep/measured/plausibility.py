"""Whether channels and amplitudes fit together: units and signs that are mixed up show."""

from collections.abc import Sequence

import numpy as np

from wedgesweep.measured.cycles import cut
from wedgesweep.measured.frequency import stands_out
from wedgesweep.measured.measurement import TestRecord

# Sensors may lag, and their gain be off, by less than this.
FACTOR, ANGLE = 10.0, np.radians(120.0)
# Relative motion over the amplitude of the table: more than at any two resonances, and less than wherever
# something moves. In one test alone the bolster may just stick.
MOST, LEAST, SEVERAL = 300.0, 0.01, 2


def channel_faults(test: TestRecord, file: str) -> list[str]:
    """What is wrong between the channels of a test whose frequency is in order."""
    if test.velocity is None:
        return []
    at = test.refined_frequency
    moved, speed = (_fundamental(test, signal) for signal in (test.displacement, test.velocity))
    if not (moved and speed):
        return []
    expected = 2j * np.pi * at * moved
    share = abs(speed / expected)
    if not 1.0 / FACTOR < share < FACTOR:
        told = f"velocity is {share:.2g} times what displacement makes at {at:.4g} Hz"
        return [f"{file}: {told}; correct the units in measurement.columns, or the columns"]
    if abs(np.angle(speed / expected)) > ANGLE:
        told = "velocity falls where displacement rises; both are side frame minus bolster"
        return [f"{file}: {told}; turn the sign of one"]
    return []


def amplitude_faults(tests: Sequence[TestRecord]) -> list[str]:
    """What is wrong with the input amplitudes, as far as they are stated."""
    moved = {
        test.file: abs(_fundamental(test, test.displacement)) / test.amplitude
        for test in tests
        if test.amplitude is not None
    }
    faults = [
        f"{file} moves {share:.3g} times its amplitude_mm; correct one of them"
        for file, share in moved.items()
        if share > MOST
    ]
    if len(moved) >= SEVERAL and 0.0 < max(moved.values()) < LEAST:
        most = max(moved, key=lambda file: moved[file])
        told = f"no test moves more than {moved[most]:.2g} times its amplitude_mm ({most})"
        faults.append(f"{told}; correct them, or leave them out where they are unknown")
    return faults


def _fundamental(test: TestRecord, signal: np.ndarray) -> complex:
    """Complex amplitude of the fundamental of a channel, 0 where it is lost in noise."""
    if not stands_out(test.time, signal, test.refined_frequency):
        return 0.0j
    return complex(cut(test.time, signal, test.refined_frequency).harmonics[:, 0].mean())
