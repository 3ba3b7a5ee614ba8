"""A window of a recorded motion: what is compared of it, its noise, and its simulation.

The cosine coefficients (DCT-II) of the window are compared, up to the highest frequency that the motion may
have: under noise whose spectrum is smooth they are all but independent.
"""

from collections.abc import Hashable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import ceil, pi, sqrt
from typing import NamedTuple

import numpy as np
from scipy.fft import dct, idct

from wedgesweep.config import Config
from wedgesweep.diagnose.fit_data import Motion
from wedgesweep.diagnose.fit_parameters import Values
from wedgesweep.diagnose.noise_spectrum import FROM_REPEATS, FROM_RESIDUAL, NoiseSpectrum
from wedgesweep.diagnose.sampled_data import Decorrelation
from wedgesweep.diagnose.transient.input_noise import (
    InputNoise,
    cosines,
    decorrelated,
    disturbed,
)
from wedgesweep.diagnose.transient.noise import ACCELERATION
from wedgesweep.effects import merge
from wedgesweep.effects.channel_delay import NAME as DELAY
from wedgesweep.sampled_input import SampledInput, set_sampled
from wedgesweep.solvers import periodic
from wedgesweep.systems import set_states, state_count

# Standard deviation of an accelerometer's zero over the rms of its signal: as good as unknown.
UNKNOWN_ZERO = 1e3
# Effects with a body of its own that moves, whose start is fitted as well.
BODIES = "column_compliance", "fixture_resonance"
# Error of a simulation over the rms of the motion; it counts as noise.
SIMULATION_ERROR = 1e-5


class Grid(NamedTuple):
    """Samples of a simulation: ``lead`` before a window, ``inside`` it.

    ``omega``: angular natural frequency (rad/s).
    """

    lead: int
    inside: int
    omega: float

    @property
    def samples(self) -> int:
        """Simulated samples."""
        return self.lead + self.inside


@dataclass(frozen=True, eq=False)
class RecordWindow:
    """One window of the record of a test, with C channels of n samples.

    Attributes
    ----------
    model, law
        The base model with the numbers of the test, and its friction law.
    step, begins
        Time between samples, and time of the window's first sample in its record (s).
    number : int
        Index of the test.
    channels : ndarray, shape (C, n)
        Recorded displacement (m), velocity (m/s) and acceleration (m/s^2), or some of them, converted to the
        motion that is simulated.
    rms : ndarray, shape (C,)
        Rms of each channel about its mean in the whole record: model errors are shares of it, so that where a
        motion has died down they are not shares of a creep.
    spectra : tuple of NoiseSpectrum
        Noise of each channel but for what the input's noise adds.
    coefficients : int
        Number K of cosine coefficients of a channel that are compared.
    grid : Grid
        Samples that are simulated.
    input, input_noise
        What acts in the simulation, and the noise of its record (None: no input was recorded).
    length : float
        Largest displacement of the motion in the window (m).
    guess : tuple of float
        Rough displacement (m) and velocity (m/s) at the first simulated sample.
    orders : tuple of int
        Derivative of the displacement that each channel is (0, 1 or 2).
    """

    name: str
    model: Config
    law: str
    step: float
    begins: float
    number: int
    channels: np.ndarray
    rms: np.ndarray
    spectra: tuple[NoiseSpectrum, ...]
    coefficients: int
    grid: Grid
    input: SampledInput
    input_noise: InputNoise | None
    length: float
    guess: tuple[float, float]
    orders: tuple[int, ...]

    @cached_property
    def compared(self) -> np.ndarray:
        """Cosine coefficients (C, K)."""
        return dct(self.channels, norm="ortho")[:, : self.coefficients]

    @property
    def motion(self) -> Motion:
        """The motion by its lowest derivatives; what no sensor shows comes from the one beside it."""
        by_order = dict(zip(self.orders, self.channels, strict=True))
        velocity = by_order.get(1)
        if velocity is None:
            shown = by_order.get(0)
            velocity = self._integrated(by_order[2]) if shown is None else np.gradient(shown, self.step)
        return Motion(by_order.get(0, self._integrated(velocity)), velocity)

    def _integrated(self, rate: np.ndarray) -> np.ndarray:
        """Samples (n,) of a motion about its mean, from those of its rate about theirs."""
        found = np.cumsum(rate - rate.mean()) * self.step
        return np.asarray(found - found.mean())

    @property
    def spread(self) -> float:
        """Samples per compared coefficient.

        An error of a given rms whose power is all in the compared coefficients has an rms there that is
        larger by the square root of this.
        """
        return self.channels.shape[1] / self.coefficients

    def beginning(self, share: float) -> "RecordWindow":
        """The first part of the window, a share of it, and as much of the spectrum."""
        inside = ceil(share * self.grid.inside)
        return replace(
            self,
            channels=self.channels[:, :inside],
            coefficients=min(ceil(share * self.coefficients), inside),
            grid=self.grid._replace(inside=inside),
        )

    @property
    def alike(self) -> Hashable:
        """What windows have in common that can be simulated together."""
        return id(self.model), self.grid, self.orders, self.coefficients, self.converted

    @property
    def driven(self) -> bool:
        """Whether an input was recorded."""
        return self.input_noise is not None

    @property
    def _shares(self) -> tuple[float, ...]:
        """Share of the base's recorded motion that was added to each channel to have it as simulated."""
        return (0.0,) * len(self.channels) if self.input_noise is None else self.input_noise.shares

    @property
    def converted(self) -> bool:
        """Whether the base's motion was added to any channel."""
        return any(self._shares)

    @property
    def shown_as_measured(self) -> tuple[int, ...]:
        """The derivatives of the displacement that sensors show without conversion."""
        both = zip(self.orders, self._shares, strict=True)
        return tuple(order for order, share in both if share == 0.0)

    def added(self, given: SampledInput) -> np.ndarray:
        """Motion of the base that an input adds to the channels, (C, n): it has the errors of the input."""
        times = self.step * np.arange(self.grid.lead, self.grid.samples)
        both = zip(self.orders, self._shares, strict=True)
        return np.array([share * given(times, order) if share else 0.0 * times for order, share in both])

    @cached_property
    def _frequency(self) -> np.ndarray:
        """Frequency (K,) of each coefficient in rad a sample."""
        return pi * np.arange(self.coefficients) / self.channels.shape[1]

    @cached_property
    def noise(self) -> np.ndarray:
        """Standard deviation (C, K) of each coefficient, without what the input's noise adds."""
        least = SIMULATION_ERROR * self.rms * sqrt(self.spread)
        own = zip(self.spectra, least, strict=True)
        found = np.array([each(self._frequency) + low**2 for each, low in own])
        # The zero of the first channel is fitted; that of an accelerometer beside others is unknown.
        zero = (UNKNOWN_ZERO * self.rms) ** 2 * self.channels.shape[1]
        found[1:, 0] += zero[1:] * (np.array(self.orders[1:]) == ACCELERATION)
        return np.sqrt(found)

    def decorrelation(
        self, values: Values, start: np.ndarray, gain: float, tolerance: float
    ) -> tuple[Decorrelation, ...]:
        """Combinations with independent noise of the coefficients of each channel, in a scenario.

        There are none without an input: the coefficients are independent as they are. ``start`` (B, 2): where
        the simulation begins, see ``simulated_together``; ``gain``: of the input.
        """
        if self.input_noise is None:
            return ()
        parts = cosines(self.input_noise, self.grid.samples, self.step, float(self._frequency[-1]))
        inputs = disturbed(self.input, parts)
        rows = np.repeat(self.records([values]), len(inputs), axis=0)
        for place, each in enumerate(inputs):
            self.drive(rows[place : place + 1], each, gain)
        motions = self.motions(rows, np.repeat(start[None], len(rows), axis=0), tolerance)
        above, below = np.split(np.array([self.added(each) for each in inputs]) - motions, 2)
        return decorrelated(self.noise**2, np.nan_to_num(0.5 * (above - below)))

    def residual(self, left: np.ndarray) -> dict[int, np.ndarray]:
        """Samples (n,) of each channel, by its order, less a simulation.

        ``left``: coefficients (C K,) of what the simulation leaves; above them there is no motion.
        """
        left = left[: self.compared.size].reshape(self.compared.shape)
        samples = self.channels + self.in_time(left - self.compared)
        return dict(zip(self.orders, samples, strict=True))

    def with_less_noise(self, spectra: Sequence[NoiseSpectrum]) -> "RecordWindow":
        """The window with other spectra of its channels' noise where they have less at what is compared."""

        def less(known: NoiseSpectrum, other: NoiseSpectrum) -> NoiseSpectrum:
            smaller = other(self._frequency).sum() < known(self._frequency).sum()
            if known.source == FROM_REPEATS or not smaller:
                return known
            return replace(other, highest=known.highest, source=FROM_RESIDUAL)

        return replace(self, spectra=tuple(map(less, self.spectra, spectra)))

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

    def records(self, scenarios: list[Values]) -> np.ndarray:
        """Parameter records of scenarios, without an input."""
        known, omega = self.model.effects, self.grid.omega
        return np.concatenate(
            [self.model.record_with(merge(known, each), self.law, 1.0, omega) for each in scenarios]
        )

    def drive(self, rows: np.ndarray, given: SampledInput, gain: float | np.ndarray) -> None:
        """Let an input act in records."""
        set_sampled(rows, given, self._scale, self.grid.omega, self.grid.samples * self.step, gain)

    def motions(self, rows: np.ndarray, starts: np.ndarray, tolerance: float) -> np.ndarray:
        """Channels (n, C, samples) of the window from ``starts``; NaN where there is no response."""
        states = np.zeros((len(rows), state_count()))
        # Solvers record minus what channels are: the state of a suspension, minus the state of an oscillator.
        states[:, :2] = starts[:, 0] if self.model.system == "oscillator" else -starts[:, 0]
        for place, name in enumerate(BODIES, 1):
            set_states(rows, states, name, starts[:, place])
        samples = self.grid.samples
        run = periodic.sampled(rows, states, 0, 1, samples, tolerance, max(self.orders) == ACCELERATION)
        motion = run.x, run.velocity, run.acceleration
        return -np.stack([motion[order] for order in self.orders], axis=1)[..., self.grid.lead :]

    @property
    def _scale(self) -> float:
        """Scale of the motion for ``set_sampled``: its length (m), or the force (N) that would cause it."""
        if not self.model.forced:
            return self.length
        return self.length * self.model.natural_units(self.length).mass * self.grid.omega**2


def simulated_together(
    windows: Sequence[RecordWindow],
    scenarios: list[Values],
    starts: np.ndarray,
    gains: np.ndarray,
    tolerance: float,
) -> np.ndarray:
    """Coefficients (n, W, C, K) of n scenarios in W windows that are ``alike``; NaN without a response.

    ``starts`` (n, W, B, 2): displacement (m) and velocity (m/s) at the first simulated sample, of the mass,
    then of each of BODIES; ``gains`` (n, W): of the input.
    """
    first, (n, count) = windows[0], gains.shape
    rows = np.repeat(first.records(scenarios), count, axis=0)
    for place, own in enumerate(windows):
        own.drive(rows[place::count], own.input, gains[:, place])
    late = np.array([each.get(DELAY, {"time": 0.0})["time"] for each in scenarios])
    rows["series"]["begin"] += np.repeat(late, count)  # responses that are late follow an input that is
    motions = first.motions(rows, starts.reshape(n * count, -1, 2), tolerance)
    motions = motions.reshape(n, count, *motions.shape[1:])
    if first.converted:
        motions -= (gains - 1.0)[..., None, None] * np.array([own.added(own.input) for own in windows])
    return dct(motions, norm="ortho")[..., : first.coefficients]
