"""Steady tests under a sine, to choose a next test from."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from math import nan, pi, sqrt

import numpy as np

from wedgesweep.diagnose.evaluation import Point, Scenario
from wedgesweep.diagnose.fit_data import INPUT_GAIN
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.next_test.designs import Design
from wedgesweep.diagnose.next_test.sensors import Sensors
from wedgesweep.diagnose.steady import simulation
from wedgesweep.diagnose.steady.column_load import CHANNEL
from wedgesweep.diagnose.steady.harmonic_data import HarmonicData
from wedgesweep.diagnose.steady.spectra import Spectrum
from wedgesweep.diagnose.steady.tone import TONE
from wedgesweep.diagnose.transient.cutting import HARMONICS, WINDOW
from wedgesweep.effects import acting
from wedgesweep.measured.declarations import STEADY
from wedgesweep.natural_units import ACCELERATION, FREQUENCY
from wedgesweep.solvers.periodic import Warm

# Frequencies (Hz) of the tests to choose from, for a rig like the bench; see natural_units.
FREQUENCIES = np.array([4.0, 6.0, 8.0, 10.0, 12.0, 14.0, 16.0, 20.0, 24.0, 28.0, 32.0, 36.0])
# Their input amplitudes as peak accelerations (m/s^2), of the mass under a force: what a test costs, and what
# the bench can take.
ACCELERATIONS = np.geomspace(0.3, 4.0, 8)
# How well the amplitude of a new test is taken to be known.
AMPLITUDE_STD = 0.02


@dataclass(frozen=True)
class SineTests(HarmonicData):
    """Steady tests that were not made; ``foreign_tone`` (Hz) shows under the effect TONE, in any phase."""

    foreign_tone: float | None = None

    def has_tone(self, effects: Iterable[str]) -> bool:
        return self.foreign_tone is not None and TONE in {*acting(self.model.effects), *effects}

    def records(self, scenario: Scenario) -> np.ndarray:
        values = {name: each for name, each in scenario.values.items() if name != INPUT_GAIN}
        return super().records(scenario._replace(values=values))

    def _respond(self, rows: np.ndarray, toned: bool, warm: Warm, tolerance: float) -> simulation.Responses:
        if not toned or self.foreign_tone is None:
            return simulation.respond(rows, warm, self.shape[1], tolerance)
        untimed = (simulation.ToneTiming(simulation.UNTIMED, 0.0, nan),) * len(rows)
        return simulation.respond_with_tone(rows, warm, self.shape[1], self.foreign_tone, untimed, tolerance)


def sines(best: Fit, known: Sensors, measured: HarmonicData | None) -> Design:
    """Sines on a grid of frequencies and amplitudes, as noisy as the steady tests if any were made."""
    own, model, unit = best.model.data, known.model, known.model.amplitude_unit
    frequency, acceleration = (each.ravel() for each in np.meshgrid(FREQUENCIES, ACCELERATIONS))
    frequency = own.units.ratio(FREQUENCY) * frequency
    acceleration = own.units.ratio(ACCELERATION) * acceleration
    omega = 2.0 * pi * frequency
    amplitude = own.units.mass * acceleration if model.forced else acceleration / omega**2
    shape = (len(known.spectra), int(HARMONICS))
    if measured is not None:
        shape = min(measured.shape[0], CHANNEL), measured.shape[1]
    nothing = np.zeros(shape)
    empty = [
        Spectrum(float(f), WINDOW, 0, 0.0, nothing + 0.0j, nothing + 1.0, 0.0j, nothing[:, :0], ())
        for f in frequency
    ]
    data = SineTests(
        model=model,
        law=known.law,
        names=("",) * omega.size,
        spectra=tuple(empty),
        amplitude=amplitude,
        amplitude_std=np.full(omega.size, AMPLITUDE_STD),
        uncertain=dict(own.uncertain),
        model_error=own.model_error,
        foreign_tone=None if measured is None else measured.tone,
    )
    here = best.model.on(data).evaluate(Point(best.x, *data.start()))
    share = _noise(known) if measured is None else _measured_noise(measured)
    # A response that does not exist stands for one as large as that of the frictionless rig.
    free = model.deflection(omega) * amplitude * omega ** np.arange(shape[0])[:, None]
    spectra = [
        replace(each, mean=mean, variance=nothing + (share * np.where(size > 0.0, size, other))[:, None] ** 2)
        for each, mean, size, other in zip(
            empty,
            here.response.harmonics,
            np.linalg.norm(here.response.harmonics, axis=-1),
            free.T,
            strict=True,
        )
    ]
    numbers = [
        {"frequency_hz": float(f), unit.key: float(a) / unit.factor}
        for f, a in zip(frequency, amplitude, strict=True)
    ]
    grid = ACCELERATIONS.size, FREQUENCIES.size
    return Design(STEADY, None, replace(data, spectra=tuple(spectra)), numbers, grid)


def _measured_noise(data: HarmonicData) -> float:
    """Noise of a harmonic over the response in the tests that were made, their median."""
    level = [s.variance.mean(axis=1) / (np.abs(s.mean) ** 2).sum(axis=1) for s in data.spectra]
    return float(np.median(np.sqrt(np.concatenate(level))))


def _noise(known: Sensors) -> float:
    """Noise of a harmonic over the response, from that of a sample over its rms."""
    return known.share * sqrt(known.omega / (pi * WINDOW * known.rate))
