"""Steady harmonics under a recorded input: amplitude, phase and distortion are what was measured.

The Fourier coefficients of the input become the base motion of the simulation. Their noise reaches the
comparison through the response: with K the derivative of the residual by the coefficients, and V their
covariance, the residual has the covariance

    I + K V K^T + C K^T + K C^T

in units of the responses' own noise, C being the covariance of the latter with that of the input.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple, Self

import numpy as np

from wedgesweep import excitation
from wedgesweep.diagnose.evaluation import Evaluation, Scenario
from wedgesweep.diagnose.fit_data import INPUT_GAIN
from wedgesweep.diagnose.model import TIGHT
from wedgesweep.diagnose.steady.harmonic_data import HarmonicData, Simulated
from wedgesweep.diagnose.steady.spectra import Spectrum
from wedgesweep.diagnose.steady.stated_input import LEAST_STEP
from wedgesweep.effects.channel_delay import NAME as DELAY
from wedgesweep.sampled_input import INTEGRATED

# Effects of sensors: the number that is set, and its value without the effect.
SENSORS = (("displacement_gain", "scale", 1.0), ("velocity_lag", "time", 0.0))
# Squares of harmonics over the mean square of their noise. Below the first, which one of 55 exceeds by noise
# alone, they count as noise; above the second, which one of 160,000 exceeds, they do not.
DOUBTFUL, CERTAIN = 4.0, 12.0
# A harmonic counts by the share of its square that exceeds this many times its noise.
ABOVE_NOISE = 2.0


class InputHarmonics(NamedTuple):
    """Recorded inputs of T tests.

    ``displacement`` (T, N), complex: u = Re sum_h U_h exp(i h omega t) in m, t from the first sample, without
    harmonics that may be noise; or a force in N of the same form. ``variance`` (T, N): of each of these
    numbers. ``conversion`` (T, C, N): factor by which each was added to a channel to convert that to the
    motion that is simulated. ``shared`` (T, C, H), complex: covariance of the noise of channels and input,
    over both standard deviations.
    """

    displacement: np.ndarray
    variance: np.ndarray
    conversion: np.ndarray
    shared: np.ndarray

    @property
    def amplitude(self) -> np.ndarray:
        """Of the fundamental, (T,), in m or N."""
        return np.abs(self.displacement[:, 0])

    @property
    def phase(self) -> np.ndarray:
        """Of the fundamental as a sine, at the first sample, (T,)."""
        return np.angle(1j * self.displacement[:, 0])

    @property
    def shape(self) -> np.ndarray:
        """Harmonics (T, N) over the amplitude, from phase 0 of the fundamental."""
        orders = np.arange(1, self.displacement.shape[1] + 1)
        turned = self.displacement * np.exp(-1j * self.phase[:, None] * orders)
        turned /= self.amplitude[:, None]
        turned[:, 0] = -1j
        return turned

    def of(self, rows: np.ndarray) -> "InputHarmonics":
        """Some of the tests."""
        return InputHarmonics(*(each[rows] for each in self))


def without_noise(measured: np.ndarray, variance: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Harmonics (N,) of an input that stand out of their noise, others 0, and the variances of all.

    What may be noise is no part of the input: its acceleration would be large, and a test in which friction
    nearly holds may depend so much on it that the response is not linear in it. A doubtful harmonic counts as
    an error of its own size.
    """
    power = np.abs(measured) ** 2
    above_noise = 1.0 - ABOVE_NOISE * variance / np.maximum(power, 1e-300)
    share = np.where(power > CERTAIN * variance, above_noise, 0.0)
    share[0] = 1.0
    error = np.where(power > DOUBTFUL * variance, power, 0.0)
    return share * measured, np.where(share > 0.0, share * variance, error)


@dataclass(frozen=True, kw_only=True)
class RecordedInputData(HarmonicData):
    """Harmonics of steady tests whose input was recorded.

    ``inputs``: the recorded inputs. ``hidden``: effects that these channels cannot show.
    """

    inputs: InputHarmonics
    hidden: tuple[str, ...] = ()

    eliminated = 0

    def subset(self, rows: np.ndarray) -> Self:
        return replace(super().subset(rows), inputs=self.inputs.of(rows))

    def with_undetected(self, effect: str) -> Self:
        return self if effect in self.hidden else super().with_undetected(effect)

    def candidates(self, effects: Sequence[str]) -> tuple[str, ...]:
        shown = {*super().candidates(effects), DELAY, *(() if self.input_gain_std else (INPUT_GAIN,))}
        return tuple(name for name in effects if name in shown and name not in self.hidden)

    def records(self, scenario: Scenario) -> np.ndarray:
        left_out = (*self.hidden, INPUT_GAIN)
        shown = {name: each for name, each in scenario.values.items() if name not in left_out}
        rows = super().records(scenario._replace(values=shown))
        rows["input"]["amplitude"] = self.inputs_of(scenario)
        for sensor, number, neutral in SENSORS:
            if sensor in self.hidden:
                rows[sensor][number] = neutral
        excitation.set_series(rows, self.inputs.shape)
        return rows

    def inputs_of(self, scenario: Scenario) -> np.ndarray:
        return self.reference * self._gain(scenario)

    def _gain(self, scenario: Scenario) -> np.ndarray:
        """True input over the recorded one (T,): gain common to all tests times that of each test."""
        common = scenario.values.get(INPUT_GAIN, {"scale": 1.0})["scale"]
        return common * np.exp(scenario.point.nuisance[:, 0])

    def _simulate(self, scenarios: Sequence[Scenario], tolerance: float) -> Simulated:
        """Simulated harmonics, less what the error of the gain does to channels that the input converts."""
        done = super()._simulate(scenarios, tolerance)
        inputs = self.inputs
        channels, orders = done.harmonics.shape[2], inputs.displacement.shape[1]
        from_zero = inputs.displacement * np.exp(-1j * inputs.phase[:, None] * np.arange(1, orders + 1))
        share = inputs.conversion[:, :channels] * from_zero[:, None]
        for found, scenario in zip(done.harmonics, scenarios, strict=True):
            late = scenario.values.get(DELAY, {"time": 0.0})["time"]
            turn = -1j * late * self.omega[:, None] * np.arange(1, found.shape[-1] + 1)
            found *= np.exp(turn)[:, None]
            error = self._gain(scenario) - 1.0
            found[:, :channels, :orders] -= error[:, None, None] * share
        return done

    def start_phase(self, simulated: np.ndarray, other: np.ndarray | float = 0.0) -> np.ndarray:
        """Phase (rad) of the input at the first sample, as recorded."""
        return np.broadcast_to(self.inputs.phase, simulated.shape[:-2]).copy()

    def eliminated_derivatives(self, here: Evaluation) -> np.ndarray:
        return np.zeros((*here.residual.shape, 0))

    def predicted_nuisances(self, evaluation: Evaluation, step: np.ndarray) -> np.ndarray:
        return step

    def aligned_to(self, evaluation: Evaluation) -> Self:
        return self

    def covariance(self, scenario: Scenario) -> np.ndarray:
        bare = self.bare()
        tests, orders = self.inputs.displacement.shape
        here = bare.compare([scenario], TIGHT)[0]
        warm = replace(scenario.point, warm=here.warm)
        width = 2 * self.shape[0] * self.columns
        covariance = np.tile(np.eye(width), (tests, 1, 1))
        shared = self._shared_noise()
        for order in range(orders):
            std = np.sqrt(0.5 * self.inputs.variance[:, order])
            if not std.any():
                continue
            step = np.maximum(std, LEAST_STEP / (order + 1) * self.inputs.amplitude)
            for part, turn in enumerate((1.0, 1j)):
                moved = [bare._with_coefficient(order, sign * turn * step) for sign in (1.0, -1.0)]
                above, below = (each.compare([Scenario(scenario.values, warm)], TIGHT)[0] for each in moved)
                found = above.found & below.found
                change = np.where(found[:, None], 0.5 * (above.residual - below.residual), 0.0)
                column = change * (std / step)[:, None]
                covariance += column[:, :, None] * column[:, None, :]
                if order < shared.shape[-1]:
                    cross = column[:, :, None] * shared[:, part, :, order][:, None, :]
                    covariance += cross + np.swapaxes(cross, 1, 2)
        return covariance

    def _with_coefficient(self, order: int, change: np.ndarray) -> Self:
        """The data as if a coefficient of the inputs had been recorded with a change (T,) in m."""
        displacement = self.inputs.displacement.copy()
        displacement[:, order] += change
        spectra = []
        for t, spectrum in enumerate(self.spectra):
            mean = spectrum.mean.copy()
            if order < mean.shape[1]:
                mean[:, order] += self.inputs.conversion[t, : len(mean), order] * change[t]
            spectra.append(replace(spectrum, mean=mean))
        inputs = self.inputs._replace(displacement=displacement)
        return replace(self, inputs=inputs, spectra=tuple(spectra), amplitude=inputs.amplitude)

    def _shared_noise(self) -> np.ndarray:
        """Covariance (T, 2, m, H) of whitened residuals with the parts of each harmonic of the input.

        Real and imaginary part (axis 1) are over their standard deviation.
        """
        channels, columns = self.shape[0], self.columns
        found = np.zeros((self.inputs.shared.shape[0], 2, 2, channels, columns, columns))
        full = np.zeros((found.shape[0], channels, columns), complex)
        given = self.inputs.shared[:, :channels, :columns]
        full[:, : given.shape[1], : given.shape[2]] = given
        # Of the noise alone; model errors have nothing to do with the input.
        scale = np.sqrt(np.where(self.weight > 0.0, self._noise, 0.0))
        both = self.whiten(full * scale) / np.sqrt(2.0)
        for h in range(columns):
            found[:, 0, 0, :, h, h], found[:, 0, 1, :, h, h] = both[..., h].real, both[..., h].imag
            found[:, 1, 0, :, h, h], found[:, 1, 1, :, h, h] = -both[..., h].imag, both[..., h].real
        return found.reshape(found.shape[0], 2, 2 * channels * columns, columns)


def input_harmonics(spectrum: Spectrum, quantity: str) -> tuple[np.ndarray, np.ndarray]:
    """Displacement harmonics (N,) in m of a recorded quantity, and their variances."""
    factor = motion_factor(spectrum, quantity)
    return spectrum.mean[0] * factor, spectrum.variance[0] * np.abs(factor) ** 2


def motion_factor(spectrum: Spectrum, quantity: str) -> np.ndarray:
    """What turns the harmonics (N,) of a quantity into those of the displacement; a force stays one."""
    rate = 2j * np.pi * spectrum.frequency * np.arange(1, spectrum.mean.shape[1] + 1)
    return rate ** -INTEGRATED[quantity]
