"""A window of a recorded motion as it is compared, and its simulation.

Compared are the cosine coefficients of the window (DCT-II) up to the highest frequency that the motion may
have: under noise whose spectrum is smooth they are all but independent.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from math import pi, sqrt
from typing import NamedTuple

import numpy as np
from scipy.fft import dct, idct

from wedgesweep.config import Config
from wedgesweep.diagnose.decorrelation import Decorrelation
from wedgesweep.diagnose.fit_parameters import Values
from wedgesweep.diagnose.noise_spectrum import FROM_SPECTRUM, NoiseBins, NoiseSpectrum
from wedgesweep.diagnose.transient.input_noise import (
    InputNoise,
    converted,
    cosines,
    decorrelated,
    disturbed,
)
from wedgesweep.diagnose.transient.noise import Key
from wedgesweep.effects import merge
from wedgesweep.sampled_input import SampledInput, set_sampled
from wedgesweep.solvers import periodic
from wedgesweep.systems import state_count

# Derivative of the displacement that an accelerometer shows.
ACCELERATION = 2
# Zero of an accelerometer over the rms of what it shows, as good as unknown.
UNKNOWN = 1e3
# Coefficients, the lowest ones, that a zero and a start take most of.
LEFT = 4
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
    compared. ``input`` acts in the simulation; ``input_noise``: that of its record, None for no input;
    ``length`` (m): of the motion; ``guess``: displacement (m) and velocity (m/s) where it starts, roughly.
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
    input_noise: InputNoise | None
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

    @property
    def driven(self) -> bool:
        """Whether an input was recorded."""
        return self.input_noise is not None

    @property
    def _orders(self) -> tuple[int, ...]:
        """The derivative of the displacement that each channel is."""
        return self.orders[: len(self.channels)]

    @property
    def _shares(self) -> tuple[float, ...]:
        """Share of the base's recorded motion that was added to each channel to have it as simulated."""
        return (0.0,) * len(self.channels) if self.input_noise is None else self.input_noise.shares

    @property
    def shown_as_measured(self) -> tuple[int, ...]:
        """The derivatives of the displacement that sensors show without conversion."""
        both = zip(self._orders, self._shares, strict=True)
        return tuple(order for order, share in both if share == 0.0)

    @cached_property
    def _converted(self) -> np.ndarray:
        """What was added to the channels, (C, n); an error of the input's gain is in it as well."""
        times = self.step * np.arange(self.grid.lead, self.grid.samples)
        both = zip(self._orders, self._shares, strict=True)
        return np.array([share * self.input(times, order) if share else 0.0 * times for order, share in both])

    @cached_property
    def _frequency(self) -> np.ndarray:
        """Frequency (K,) of each coefficient in rad a sample."""
        return pi * np.arange(self.coefficients) / self.channels.shape[1]

    @cached_property
    def _own_variance(self) -> np.ndarray:
        """Variance (C, K) of each coefficient but for what the input adds."""
        least = SIMULATED * self.rms * sqrt(self.spread)
        own = zip(self.spectra, least, strict=True)
        found = np.array([each(self._frequency) + low**2 for each, low in own])
        # The zero of a first channel is fitted; that of an accelerometer beside others tells nothing.
        zero = (UNKNOWN * self.rms) ** 2 * self.channels.shape[1]
        found[1:, 0] += zero[1:] * (np.array(self._orders[1:]) == ACCELERATION)
        return found

    @cached_property
    def by_input(self) -> np.ndarray:
        """Variance (C, K) of each coefficient by the input's noise, spread as its motion is."""
        grid = np.linspace(0.0, pi, self.passed_on.shape[1])
        return np.array([np.interp(self._frequency, grid, each) for each in self.passed_on])

    @cached_property
    def noise(self) -> np.ndarray:
        """Standard deviation (C, K) of each coefficient."""
        return np.sqrt(self._own_variance + self.by_input)

    def noise_in(self, left: np.ndarray) -> dict[Key, NoiseBins]:
        """What an explanation leaves of the coefficients (C, K) as bins of noise, by test and order."""
        both = zip(self._orders, left[:, LEFT:] ** 2, self.by_input[:, LEFT:], strict=True)
        bins = {order: NoiseBins(self._frequency[LEFT:], power, known) for order, power, known in both}
        return {(self.number, order): each for order, each in bins.items()}

    def with_noise(self, estimates: Mapping[Key, NoiseSpectrum]) -> "Release":
        """The window with new estimates of its noise, but not where repeats of the test showed it."""
        own = zip(self.spectra, self.orders, strict=False)
        spectra = tuple(
            estimates.get((self.number, order), each) if each.source == FROM_SPECTRUM else each
            for each, order in own
        )
        return replace(self, spectra=spectra)

    def decorrelation(
        self, values: Values, start: np.ndarray, gain: float, tolerance: float
    ) -> tuple[Decorrelation, ...]:
        """Independent combinations of the coefficients of each channel, by the response in a scenario.

        None without an input: the coefficients are independent as they are.
        ``start`` (2,) of the simulation; ``gain`` of the input.
        """
        if self.input_noise is None:
            return ()
        grid = self.grid
        parts = cosines(self.input_noise, grid.samples, self.step, float(self._frequency[-1]))
        inputs = disturbed(self.input, parts)
        rows = np.repeat(self._records([values]), len(inputs), axis=0)
        for place, each in enumerate(inputs):
            self._drive(rows[place : place + 1], each, gain)
        above, below = np.split(self._motions(rows, np.tile(start, (len(rows), 1)), tolerance), 2)
        changes = converted(parts, self.input_noise.shares, self._orders, grid.lead) - 0.5 * (above - below)
        return decorrelated(self._own_variance, np.nan_to_num(changes))

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
        rows = self._records(scenarios)
        self._drive(rows, self.input, gains)
        motions = self._motions(rows, starts, tolerance) - (gains - 1.0)[:, None, None] * self._converted
        return dct(motions, norm="ortho")[..., : self.coefficients]

    def _records(self, scenarios: list[Values]) -> np.ndarray:
        """Parameter records of scenarios, without an input."""
        known, omega = self.model.effects, self.grid.omega
        return np.concatenate(
            [self.model.record_with(merge(known, each), self.law, 1.0, omega) for each in scenarios]
        )

    def _drive(self, rows: np.ndarray, given: SampledInput, gain: float | np.ndarray) -> None:
        """Let an input act in records."""
        set_sampled(rows, given, self._scale, self.grid.omega, self.grid.samples * self.step, gain)

    def _motions(self, rows: np.ndarray, starts: np.ndarray, tolerance: float) -> np.ndarray:
        """Channels (n, C, samples) of the window from starts (n, 2); NaN for none."""
        states = np.zeros((len(rows), state_count()))
        # Channels are minus what solvers record, which the suspension has as its state.
        states[:, :2] = starts if self.model.system == "oscillator" else -starts
        orders, samples = self._orders, self.grid.samples
        run = periodic.sampled(rows, states, 0, 1, samples, tolerance, max(orders) == ACCELERATION)
        motion = run.x, run.velocity, run.acceleration
        return -np.stack([motion[order] for order in orders], axis=1)[..., self.grid.lead :]

    @property
    def _scale(self) -> float:
        """What motions are compared with: their length (m), or the force (N) that would cause it."""
        if not self.model.forced:
            return self.length
        return self.length * self.model.natural_units(self.length).mass * self.grid.omega**2
