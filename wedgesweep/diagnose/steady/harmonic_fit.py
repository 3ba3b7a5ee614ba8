"""The least-squares fit of harmonics to a record: its regressors, and which frequencies it can resolve."""

from math import pi
from typing import NamedTuple

import numpy as np

# Harmonics that are compared with a simulation, and that are removed before the noise is measured.
COMPARED, REMOVED = 16, 40
# Highest frequency that is used, over the sampling rate.
BAND = 0.4
# Frequencies this many resolutions (one over the duration) apart are resolved.
RESOLVED = 1.2
# Closer than this (resolutions) a tone is the harmonic; farther off it leaks into all of them, and is
# removed.
MERGED = 0.05


def distance(frequencies: np.ndarray | float, frequency: float) -> np.ndarray:
    """Distance (Hz) of frequencies from the closest harmonic."""
    return np.abs(frequencies - frequency * np.round(frequencies / frequency))


def within_band(most: int, frequency: float, interval: float) -> int:
    """Number of harmonics, at most ``most``, that a record sampled at an interval (s) shows."""
    return min(most, int(BAND / interval / frequency))


def resolvable(tones: np.ndarray, frequency: float, duration: float, harmonics: int) -> np.ndarray:
    """Whether a record of some duration (s) resolves tones (Hz) from the harmonics, in their band."""
    resolved = distance(tones, frequency) * duration > RESOLVED
    return resolved & (tones < frequency * (harmonics + 1))


class TonePosition(NamedTuple):
    """Whether a record resolves a tone from the harmonics, and else which one it masks (None: none)."""

    resolved: bool
    masked_harmonic: int | None


def tone_position(tone: float, frequency: float, duration: float, harmonics: int) -> TonePosition:
    """Position of a tone (Hz) among the compared harmonics of a record of some duration (s)."""
    if resolvable(np.array(tone), frequency, duration, harmonics):
        return TonePosition(True, None)
    closest = round(tone / frequency)
    masks = distance(tone, frequency) * duration <= RESOLVED and 1 <= closest <= harmonics
    return TonePosition(False, closest if masks else None)


def regressors(time: np.ndarray, frequency: float, harmonics: int) -> np.ndarray:
    """Constant, drift, and cosine and sine of each harmonic, shape (n, 2 + 2 * harmonics)."""
    turns = phasors_of(time, frequency, harmonics).T
    slow = np.stack([np.ones_like(time), 2.0 * time / time[-1] - 1.0], axis=1)
    return np.concatenate([slow, turns.real, turns.imag], axis=1)


def phasors_of(time: np.ndarray, frequency: float, multiples: int) -> np.ndarray:
    """exp(2 pi i k f t) for k = 1..multiples, shape (multiples, n), as powers of the first."""
    first = np.exp(2j * pi * frequency * time)
    return np.multiply.accumulate(np.repeat(first[None], multiples, axis=0), axis=0)


class DesignMatrix(NamedTuple):
    """Regressors of a least-squares fit, and which of their coefficients are read.

    ``matrix`` (n, columns). ``cosines``, ``sines``: columns of the ``harmonics`` that are compared, and then
    those of the ``tone`` (Hz) if it is resolved. ``removed``: number of harmonics that are fitted.
    ``masked_harmonic``: the harmonic that cannot be resolved from a tone.
    """

    matrix: np.ndarray
    cosines: np.ndarray
    sines: np.ndarray
    harmonics: int
    removed: int
    tone: float | None
    masked_harmonic: int | None

    def read(self, solution: np.ndarray) -> np.ndarray:
        """Complex amplitudes of what is compared, from the coefficients (columns, ...) of a fit."""
        return solution[self.cosines] - 1j * solution[self.sines]

    def scatter(self, inverse: np.ndarray) -> np.ndarray:
        """Variance of each complex amplitude in white noise of variance 1.

        ``inverse``: of the normal equations.
        """
        variance = np.diag(inverse)
        return variance[self.cosines] + variance[self.sines]


def design_matrix(
    time: np.ndarray, interval: float, frequency: float, tone: float | None, doubled: bool
) -> DesignMatrix:
    """Columns for harmonics, for a tone if there is one, and for odd multiples of half the frequency.

    The latter are added if the period of the response is known to be ``doubled``.
    """
    removed, kept = (within_band(most, frequency, interval) for most in (REMOVED, COMPARED))
    columns = [regressors(time, frequency, removed)]
    places = np.array([np.arange(2, 2 + kept), np.arange(2 + removed, 2 + removed + kept)])
    if doubled:
        half = phasors_of(time, 0.5 * frequency, 2 * kept + 1)[::2].T
        columns += [half.real, half.imag]
    position = TonePosition(False, None) if tone is None else tone_position(tone, frequency, time[-1], kept)
    if tone is not None and distance(tone, frequency) * time[-1] > MERGED:
        turn = np.exp(2j * pi * tone * time)[:, None]
        columns += [turn.real, turn.imag]
    matrix = np.concatenate(columns, axis=1)
    if position.resolved:
        places = np.c_[places, [matrix.shape[1] - 2, matrix.shape[1] - 1]]
    shown = tone if position.resolved else None
    return DesignMatrix(matrix, places[0], places[1], kept, removed, shown, position.masked_harmonic)
