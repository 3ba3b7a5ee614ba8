"""A window of a recorded motion as it is compared, and its simulation.

Compared are the cosine coefficients of the window (DCT-II) up to the highest frequency that the motion may
have: under noise whose spectrum is smooth they are all but independent.
"""

from dataclasses import dataclass
from functools import cached_property
from math import pi, sqrt
from typing import NamedTuple

import numpy as np
from scipy.fft import dct, idct

from wedgesweep.config import Config
from wedgesweep.diagnose.fit_parameters import Values
from wedgesweep.diagnose.noise_spectrum import NoiseSpectrum
from wedgesweep.effects import merge
from wedgesweep.sampled_input import SampledInput, set_sampled
from wedgesweep.solvers import periodic
from wedgesweep.systems import state_count

# Derivative of the displacement that an accelerometer shows.
ACCELERATION = 2
# Error of a simulation over the rms of the motion, which counts as noise.
SIMULATED = 1e-5


class Grid(NamedTuple):
    """Samples of a simulation: ``lead`` before a window, ``inside`` it; ``omega``: natural (rad/s)."""

    lead: int
    inside: int
    omega: float

    @property
    def samples(self) -> int:
        """Simulated samples."""
        return self.lead + self.inside


@dataclass(frozen=True, eq=False)
class Release:
    """One window.

    ``model``: the base model with the numbers of the test; ``step`` (s) between samples; ``begins`` (s):
    time of its first sample in its record, of the ``number``-th test; ``channels`` (C, n): what was recorded
    of displacement (m), velocity (m/s) and acceleration (m/s^2), as they are simulated; ``orders`` (C,): the
    derivative of the displacement that each of them is; ``spectra``: their noise, beside that of the input,
    ``passed_on`` (C, f) by frequency up to half the sampling rate. ``coefficients`` K of a channel are
    compared. ``input`` acts in the simulation, of ``size`` in what it was recorded as; ``length`` (m): of the
    motion; ``guess``: displacement (m) and velocity (m/s) where it starts, roughly.
    """

    name: str
    model: Config
    law: str
    step: float
    begins: float
    number: int
    channels: np.ndarray
    spectra: tuple[NoiseSpectrum, ...]
    passed_on: np.ndarray
    coefficients: int
    grid: Grid
    input: SampledInput
    driven: bool
    length: float
    guess: tuple[float, float]
    orders: tuple[int, ...] = (0, 1)

    @cached_property
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

    @cached_property
    def noise(self) -> np.ndarray:
        """Standard deviation (C, K) of each coefficient."""
        frequency = pi * np.arange(self.coefficients) / self.channels.shape[1]
        least = SIMULATED * self.rms * sqrt(self.spread)
        grid = np.linspace(0.0, pi, self.passed_on.shape[1])
        passed = [np.interp(frequency, grid, each) for each in self.passed_on]
        own = zip(self.spectra, passed, least, strict=True)
        found = np.sqrt([each(frequency) + more + low**2 for each, more, low in own])
        # The zero of a first channel is fitted; that of an accelerometer beside others tells nothing.
        found[1:, 0] *= np.array(self.orders[1 : len(found)]) < ACCELERATION
        return found

    def in_time(self, coefficients: np.ndarray) -> np.ndarray:
        """Signals (..., C, n) of coefficients (..., C, K)."""
        return idct(coefficients, n=self.channels.shape[1], norm="ortho")

    @property
    def starts_at(self) -> float:
        """Time (s) in the record at which the simulation starts."""
        return self.begins - self.grid.lead * self.step

    @property
    def _natural_step(self) -> float:
        """Time between simulated samples in natural periods of the model."""
        return self.step * self.grid.omega / (2.0 * pi)

    @property
    def natural(self) -> float:
        """Length of the window in natural periods of the model."""
        return self.grid.inside * self._natural_step

    @property
    def periods(self) -> float:
        """Length of what is simulated in natural periods of the model."""
        return self.grid.samples * self._natural_step

    def simulated(
        self, scenarios: list[Values], starts: np.ndarray, gains: np.ndarray, tolerance: float
    ) -> np.ndarray:
        """Coefficients (n, C, K) of n scenarios from their starts (n, 2); NaN for none.

        ``gains`` (n,): of the input.
        """
        grid = self.grid
        rows = np.concatenate(
            [
                self.model.record_with(merge(self.model.effects, each), self.law, 1.0, grid.omega)
                for each in scenarios
            ]
        )
        set_sampled(rows, self.input, self._scale, grid.omega, grid.samples * self.step, gains)
        states = np.zeros((len(rows), state_count()))
        # Channels are minus what solvers record, which the suspension has as its state.
        states[:, :2] = starts if self.model.system == "oscillator" else -starts
        orders = self.orders[: len(self.channels)]
        run = periodic.sampled(rows, states, 0, 1, grid.samples, tolerance, max(orders) == ACCELERATION)
        motion = run.x, run.velocity, run.acceleration
        window = -np.stack([motion[order] for order in orders], axis=1)[..., grid.lead :]
        return dct(window, norm="ortho")[..., : self.coefficients]

    @property
    def _scale(self) -> float:
        """What motions are compared with: their length (m), or the force (N) that would cause it."""
        if not self.model.forced:
            return self.length
        return self.length * self.model.natural_units(self.length).mass * self.grid.omega**2
