"""Steady responses of the model on trial to the measured tests, each started from a neighbour's."""

from functools import lru_cache
from math import pi
from typing import NamedTuple

import numpy as np

from wedgesweep import parameters
from wedgesweep.config import Config
from wedgesweep.solvers import periodic

# A model that is this exact adds nothing to the noise of 4 % data (share of the input amplitude).
TOLERANCE, RTOL = 1e-6, 1e-6
MOST_PERIODS = 40
SAMPLES_PER_PERIOD = 256
# Periods run before and over which a response with a foreign tone is evaluated, and its samples.
TONE_SETTLING, TONE_PERIODS, TONE_SAMPLES = 10, 20, 64


class Warm(NamedTuple):
    """Where steady responses were found: states (n, k) at phase 0 and derivatives (n, k, k) of the map."""

    states: np.ndarray
    maps: np.ndarray

    def repeated(self, times: int) -> "Warm":
        return Warm(np.tile(self.states, (times, 1)), np.tile(self.maps, (times, 1, 1)))

    def of(self, rows: np.ndarray | slice) -> "Warm":
        """Some of the rows."""
        return Warm(self.states[rows], self.maps[rows])


class Responses(NamedTuple):
    """Harmonics (n, 2, H) of displacement x - y (m) and its rate, complex, and where to go on from.

    ``found`` (n,): whether there is such a response; it has none where the wedge locks, and then NaN.
    """

    harmonics: np.ndarray
    found: np.ndarray
    warm: Warm
    periods: np.ndarray


def cold(cases: int) -> Warm:
    """No neighbour: start from rest."""
    size = periodic.SIZE
    return Warm(np.full((cases, size), np.nan), np.full((cases, size, size), np.nan))


def records(model: Config, law: str, values: dict, omega: np.ndarray, amplitude: np.ndarray) -> np.ndarray:
    """Parameter records of some tests, shape (n,): ``omega`` (rad/s) and ``amplitude`` (m) of shape (n,)."""
    effects = {**model.effects, **values}
    one = parameters.record(law, 1.0, 1.0, model.suspension, model.friction, effects)
    rows = np.repeat(one, omega.size)
    rows["omega"], rows["amplitude"] = omega, amplitude
    return rows


def respond(rows: np.ndarray, warm: Warm, harmonics: int) -> Responses:
    """Steady responses of parameter records, shape (n,)."""
    found = periodic.respond(
        rows, warm.states, warm.maps, TOLERANCE, MOST_PERIODS, SAMPLES_PER_PERIOD, harmonics, RTOL
    )
    return Responses(found.spectra, found.outcome == 0, Warm(found.state, found.map), found.periods)


def respond_with_tone(rows: np.ndarray, warm: Warm, harmonics: int, tone: float) -> Responses:
    """Responses under a foreign tone (Hz), which do not repeat: harmonics, and the tone in the last column.

    The sums over many periods leave out how tone and input happened to meet in a record.
    """
    x, velocity, state = periodic.samples(rows, warm.states, TONE_SETTLING, TONE_PERIODS, TONE_SAMPLES, RTOL)
    found = np.isfinite(x).all(axis=1)
    spectra = np.full((len(rows), 2, harmonics + 1), np.nan, complex)
    for omega in np.unique(rows["omega"]):
        these = np.flatnonzero((rows["omega"] == omega) & found)
        signals = -np.stack([x[these], velocity[these]], axis=1)
        spectra[these] = signals @ _projection(float(omega), tone, harmonics).T
    return Responses(spectra, found, Warm(state, warm.maps), np.full(len(rows), TONE_SETTLING + TONE_PERIODS))


@lru_cache(maxsize=256)
def _projection(omega: float, tone: float, harmonics: int) -> np.ndarray:
    """Least-squares fit of mean, harmonics and tone as a matrix (harmonics + 1, samples), complex."""
    phase = 2.0 * pi * np.arange(TONE_PERIODS * TONE_SAMPLES) / TONE_SAMPLES
    turns = np.outer(phase, np.r_[np.arange(1, harmonics + 1), 2.0 * pi * tone / omega])
    matrix = np.concatenate([np.ones((phase.size, 1)), np.cos(turns), np.sin(turns)], axis=1)
    inverse = np.linalg.pinv(matrix)
    return inverse[1 : harmonics + 2] - 1j * inverse[harmonics + 2 :]
