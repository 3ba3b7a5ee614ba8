"""Steady tests that would separate the remaining explanations.

Each explanation predicts the harmonics of a test that was not made. Their distance counts only what cannot
be taken up by its own parameters, as uncertain as the data leave them, and by an amplitude that is known to
some percent (with the fit's covariance as prior). A test does not count where a candidate predicts sticking.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import combinations
from math import hypot, pi, sqrt
from typing import NamedTuple

import numpy as np

from wedgesweep.config import Config
from wedgesweep.diagnose.fit_data import INPUT_GAIN
from wedgesweep.diagnose.jacobian import STEP, derivatives
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.next_test.offer import (
    PREDICTED,
    Offer,
    covariance_root,
    least_distance,
)
from wedgesweep.diagnose.steady import simulation
from wedgesweep.diagnose.steady.harmonic_data import HarmonicData
from wedgesweep.diagnose.steady.tone import TONE
from wedgesweep.diagnose.steady.whitened import real
from wedgesweep.effects import acting
from wedgesweep.measured.declarations import STEADY
from wedgesweep.natural_units import ACCELERATION, FREQUENCY, NaturalUnits
from wedgesweep.solvers.periodic import Warm, at_rest
from wedgesweep.systems.records import stacked

# Frequencies (Hz) of the tests to choose from, for a rig like the bench; see natural_units.
FREQUENCIES = np.array([4.0, 6.0, 8.0, 10.0, 12.0, 14.0, 16.0, 20.0, 24.0, 28.0, 32.0, 36.0])
# Their input amplitudes as peak accelerations (m/s^2), of the mass under a force: what a test costs, and what
# the bench can take.
ACCELERATIONS = np.geomspace(0.3, 4.0, 8)
# A bolster whose fundamental is less than this share of the input sticks: there is nothing to fit.
MOVES = 1e-3
# Relative finite-difference step of the amplitude, and how well that of a new test is taken to be known.
AMPLITUDE_STEP, AMPLITUDE_STD = 2e-3, 0.02
# Harmonics that are compared, and natural periods of a test, where no steady test was made.
HARMONICS, PERIODS = 8, 10.0
# Derivative by the start phase, which is unknown, in units that make it as good as free.
FREE_PHASE = 1e3


@dataclass(frozen=True)
class Rig:
    """What a steady test would be like.

    It has C ``channels``; ``noise`` of a harmonic over the response includes the model error that is allowed.

    ``tone``: frequency (Hz) of a spurious tone, which shows under the effect ``TONE``.
    """

    model: Config
    law: str
    units: NaturalUnits
    channels: int
    noise: float
    harmonics: int = HARMONICS
    tone: float | None = None

    def has_tone(self, effects: Iterable[str]) -> bool:
        """Whether responses under these effects contain the tone."""
        return self.tone is not None and TONE in {*acting(self.model.effects), *effects}


def rig_of(data: HarmonicData) -> Rig:
    """New tests are as noisy as those that were made, and their model may be as wrong."""
    level = [
        np.sqrt(s.variance[c].mean() / (np.abs(s.mean[c]) ** 2).sum())
        for s in data.spectra
        for c in range(s.mean.shape[0])
    ]
    channels, harmonics = data.shape
    noise = hypot(float(np.median(level)), error_of(data.model_error, harmonics))
    return Rig(data.model, data.law, data.units, channels, noise, harmonics, data.tone)


def error_of(model_error: float, harmonics: int) -> float:
    """Model error of a harmonic over the response, from that of the response."""
    return model_error / sqrt(harmonics)


def noise_of(share: float, samples: float) -> float:
    """Noise of a harmonic over the response, from that of a sample over its rms.

    ``samples``: in a natural time, of which a test lasts PERIODS times 2 pi.
    """
    return share * sqrt(2.0 / (2.0 * pi * PERIODS * samples))


class Conditions(NamedTuple):
    """Angular frequencies (rad/s) and input amplitudes (m or N) of n tests."""

    omega: np.ndarray
    amplitude: np.ndarray


@dataclass(frozen=True)
class _Prediction:
    """Harmonics (n, C, H) of n tests, and their derivatives (n, C, H, j) in standard deviations.

    ``moves`` (n,): whether the bolster is predicted to move; ``found`` (n,): whether there is a prediction.
    """

    harmonics: np.ndarray
    spread: np.ndarray
    found: np.ndarray
    moves: np.ndarray


def offer(fits: Sequence[Fit], rig: Rig) -> Offer:
    """Steady tests to choose from, and what they separate."""
    frequency, acceleration = (each.ravel() for each in np.meshgrid(FREQUENCIES, ACCELERATIONS))
    frequency, acceleration = (
        rig.units.ratio(FREQUENCY) * frequency,
        rig.units.ratio(ACCELERATION) * acceleration,
    )
    omega, unit = 2.0 * np.pi * frequency, rig.model.amplitude_unit
    tests = Conditions(omega, rig.units.mass * acceleration if rig.model.forced else acceleration / omega**2)
    predicted = [(fit, _predict(fit, tests, rig)) for fit in fits]
    predicted = [each for each in predicted if each[1].found.mean() >= PREDICTED]
    weight = _weights(rig, [prediction for _, prediction in predicted]) if predicted else np.zeros(0)
    pairs = combinations([prediction for _, prediction in predicted], 2)
    grid = ACCELERATIONS.size, FREQUENCIES.size
    distances = [_distances(*pair, weight).reshape(grid) for pair in pairs]
    numbers = [
        {"frequency_hz": float(f), unit.key: float(a) / unit.factor}
        for f, a in zip(frequency, tests.amplitude, strict=True)
    ]
    return Offer(STEADY, None, [fit for fit, _ in predicted], np.array(distances), numbers)


def _predict(fit: Fit, tests: Conditions, rig: Rig) -> _Prediction:
    steps = np.r_[STEP * fit.model.scale, AMPLITUDE_STEP]
    nothing = np.zeros((1, steps.size))
    here, found, warm = _responses(fit, rig, tests, nothing, at_rest(tests.omega.size))

    def changes(moves: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        there, found, _ = _responses(fit, rig, tests, moves, warm.repeated(len(moves)))
        return there - here, found

    change = derivatives(changes, steps, np.full(steps.size, True))
    by_x, by_amplitude = change.values[..., :-1], change.values[..., -1:]
    spread = np.concatenate([by_x @ covariance_root(fit), by_amplitude * AMPLITUDE_STD], axis=-1)
    known = found[0] & change.found.all(axis=0)
    deflection = rig.model.deflection(tests.omega) * tests.amplitude
    moves = known & (np.abs(here[0, :, 0, 0]) > MOVES * deflection)
    return _Prediction(here[0], spread, known, moves)


def _responses(
    fit: Fit, rig: Rig, tests: Conditions, steps: np.ndarray, warm: Warm
) -> tuple[np.ndarray, np.ndarray, Warm]:
    """Harmonics (j, n, C, H) of n tests with x and amplitude moved by ``steps`` (j, k + u + 1), if found.

    The last step is the relative one of the amplitude.
    """
    model = fit.model
    rows = [
        simulation.records(
            rig.model,
            rig.law,
            {name: each for name, each in model.values(fit.x + step[:-1]).items() if name != INPUT_GAIN},
            tests.omega,
            tests.amplitude * (1.0 + step[-1]),
        )
        for step in steps
    ]
    done = _simulated(fit, rig, stacked(rows), warm)
    harmonics = done.harmonics[:, : rig.channels, : rig.harmonics]
    harmonics = harmonics.reshape(len(steps), tests.omega.size, rig.channels, rig.harmonics)
    return harmonics, done.found.reshape(len(steps), -1), done.warm


def _simulated(fit: Fit, rig: Rig, rows: np.ndarray, warm: Warm) -> simulation.Responses:
    """Responses of tests that nobody made, in which a spurious tone may have any phase."""
    harmonics, tone = rig.harmonics, rig.tone
    if tone is None or not rig.has_tone(fit.effects):
        return simulation.respond(rows, warm, harmonics)
    unknown = np.full(len(rows), np.nan)
    untimed = (simulation.ToneTiming(simulation.UNTIMED, 0.0, np.nan),) * len(rows)
    return simulation.respond_with_tone(rows, warm, harmonics, tone, untimed, unknown)


def _weights(rig: Rig, predictions: Sequence[_Prediction]) -> np.ndarray:
    """One over the noise of a real part (n, C, 1), if new tests are as noisy as those made.

    The noise is relative to the first prediction that exists, as a wedge may lock under some of them.
    """
    size = np.ones((*predictions[0].harmonics.shape[:2], 1))
    for each in reversed(predictions):
        own = np.sqrt((np.abs(each.harmonics) ** 2).sum(-1, keepdims=True))
        size = np.where(each.found[:, None, None] & (own > 0.0), own, size)
    return np.sqrt(2.0) / (rig.noise * size)


def _distances(a: _Prediction, b: _Prediction, weight: np.ndarray) -> np.ndarray:
    """Squared distances (n,) of two predictions beyond start phase and everything that is uncertain."""
    distance = np.zeros(len(a.harmonics))
    orders = np.arange(1, a.harmonics.shape[-1] + 1)
    for i in np.flatnonzero(a.moves & b.moves):
        turn = np.angle((a.harmonics[i] * b.harmonics[i].conj())[:, 0].sum())
        other = b.harmonics[i] * np.exp(1j * orders * turn)
        gap = real((weight[i] * (a.harmonics[i] - other))[None])[0]
        columns = [weight[i] * 1j * orders * a.harmonics[i] * FREE_PHASE]
        columns += [weight[i] * a.spread[i, ..., k] for k in range(a.spread.shape[-1])]
        rotated = b.spread[i] * np.exp(1j * orders * turn)[:, None]
        columns += [weight[i] * rotated[..., k] for k in range(rotated.shape[-1])]
        free = np.stack([real(each[None])[0] for each in columns], axis=1)
        distance[i] = least_distance(gap, free)
    return distance
