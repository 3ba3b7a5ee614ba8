"""Measured signals to the windows that are fitted."""

import numpy as np

from wedgesweep.diagnose.channel_factors import channel_factors
from wedgesweep.diagnose.noise_spectrum import NoiseSpectrum
from wedgesweep.diagnose.transient.cutting import FEWEST, Recorded, windows
from wedgesweep.diagnose.transient.noise import Channels, NoiseEvidence, evidence_of_noise, from_repeats
from wedgesweep.diagnose.transient.recorded_input import QUANTITIES_OF_MOTION, RecordedInput
from wedgesweep.diagnose.transient.transient_data import TransientData
from wedgesweep.diagnose.transient.window import RecordWindow
from wedgesweep.errors import InputError
from wedgesweep.measured import Measurement, TestRecord

# Parts of a record, in the loudest of which its motion must be larger than its noise.
PARTS = 8


def transient_data(measurement: Measurement) -> TransientData:
    """Windows of all tests."""
    tests = measurement.tests
    channels = [_channels(measurement, test) for test in tests]
    evidence, spectra = _noise(measurement, channels)
    fewest = FEWEST if len(tests) == 1 else 1
    found: list[RecordWindow] = []
    for number, test in enumerate(tests):
        model, given = measurement.model_of(test), _recorded_input(measurement, test)
        orders = tuple(QUANTITIES_OF_MOTION.index(name) for name in _names(measurement, test))
        record = Recorded(
            test.name, channels[number], test.sampling_rate, spectra[number], given, number, orders
        )
        record = _as_simulated(record, measurement)
        _refuse_noise(test.file, channels[number], spectra[number])
        try:
            found += windows(record, model, measurement.law, fewest)
        except InputError as error:
            raise InputError([f"{test.file}: {problem}" for problem in error.problems]) from error
    return TransientData(
        tuple(found),
        measurement.uncertain_of_records,
        measurement.model_error,
        measurement.input_gain_std if any(own.driven for own in found) else 0.0,
        evidence=evidence,
    )


def _refuse_noise(file: str, channels: np.ndarray, spectra: list[NoiseSpectrum]) -> None:
    """Raise InputError if the motion is smaller than the noise of all channels, where it is largest."""
    parts = [[part.std() for part in np.array_split(channel, PARTS)] for channel in channels]
    shares = [
        spectrum.std / max(float(np.sqrt(max(max(own) ** 2 - spectrum.std**2, 0.0))), 1e-300)
        for own, spectrum in zip(parts, spectra, strict=True)
    ]
    if min(shares) > 1.0:
        problem = f"noise is {100.0 * min(min(shares), 9.99):.0f} % of the motion where that is largest"
        raise InputError([f"{file}: {problem}; excite more, or measure it with less noise"])


def _names(measurement: Measurement, test: TestRecord) -> list[str]:
    """Channels that are measurements of their own."""
    derived = ("velocity",) if measurement.derived_velocity else ()
    return [name for name in QUANTITIES_OF_MOTION if getattr(test, name) is not None and name not in derived]


def _channels(measurement: Measurement, test: TestRecord) -> np.ndarray:
    """Channels (C, n) as recorded."""
    return np.array([getattr(test, name) for name in _names(measurement, test)])


def _recorded_input(measurement: Measurement, test: TestRecord) -> RecordedInput | None:
    if test.input is None or measurement.recorded_input is None:
        return None
    return RecordedInput(test.input, measurement.recorded_input, test.sampling_rate)


def _as_simulated(record: Recorded, measurement: Measurement) -> Recorded:
    """The record with its channels as the motion that is simulated."""
    test = measurement.tests[record.number]
    model = measurement.model_of(test)
    named = [measurement.columns[name].get("of", "relative") for name in _names(measurement, test)]
    both = [channel_factors(model, of) for of in named]
    channels = record.channels * np.array([factor for factor, _ in both])[:, None]
    shares = tuple(share for _, share in both)
    if record.input is not None:
        for own, order, share in zip(channels, record.orders, shares, strict=True):
            if share:
                own += share * record.input.derivative(order)
    return record._replace(channels=channels, shares=shares)


def _noise(
    measurement: Measurement, channels: list[np.ndarray]
) -> tuple[tuple[NoiseEvidence, ...], list[list[NoiseSpectrum]]]:
    """Evidence of the noise, and the noise of each channel of each test."""
    tests, orders = measurement.tests, range(len(QUANTITIES_OF_MOTION))
    declared = [measurement.columns.get(name, {}) for name in QUANTITIES_OF_MOTION]
    of = {order: declared[order].get("of", "relative") for order in orders}
    by_order: list[Channels] = [
        dict(zip(map(QUANTITIES_OF_MOTION.index, _names(measurement, test)), own, strict=True))
        for test, own in zip(tests, channels, strict=True)
    ]
    evidence = evidence_of_noise(by_order, of, [test.sampling_rate for test in tests])
    found = {key: each for one in evidence for key, each in one.bounds.most.items()}
    repeated = from_repeats(tests, by_order)
    found |= {key: each.up_to(found[key].highest) for key, each in repeated.items()}
    spectra = [[found[t, order] for order in sorted(its)] for t, its in enumerate(by_order)]
    return evidence, spectra
