"""Plausibility of channels and amplitudes: detects wrong units and signs."""

import numpy as np

from wedgesweep.measured.cycles import cut
from wedgesweep.measured.declarations import STEADY
from wedgesweep.measured.frequency import stands_out
from wedgesweep.measured.measurement import Measurement, TestRecord

# Tolerated errors of gain and phase between the channels.
FACTOR, ANGLE = 10.0, np.radians(120.0)
# Limits of the motion over the input amplitude: more than any two resonances give, and less than wherever the
# bolster slips. As it may stick in one test, the lower limit must fail in all tests, FEWEST_TESTS or more.
LARGEST_RATIO, LEAST_RATIO, FEWEST_TESTS = 300.0, 0.01, 2


def channel_faults(test: TestRecord, file: str) -> list[str]:
    """Faults of and between the channels of a test whose frequency is correct."""
    if test.normal_force is not None and (mean := float(test.normal_force.mean())) <= 0.0:
        fault = f"normal_force is {mean:.3g} N on average, but what rubs presses"
        return [f"{file}: {fault}; write sign = -1 in measurement.columns, or correct its zero"]
    if test.velocity is None or test.displacement is None:
        return []
    at = test.refined_frequency
    moved, speed = (_fundamental(test, signal) for signal in (test.displacement, test.velocity))
    if not (moved and speed):
        return []
    expected = 2j * np.pi * at * moved
    share = abs(speed / expected)
    if not 1.0 / FACTOR < share < FACTOR:
        fault = f"velocity is {share:.2g} times the rate of displacement at {at:.4g} Hz"
        return [f"{file}: {fault}; correct the units in measurement.columns, or the columns"]
    if abs(np.angle(speed / expected)) > ANGLE:
        fault = "velocity and displacement have opposite signs; velocity must be the rate of displacement"
        return [f"{file}: {fault}; change the sign of one"]
    return []


def amplitude_faults(measurement: Measurement) -> list[str]:
    """Faults of the stated input amplitudes."""
    moved = {
        test.file: abs(_fundamental(test, test.displacement)) / _deflection(measurement, test)
        for test in measurement.tests
        if test.amplitude is not None and test.displacement is not None
    }
    key = measurement.model.amplitude_unit.key
    per = f"the deflection at rest under its {key}" if measurement.model.forced else f"its {key}"
    faults = [
        f"{file} moves {share:.3g} times {per}; correct one of them"
        for file, share in moved.items()
        if share > LARGEST_RATIO
    ]
    if len(moved) >= FEWEST_TESTS and 0.0 < max(moved.values()) < LEAST_RATIO:
        most = max(moved, key=lambda file: moved[file])
        fault = f"no test moves more than {moved[most]:.2g} times {per} ({most})"
        faults.append(f"{fault}; correct them, or omit them if they are unknown")
    return faults


def noise_faults(measurement: Measurement) -> list[str]:
    """Responses without a vibration: one test may stick, but if all do there is nothing to compare."""
    steady = [test for test in measurement.tests if test.kind == STEADY]
    if not steady or any(
        _fundamental(test, samples) for test in steady for samples in test.responses.values()
    ):
        return []
    frequencies = ", ".join(dict.fromkeys(f"{test.refined_frequency:.4g}" for test in steady))
    fault = f"no test has a vibration at its frequency ({frequencies} Hz) that stands out of the noise"
    return [f"{fault}; correct the columns or frequency_hz, or excite more"]


def _deflection(measurement: Measurement, test: TestRecord) -> float:
    """Length (m) that the motion of a test of known amplitude is compared with."""
    assert test.amplitude is not None
    return test.amplitude * float(measurement.model_of(test).deflection(2.0 * np.pi * test.refined_frequency))


def _fundamental(test: TestRecord, signal: np.ndarray) -> complex:
    """Complex amplitude of the fundamental of a channel, 0 if it is not detected."""
    if not stands_out(test.time, signal, test.refined_frequency):
        return 0.0j
    return complex(cut(test.time, signal, test.refined_frequency).harmonics[:, 0].mean())
