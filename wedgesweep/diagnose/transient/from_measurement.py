"""Measured signals to the windows that are fitted."""

import numpy as np

from wedgesweep.diagnose.evaluation import Point, Scenario
from wedgesweep.diagnose.noise_bins import PARTS
from wedgesweep.diagnose.noise_spectrum import NoiseSpectrum
from wedgesweep.diagnose.transient.cutting import FEWEST, Recorded, windows
from wedgesweep.diagnose.transient.noise import Channels, Spectra, from_repeats, noise_of_channels
from wedgesweep.diagnose.transient.recorded_input import RecordedInput
from wedgesweep.diagnose.transient.transient_data import TransientData
from wedgesweep.diagnose.transient.window import RecordWindow
from wedgesweep.errors import InputError
from wedgesweep.measured import Measurement, TestRecord
from wedgesweep.measured.declarations import MOTIONS

# Windows that are compared: more of them take time, and tell little that is new.
MOST_WINDOWS = 40


def transient_data(measurement: Measurement) -> TransientData:
    """Windows of all tests, with the noise of their inputs as the base model as stated passes it on."""
    data = recorded_windows(measurement)
    return data.with_input_noise(Scenario({}, Point(np.zeros(0), *data.start())))


def recorded_windows(measurement: Measurement) -> TransientData:
    """Windows of all tests, without what noise of their inputs adds."""
    tests = measurement.tests
    channels = [_channels(measurement, test) for test in tests]
    spectra = _noise(measurement, channels)
    fewest = FEWEST if len(tests) == 1 else 1
    by_test: list[list[RecordWindow]] = []
    for number, test in enumerate(tests):
        own = {order: spectra[number, order] for order in channels[number]}
        try:
            _refuse_noise(channels[number], own)
            record = _record(measurement, number, channels[number], list(own.values()))
            by_test.append(windows(record, measurement.model_of(test), measurement.law, fewest))
        except InputError as error:
            raise InputError([f"{test.file}: {problem}" for problem in error.problems]) from error
    found = _spread(by_test)
    return TransientData(
        tuple(found),
        measurement.uncertain_of_records,
        measurement.model_error,
        measurement.input_gain_std if any(own.driven for own in found) else 0.0,
    )


def _spread(by_test: list[list[RecordWindow]]) -> list[RecordWindow]:
    """At most MOST_WINDOWS, at even distances in each record, but the first one of each record at least."""
    share = min(MOST_WINDOWS / sum(map(len, by_test)), 1.0)
    counts = [max(round(share * len(own)), 1) for own in by_test]
    return [
        own[place]
        for own, count in zip(by_test, counts, strict=True)
        for place in np.linspace(0, len(own) - 1, count).round().astype(int)
    ]


def _channels(measurement: Measurement, test: TestRecord) -> Channels:
    """Channels as recorded that are measurements of their own."""
    return {MOTIONS.index(name): test.responses[name] for name in measurement.compared(test)}


def _noise(measurement: Measurement, channels: list[Channels]) -> Spectra:
    """The noise of each channel of each test, by number and order."""
    orders = {order for own in channels for order in own}
    of = {order: measurement.motion_of(MOTIONS[order]) for order in orders}
    found = noise_of_channels(channels, of, [test.sampling_rate for test in measurement.tests])
    repeated = from_repeats(measurement.tests, channels)
    return found | {key: each.up_to(found[key].highest) for key, each in repeated.items()}


def _refuse_noise(channels: Channels, spectra: dict[int, NoiseSpectrum]) -> None:
    """Raise InputError if the motion is smaller than the noise of all channels in the loudest part."""
    shares = []
    for order, samples in channels.items():
        largest, std = max(part.std() for part in np.array_split(samples, PARTS)), spectra[order].std
        shares.append(std / max(float(np.sqrt(max(largest**2 - std**2, 0.0))), 1e-300))
    if min(shares) > 1.0:
        problem = f"noise is {100.0 * min(min(shares), 9.99):.0f} % of the motion where that is largest"
        raise InputError([f"{problem}; excite more, or measure it with less noise"])


def _record(
    measurement: Measurement, number: int, channels: Channels, spectra: list[NoiseSpectrum]
) -> Recorded:
    """The record of a test, its channels as the motion that is simulated."""
    test, given = measurement.tests[number], None
    if test.input is not None and measurement.recorded_input is not None:
        given = RecordedInput(test.input, measurement.recorded_input, test.sampling_rate)
    factors = [measurement.factors_of(MOTIONS[order]) for order in channels]
    converted = [
        factor * samples + (share * given.derivative(order) if given and share else 0.0)
        for (order, samples), (factor, share) in zip(channels.items(), factors, strict=True)
    ]
    shares = tuple(share for _, share in factors)
    orders = tuple(channels)
    return Recorded(
        test.name, np.array(converted), test.sampling_rate, spectra, given, number, orders, shares
    )
