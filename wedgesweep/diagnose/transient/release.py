"""A recorded free motion as it is compared, and its simulation."""

from dataclasses import dataclass
from math import ceil, pi

import numpy as np

from wedgesweep import excitation
from wedgesweep.config import Config
from wedgesweep.diagnose.fit_parameters import Values
from wedgesweep.diagnose.smoothing import HIGHEST, LowPass, white_noise
from wedgesweep.effects import merge
from wedgesweep.solvers import periodic
from wedgesweep.systems import state_count

# Samples that are compared of one channel, at most: others are left out evenly.
MOST_SAMPLES = 20_000
# Least samples in a natural period of a simulation.
LEAST_PER_PERIOD = 16
# Share of the record at its end whose mean is where the motion comes to rest.
REST = 0.1


@dataclass(frozen=True, eq=False)
class Release:
    """One test.

    ``model``: the base model with the numbers of the test; ``step`` (s) between samples; ``channels`` (C, n):
    displacement (m) and, where it was recorded, velocity (m/s); ``noise`` (C,): std of a sample.
    """

    name: str
    model: Config
    law: str
    step: float
    channels: np.ndarray
    noise: np.ndarray

    @property
    def length(self) -> float:
        """Largest displacement (m) from where the motion comes to rest."""
        return float(np.abs(self.channels[0] - self._rest).max())

    @property
    def _rest(self) -> float:
        tail = max(int(REST * self.channels.shape[1]), 1)
        return float(self.channels[0, -tail:].mean())

    def start(self) -> tuple[float, float]:
        """Displacement (m) and velocity (m/s) at the first sample, roughly."""
        smooth = LowPass(0.5 * HIGHEST / self.step, 1.0 / self.step)(self.channels[0])
        return float(smooth[0] - self._rest), float(np.gradient(smooth)[0] / self.step)

    def simulated(self, scenarios: list[Values], starts: np.ndarray, tolerance: float) -> np.ndarray:
        """Displacements and velocities (n, C, k) of n scenarios from their starts (n, 2); NaN for none."""
        per_sample, per_period, omega = self._grid
        rows = np.concatenate(
            [
                self.model.record_with(merge(self.model.effects, each), self.law, 1.0, omega)
                for each in scenarios
            ]
        )
        excitation.set_no_motion(rows, self.length)
        states = np.zeros((len(rows), state_count()))
        # Channels are minus what solvers record, which the suspension has as its state.
        states[:, :2] = starts if self.model.system == "oscillator" else -starts
        periods = ceil(self.channels.shape[1] * per_sample / per_period)
        x, velocity, _ = periodic.samples(rows, states, 0, periods, per_period, tolerance)
        signals = -np.stack([x, velocity], axis=1)[:, : len(self.channels)]
        return signals[..., : self.channels.shape[1] * per_sample : per_sample]

    @property
    def periods(self) -> float:
        """Length of the record in natural periods of the model."""
        _, per_period, _ = self._grid
        return self.channels.shape[1] * self._grid[0] / per_period

    @property
    def _grid(self) -> tuple[int, int, float]:
        """Simulated samples for each recorded one, and in a period, and the period's angular frequency."""
        travel = max(self.length, 1e-300)
        period = 2.0 * pi * self.model.natural_units(travel).time
        per_sample = max(1, ceil(LEAST_PER_PERIOD * self.step / period))
        per_period = max(round(period * per_sample / self.step), LEAST_PER_PERIOD)
        return per_sample, per_period, 2.0 * pi * per_sample / (per_period * self.step)


def release(name: str, model: Config, law: str, rate: float, channels: np.ndarray) -> Release:
    """Prepare a test from its channels (C, n), sampled at a rate (Hz)."""
    noise = np.array([white_noise(each, rate) for each in channels])
    stride = ceil(channels.shape[1] / MOST_SAMPLES)
    return Release(name, model, law, stride / rate, channels[:, ::stride], noise)
