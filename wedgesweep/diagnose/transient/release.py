"""A window of a recorded motion as it is compared, and its simulation.

Compared are the cosine coefficients of the window (DCT-II) up to the highest frequency that the motion may
have: under noise whose spectrum is smooth they are all but independent. A simulation is sampled more
coarsely, at the middles of groups of samples, which gives the same coefficients.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, floor, pi, sqrt
from typing import NamedTuple

import numpy as np
from scipy.fft import dct, idct

from wedgesweep import excitation
from wedgesweep.config import Config
from wedgesweep.diagnose.fit_parameters import Values
from wedgesweep.diagnose.noise_spectrum import NoiseSpectrum
from wedgesweep.diagnose.smoothing import HIGHEST, LowPass
from wedgesweep.effects import merge
from wedgesweep.solvers import periodic
from wedgesweep.systems import state_count

# Natural periods of a window, and of what is simulated before it so that the start of bristles is forgotten.
WINDOW, LEAD = 10.0, 1.0
# Windows that a single record makes at least, if each has so many natural periods.
FEWEST, SHORTEST = 3, 3.0
# Highest frequency that is compared, over the natural frequency and over the highest that stands out.
HARMONICS, BEYOND = 8.0, 2.0
# Least samples of a simulation in a natural period, and over the highest compared frequency.
LEAST_PER_PERIOD, SAMPLED = 16, 4.0
# Share of the record at its end whose mean is where the motion comes to rest.
REST = 0.1
# Fewest coefficients that are compared, and smallest motion in a window over that in the record.
FEWEST_COMPARED, SMALL = 8, 1e-3
# Error of a simulation over the rms of the motion, which counts as noise.
SIMULATED = 1e-5


class Grid(NamedTuple):
    """Even times of a simulation.

    ``group``: samples that one stands for; ``finer``: simulated ones for each of them, of which only one is
    kept; ``per_period`` of the ``omega`` (rad/s) by which the simulation counts; ``lead``: groups before
    the window; ``groups``: in it.
    """

    group: int
    finer: int
    per_period: int
    omega: float
    lead: int
    groups: int


@dataclass(frozen=True, eq=False)
class Release:
    """One window.

    ``model``: the base model with the numbers of the test; ``step`` (s) between samples; ``begins`` (s):
    time of its first sample in its record, of the ``number``-th test; ``channels`` (C, n): displacement (m)
    and, where it was recorded, velocity (m/s); ``spectra``: their noise; ``coefficients`` K of a channel
    that are compared; ``guess``: displacement (m) and velocity (m/s) where the simulation starts, roughly.
    """

    name: str
    model: Config
    law: str
    step: float
    begins: float
    number: int
    channels: np.ndarray
    spectra: tuple[NoiseSpectrum, ...]
    coefficients: int
    grid: Grid
    length: float
    guess: tuple[float, float]

    @property
    def compared(self) -> np.ndarray:
        """Cosine coefficients (C, K)."""
        return dct(self.channels, norm="ortho")[:, : self.coefficients]

    @property
    def rms(self) -> np.ndarray:
        """Rms (C,) of each channel about its mean."""
        return self.channels.std(axis=1)

    @property
    def spread(self) -> float:
        """Samples for each coefficient; an error that has all its power there is larger by the root of it."""
        return self.channels.shape[1] / self.coefficients

    @property
    def noise(self) -> np.ndarray:
        """Standard deviation (C, K) of each coefficient."""
        frequency = pi * np.arange(self.coefficients) / self.channels.shape[1]
        least = SIMULATED * self.rms * sqrt(self.spread)
        return np.sqrt([each(frequency) + low**2 for each, low in zip(self.spectra, least, strict=True)])

    def in_time(self, coefficients: np.ndarray) -> np.ndarray:
        """Signals (..., C, n) of coefficients (..., C, K)."""
        return idct(coefficients, n=self.channels.shape[1], norm="ortho")

    @property
    def starts_at(self) -> float:
        """Time (s) in the record at which the simulation starts."""
        return self.begins + (self.grid.group // 2 - self.grid.lead * self.grid.group) * self.step

    @property
    def natural(self) -> float:
        """Length of the window in natural periods of the model."""
        return self.grid.groups * self.grid.finer / self.grid.per_period

    @property
    def periods(self) -> float:
        """Length of what is simulated in natural periods of the model."""
        return (self.grid.lead + self.grid.groups) * self.grid.finer / self.grid.per_period

    def simulated(self, scenarios: list[Values], starts: np.ndarray, tolerance: float) -> np.ndarray:
        """Coefficients (n, C, K) of n scenarios from their starts (n, 2); NaN for none."""
        grid = self.grid
        rows = np.concatenate(
            [
                self.model.record_with(merge(self.model.effects, each), self.law, 1.0, grid.omega)
                for each in scenarios
            ]
        )
        excitation.set_no_motion(rows, self.length)
        states = np.zeros((len(rows), state_count()))
        # Channels are minus what solvers record, which the suspension has as its state.
        states[:, :2] = starts if self.model.system == "oscillator" else -starts
        samples = (grid.lead + grid.groups) * grid.finer
        periods = ceil(samples / grid.per_period)
        x, velocity, _ = periodic.samples(rows, states, 0, periods, grid.per_period, tolerance)
        signals = -np.stack([x, velocity], axis=1)[:, : len(self.channels)]
        window = signals[..., grid.lead * grid.finer : samples : grid.finer]
        return sqrt(grid.group) * dct(window, norm="ortho")[..., : self.coefficients]


class Recorded(NamedTuple):
    """A record: channels (C, n), sampled at a rate (Hz), with the noise of each; ``number`` of its test."""

    name: str
    channels: np.ndarray
    rate: float
    spectra: Sequence[NoiseSpectrum]
    number: int = 0


def windows(record: Recorded, model: Config, law: str, fewest: int = 1) -> list[Release]:
    """Prepare the windows of a record, of which there should be so many at least."""
    channels, rate = record.channels, record.rate
    rest = float(channels[0, -max(int(REST * channels.shape[1]), 1) :].mean())
    length = float(np.abs(channels[0] - rest).max())
    period = 2.0 * pi * model.natural_units(max(length, 1e-300)).time * rate  # samples
    total = channels.shape[1] / period
    count = max(round(total / WINDOW), min(fewest, floor(total / SHORTEST)), 1)
    top = max(HARMONICS * 2.0 * pi / period, BEYOND * min(each.highest for each in record.spectra))
    group = _group(period, top)
    groups = channels.shape[1] // group // count
    size = groups * group
    smooth = LowPass(min(top / (2.0 * pi), HIGHEST), 1.0)(channels[0]) - rest
    slope = np.gradient(smooth) * rate
    found = []
    for place in range(count):
        first = place * size
        grid = _grid(period, group, first, rate, groups)
        own = channels[:, first : first + size]
        at = first + group // 2 - grid.lead * group
        found.append(
            Release(
                name=record.name if count == 1 else f"{record.name} {place + 1}",
                model=model,
                law=law,
                step=1.0 / rate,
                begins=first / rate,
                number=record.number,
                channels=own,
                spectra=tuple(record.spectra),
                coefficients=min(max(ceil(top * size / pi), FEWEST_COMPARED), groups),
                grid=grid,
                length=max(float(np.abs(own[0] - rest).max()), SMALL * length),
                guess=(float(smooth[at]), float(slope[at])),
            )
        )
    return found


def _group(period: float, top: float) -> int:
    """Samples that a simulated one stands for: odd, so that one of them is in the middle."""
    most = max(int(min(period / LEAST_PER_PERIOD, 2.0 * pi / (SAMPLED * top))), 1)
    return most - 1 + most % 2


def _grid(period: float, group: int, first: int, rate: float, groups: int) -> Grid:
    """Times of a window from the ``first`` sample on; ``period`` in samples."""
    finer = max(1, ceil(LEAST_PER_PERIOD * group / period))
    per_period = max(round(period * finer / group), LEAST_PER_PERIOD)
    omega = 2.0 * pi * finer * rate / (per_period * group)
    lead = min(ceil(LEAD * period / group), first // group)
    return Grid(group, finer, per_period, omega, lead, groups)
