"""Releases from a displacement, and sine-sweeps of the input, to choose a next test from."""

from dataclasses import replace
from math import ceil, pi, sqrt

import numpy as np

from wedgesweep.diagnose.evaluation import Point
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.next_test.designs import SIZES, Design
from wedgesweep.diagnose.next_test.sensors import Sensors, beside_signal
from wedgesweep.diagnose.transient.cutting import FEWEST_COMPARED, HARMONICS, WINDOW
from wedgesweep.diagnose.transient.input_noise import InputNoise
from wedgesweep.diagnose.transient.recorded_input import no_input
from wedgesweep.diagnose.transient.transient_data import RELEASE, SWEEP, TransientData
from wedgesweep.diagnose.transient.window import Grid, RecordWindow
from wedgesweep.measured.declarations import TRANSIENT
from wedgesweep.sampled_input import from_samples

# Amplitude of a sweep over the travel where no input was recorded.
GENTLE = 0.1
# Length of a sweep in natural periods, and its ends over the natural frequency.
SWEPT, LOW, HIGH = 20.0, 0.5, 2.0
# Samples of a sweep in a period of its highest frequency, at least.
FINE = 32


def releases(best: Fit, known: Sensors, measured: TransientData | None = None) -> Design | None:
    """Releases at rest from displacements of several sizes; None without a spring, where the mass stays."""
    if known.model.system == "oscillator" and known.model.oscillator["spring"] == 0.0:
        return None
    starts, duration = SIZES * known.travel, WINDOW * 2.0 * pi / known.omega
    tests = tuple(_window(known, start, duration) for start in starts)
    numbers = [{"start_mm": 1e3 * start, "duration_s": duration} for start in starts]
    return Design(TRANSIENT, RELEASE, _data(best, known, tests), numbers, (SIZES.size, 1))


def sweeps(best: Fit, known: Sensors, measured: TransientData | None = None) -> Design:
    """Sweeps through the resonance from rest, of constant amplitude."""
    unit, natural = known.model.amplitude_unit, known.omega / (2.0 * pi)
    low, high, duration = LOW * natural, HIGH * natural, SWEPT / natural
    sizes = SIZES * (known.drive or GENTLE * known.travel)
    if known.model.forced:
        sizes = sizes * known.model.natural_units(known.travel).mass * known.omega**2
    count = max(ceil(known.rate * duration), ceil(FINE * high * duration))
    time = np.linspace(0.0, duration, count + 1)
    shape = np.sin(2.0 * pi * (low * time + (high - low) * time**2 / (2.0 * duration)))
    quantity = "force" if known.model.forced else "displacement"
    tests = []
    for size in sizes:
        given = from_samples(size * shape, duration / count, quantity, fastest=2.0 * pi * high)
        power = np.full(2, (known.share * size) ** 2 / 2.0)
        noise = InputNoise(power, 0, 2.0 * pi * high / known.rate, (0.0,) * len(known.spectra))
        tests.append(
            replace(_window(known, known.travel, duration), input=given, input_noise=noise, guess=(0.0, 0.0))
        )
    numbers = [
        {"frequency_hz": low, "to_hz": high, unit.key: size / unit.factor, "duration_s": duration}
        for size in sizes
    ]
    return Design(TRANSIENT, SWEEP, _data(best, known, tuple(tests)), numbers, (SIZES.size, 1))


def _window(known: Sensors, start: float, duration: float) -> RecordWindow:
    """A release from a displacement (m), of some duration (s), that was not recorded."""
    count = round(known.rate * duration)
    highest = HARMONICS * known.omega / known.rate
    return RecordWindow(
        name="",
        model=known.model,
        law=known.law,
        step=1.0 / known.rate,
        begins=0.0,
        number=0,
        channels=np.zeros((len(known.spectra), count)),
        rms=known.rms,
        spectra=known.spectra,
        coefficients=min(max(ceil(highest * count / pi), FEWEST_COMPARED), count),
        grid=Grid(0, count, known.omega),
        input=no_input(count / known.rate),
        input_noise=None,
        length=start,
        guess=(start, 0.0),
        orders=known.orders,
    )


def _data(best: Fit, known: Sensors, tests: tuple[RecordWindow, ...]) -> TransientData:
    """The tests as if the best explanation were measured, with the noise that sensors would have."""
    own = best.model.data
    gain_std = own.input_gain_std if any(each.driven for each in tests) else 0.0
    data = TransientData(tests, dict(own.uncertain), own.model_error, gain_std)
    nuisance, warm = data.start()
    found = best.model.on(data).evaluate(Point(best.x, nuisance, warm))
    return replace(
        data,
        windows=tuple(_filled(known, each, row) for each, row in zip(tests, found.response, strict=True)),
    )


def _filled(known: Sensors, own: RecordWindow, response: np.ndarray) -> RecordWindow:
    """The window with a response in place of a record, and with the noise that sensors have beside it."""
    shape = len(own.channels), own.coefficients
    channels = own.in_time(response[: shape[0] * shape[1]].reshape(shape))
    rms = channels.std(axis=1)
    # A recorded input has noise as well: as large a share as the response has.
    more = sqrt(2.0) if own.driven else 1.0
    both = zip(own.spectra, rms, known.rms, strict=True)
    spectra = tuple(beside_signal(*each).amplified(more) for each in both)
    return replace(own, channels=channels, rms=rms, spectra=spectra)
