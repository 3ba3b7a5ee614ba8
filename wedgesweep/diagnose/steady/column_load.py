"""The load of the column, measured and simulated: mean and harmonics of the normal force of its face.

Friction is mu times this force. Motion alone shows their product, a load cell behind the column the force.
"""

from typing import NamedTuple

import numpy as np

from wedgesweep.diagnose.steady.harmonic_fit import BAND
from wedgesweep.diagnose.steady.spectra import fitted

# Channel of the load among those that are compared, behind displacement and velocity.
CHANNEL = 2
# The load jumps where slip turns: samples of a simulated period are that close that the instant of a jump,
# known within a sample by the velocity, leaves an error below 1e-4 of it in each harmonic.
SAMPLES_PER_PERIOD = 1024


class ColumnLoad(NamedTuple):
    """The load of one test (N).

    ``mean`` (H + 1,): complex harmonics from the first sample, the mean last; ``variance`` (H + 1,): of each,
    real and imaginary part together, for the mean as if it had both; ``noise``: std of a sample.
    """

    mean: np.ndarray
    variance: np.ndarray
    noise: float

    @property
    def power(self) -> np.ndarray:
        """Variance (H + 1,) that a model error as large as the load gives each: see WhitenedHarmonics."""
        power = np.full(self.mean.size, float(np.mean(np.abs(self.mean[:-1]) ** 2)))
        power[-1] = 2.0 * float(self.mean[-1].real) ** 2
        return power


def measured(time: np.ndarray, load: np.ndarray, frequency: float, zero_std: float) -> ColumnLoad:
    """Load (N) of a record, shape (n,), at even times (s); ``zero_std`` (N): of the zero of the load cell."""
    found = fitted(time, load[None], frequency)
    orders = np.arange(1, found.harmonics + 1)
    turn = np.exp(2j * np.pi * frequency * np.outer(orders, time - time[0]))
    mean = float(np.mean(load - (found.mean[0] @ turn).real))
    kept = orders * frequency < BAND / found.interval  # its amplifier has an anti-aliasing filter
    variance = found.variance[0]
    # Noise is as strong at the mean as at the fundamental, and half of it is that of a real part.
    of_mean = 0.5 * variance[0] + 2.0 * zero_std**2
    return ColumnLoad(
        np.append(found.mean[0][kept], mean), np.append(variance[kept], of_mean), float(found.sample_noise[0])
    )


def joined(rows: np.ndarray, spectra: np.ndarray, load: np.ndarray) -> np.ndarray:
    """Harmonics (n, 3, H + 1) of motion and load, the means last, those of the motion 0.

    ``rows`` (n,): parameter records; ``spectra`` (n, 2, H): harmonics of the motion; ``load`` (n, samples):
    over a period, NaN while set-valued friction holds the mass: straight lines bridge these times.
    """
    count = load.shape[1]
    found = np.zeros((len(load), CHANNEL + 1, spectra.shape[-1] + 1), complex)
    found[:, :CHANNEL, :-1] = spectra
    # Of the displacement, as the channel of the velocity may lag.
    velocity = _waveform(1j * np.arange(1, spectra.shape[-1] + 1) * spectra[:, 0], count)
    for row, one, speed, jumps in zip(found, load, velocity, rows["friction"]["set_valued"], strict=True):
        known = np.flatnonzero(np.isfinite(one))
        bridged = np.interp(np.arange(count), known, one[known], period=count) if known.size else 0.0 * speed
        transform = np.fft.rfft(_averaged(bridged, speed) if jumps else bridged) / count
        row[CHANNEL] = np.append(2.0 * transform[1 : spectra.shape[-1] + 1], transform[0].real)
    return found


def _averaged(load: np.ndarray, velocity: np.ndarray) -> np.ndarray:
    """Samples (n,) of the load averaged over a sampling interval where it jumps, at zeros of the velocity."""
    following = np.roll(velocity, -1)
    places = np.flatnonzero((velocity > 0.0) != (following > 0.0))
    share = velocity[places] / (velocity[places] - following[places])
    jump, after = load[(places + 1) % load.size] - load[places], (places + 1) % load.size
    averaged = load.copy()
    np.add.at(averaged, places, jump * np.maximum(0.5 - share, 0.0))
    np.add.at(averaged, after, -jump * np.maximum(share - 0.5, 0.0))
    return averaged


def _waveform(harmonics: np.ndarray, count: int) -> np.ndarray:
    """Signals (n, count) over a period, of their harmonics (n, H)."""
    padded = np.zeros((len(harmonics), count // 2 + 1), complex)
    padded[:, 1 : harmonics.shape[-1] + 1] = 0.5 * count * harmonics
    return np.fft.irfft(padded, count)
