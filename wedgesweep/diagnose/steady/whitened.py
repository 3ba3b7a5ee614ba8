"""Measured harmonics of all tests over their noise, and how simulated ones are brought to the same form.

Arrays are padded to the same number of channels and harmonics; what a test does not have weighs nothing.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import inf, nan, pi
from typing import Self

import numpy as np

from wedgesweep.config import Config
from wedgesweep.diagnose.steady import column_load
from wedgesweep.diagnose.steady.column_load import ColumnLoad
from wedgesweep.diagnose.steady.simulation import LONGEST_SIMULATED, ToneTiming
from wedgesweep.diagnose.steady.spectra import SIMULATED, Spectrum

# Number of phases of a period at which signals are drawn and start phases are tried, and of Newton steps from
# the best one at most; in rad their largest length and a negligible one.
PHASES, NEWTON_STEPS, NEWTON_LENGTH, NEGLIGIBLE = 256, 12, 0.05, 1e-7
# Least variance of a combination of residuals, over that of the responses' own noise: sampling errors of the
# noise that channels and input share may make it smaller, or negative.
LEAST_VARIANCE = 0.1


@dataclass(frozen=True)
class WhitenedHarmonics:
    """T tests with up to C channels and H harmonics each.

    ``amplitude`` (T,): input amplitude in m, NaN where unknown. ``amplitude_std`` (T,): its relative
    standard deviation, 0 where exact, inf where unknown. ``uncertain``: see FitData. ``tone``: frequency
    (Hz) of a spurious tone in the records, with its standard deviation ``tone_std``; its complex amplitude
    is one more column behind the harmonics, with a phase of its own in each test. ``input_phase`` (T,):
    phase (rad) of the input at the first sample of each record, None before a first fit has found it.
    ``models``: the base model of each test, if they differ.
    ``model_error``: relative error that a model may have; its variance is part of that of the harmonics.
    ``by_input`` (T, m, m): covariance that errors of the inputs add to the harmonics as real vectors (see
    ``real``), in m and m/s; None for inputs that are exactly known.
    ``loads``: of the column in each test, None where it is not compared; empty if in none. They are the third
    channel (N), and add a column behind the harmonics, their mean. There is no tone beside them.
    """

    model: Config
    law: str
    names: tuple[str, ...]
    spectra: tuple[Spectrum, ...]
    amplitude: np.ndarray
    amplitude_std: np.ndarray
    uncertain: dict[str, float]
    tone: float | None = None
    tone_std: float = 0.0
    input_phase: np.ndarray | None = None
    models: tuple[Config, ...] | None = None
    model_error: float = 0.0
    by_input: np.ndarray | None = None
    loads: tuple[ColumnLoad | None, ...] = ()

    @property
    def tests(self) -> int:
        return len(self.spectra)

    @cached_property
    def omega(self) -> np.ndarray:
        """Angular frequency of the input in rad/s, (T,)."""
        return np.array([2.0 * pi * each.frequency for each in self.spectra])

    @cached_property
    def shape(self) -> tuple[int, int]:
        """Channels and harmonics of the padded arrays, a tone and the mean of a load not counted."""
        channels = max(s.mean.shape[0] for s in self.spectra)
        if self.loads:
            channels = column_load.CHANNEL + 1
        return channels, max(s.harmonics for s in self.spectra)

    @property
    def columns(self) -> int:
        """Number of harmonics, and of the tone or the mean of the load if there is one."""
        return self.shape[1] + (self.tone is not None or bool(self.loads))

    @cached_property
    def orders(self) -> np.ndarray:
        """1..H."""
        return np.arange(1, self.shape[1] + 1)

    @cached_property
    def turning_orders(self) -> np.ndarray:
        """Orders by which a start phase turns what is compared; 0 for a mean, and a tone of its own phase."""
        return np.r_[self.orders, [0] * (self.columns - self.orders.size)]

    @cached_property
    def observations(self) -> np.ndarray:
        """Real numbers that each test contributes, (T,)."""
        return np.array([s.observations for s in self.spectra]) + self._numbers_of_load

    @cached_property
    def _numbers_of_load(self) -> np.ndarray:
        """Real numbers (T,) that loads contribute, or 0: two of each harmonic, and the mean."""
        loads = self.loads or (None,) * self.tests
        return np.array([0 if each is None else 2 * each.mean.size - 1 for each in loads])

    @cached_property
    def tone_timings(self) -> tuple[ToneTiming, ...]:
        """Relative timing of input and tone in each record."""
        starts = np.zeros(self.tests) if self.input_phase is None else self.input_phase
        return tuple(
            ToneTiming(min(s.periods, LONGEST_SIMULATED), float(start), _tone_phase(s))
            for s, start in zip(self.spectra, starts, strict=True)
        )

    def subset(self, rows: np.ndarray) -> Self:
        """The same data with some of the tests."""
        some = replace(
            self,
            names=tuple(self.names[i] for i in rows),
            spectra=tuple(self.spectra[i] for i in rows),
            amplitude=self.amplitude[rows],
            amplitude_std=self.amplitude_std[rows],
            input_phase=None if self.input_phase is None else self.input_phase[rows],
            models=None if self.models is None else tuple(self.models[i] for i in rows),
            loads=tuple(self.loads[i] for i in rows) if self.loads else (),
        )
        if self.by_input is None:
            return some
        # They may be padded to fewer channels or harmonics.
        kept = np.zeros((2, self.shape[0], self.columns), bool)
        kept[:, : some.shape[0], : some.shape[1]] = True
        kept[:, : some.shape[0], self.shape[1] :] = True
        place = np.flatnonzero(kept)
        return replace(some, by_input=self.by_input[rows][:, place[:, None], place])

    def _padded(
        self, values: list[np.ndarray], loads: Sequence[np.ndarray | None], fill: float
    ) -> np.ndarray:
        full = np.full((self.tests, self.shape[0], self.columns), fill, dtype=values[0].dtype)
        for row, value, spectrum in zip(full, values, self.spectra, strict=True):
            channels, harmonics = value.shape[0], spectrum.harmonics
            row[:channels, :harmonics] = value[:, :harmonics]
            if spectrum.tone is not None:
                row[:channels, -1] = value[:, -1]
        for row, load in zip(full, loads, strict=False):
            if load is not None:
                row[column_load.CHANNEL, : load.size - 1], row[column_load.CHANNEL, -1] = load[:-1], load[-1]
        return full

    @cached_property
    def measured(self) -> np.ndarray:
        """Measured harmonics (T, C, H), complex, in m and m/s; 0 where absent."""
        return self._padded([s.mean for s in self.spectra], [each and each.mean for each in self.loads], 0.0)

    @cached_property
    def _noise(self) -> np.ndarray:
        """Variance (T, C, H) of the noise of a harmonic, real and imaginary part together; inf if absent."""
        loads = [each and each.variance for each in self.loads]
        return self._padded([s.variance for s in self.spectra], loads, inf)

    @cached_property
    def _power(self) -> np.ndarray:
        """Variance (T, C, H) that a model error as large as the response gives a harmonic; 0 where absent.

        The error has the rms of the response of its channel, spread evenly over what is compared.
        """
        power = [(np.abs(s.mean) ** 2).mean(axis=1, keepdims=True) + 0.0 * s.variance for s in self.spectra]
        return self._padded(power, [each and each.power for each in self.loads], 0.0)

    @cached_property
    def _noise_share(self) -> np.ndarray:
        """Share (T, C, H) of noise in the variance, the rest being model error; 1 without model error."""
        noise = np.where(np.isinf(self._noise), 1.0, self._noise)
        return noise / (noise + self.model_error**2 * self._power)

    @cached_property
    def weight(self) -> np.ndarray:
        """One over the std of a real part by noise and model error, (T, C, H).

        0 where absent or masked by a tone.
        """
        weight = np.sqrt(2.0 / (self._noise + self.model_error**2 * self._power))
        for row, spectrum in zip(weight, self.spectra, strict=True):
            if spectrum.masked_harmonic is not None:
                row[:, spectrum.masked_harmonic - 1] = 0.0
        return weight

    @cached_property
    def coherence(self) -> np.ndarray:
        """Complex coherence (T, H) of the channels' noise and model errors; the latter are independent."""
        coherence = np.array([s.coherence for s in self.spectra])
        return coherence[:, None] * np.sqrt(self._noise_share[:, 0] * self._noise_share[:, :2][:, -1])

    @property
    def model_misfit(self) -> np.ndarray:
        """Squared misfit (T,) that model errors of the allowed size would leave on average."""
        errors = 2.0 * np.where(self.weight > 0.0, 1.0 - self._noise_share, 0.0)
        if self.loads:
            errors[..., -1] *= 0.5  # a mean is one number
        return errors.sum(axis=(-2, -1))

    @property
    def noise_floor(self) -> float:
        """Rms of the noise over that of the response, in what is compared."""
        seen = (self.weight > 0.0) & (self._power > 0.0)
        return float(np.sqrt(np.mean(self._noise[seen] / self._power[seen]))) if seen.any() else nan

    @cached_property
    def whitened(self) -> np.ndarray:
        """The measured harmonics over their noise, (T, C, H)."""
        return self.whiten(self.measured)

    @cached_property
    def power(self) -> np.ndarray:
        """Squared misfit of a simulation of nothing at all, (T,), in the motion."""
        return self.squared(self.of_motion(self.whitened))

    def of_motion(self, whitened: np.ndarray) -> np.ndarray:
        """Whitened harmonics (..., T, C, H) without those of a load, which is there without any motion."""
        if not self.loads:
            return whitened
        return np.where(np.arange(self.shape[0])[:, None] < column_load.CHANNEL, whitened, 0.0)

    def squared(self, whitened: np.ndarray) -> np.ndarray:
        """Squared misfit (..., T) of whitened harmonics (..., T, C, H)."""
        return (self.decorrelated(real(whitened)) ** 2).sum(-1)

    @cached_property
    def whitening(self) -> np.ndarray | None:
        """Symmetric matrices (T, m, m) that give residuals over the noise of the responses unit covariance.

        None for inputs that are exactly known: they have it already.
        """
        if self.by_input is None:
            return None
        turn = self.matrices(self.whiten)
        values, vectors = np.linalg.eigh(
            np.eye(turn.shape[-1]) + turn @ self.by_input @ np.swapaxes(turn, 1, 2)
        )
        std = np.sqrt(np.maximum(values, LEAST_VARIANCE))
        return (vectors / std[:, None, :]) @ np.swapaxes(vectors, 1, 2)

    def decorrelated(self, residual: np.ndarray) -> np.ndarray:
        """Residuals (..., T, m) over the noise of the responses, transformed to unit covariance."""
        if self.whitening is None:
            return residual
        return np.einsum("tij,...tj->...ti", self.whitening, residual)

    def correlated(self, noise: np.ndarray) -> np.ndarray:
        """The inverse of ``decorrelated``: values that it turns into some noise (..., T, m)."""
        if self.whitening is None:
            return noise
        return np.einsum("tij,...tj->...ti", np.linalg.inv(self.whitening), noise)

    def matrices(self, function: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
        """A linear function of harmonics (..., T, C, H) as matrices (T, m, m) for real vectors."""
        size = self.shape[0] * self.columns
        unit = np.eye(size, dtype=complex).reshape(size, 1, self.shape[0], self.columns)
        columns = function(np.repeat(unit, self.tests, axis=1)).reshape(size, self.tests, size)
        found = columns.transpose(1, 2, 0)
        top = np.concatenate([found.real, -found.imag], axis=2)
        return np.concatenate([top, np.concatenate([found.imag, found.real], axis=2)], axis=1)

    def whiten(self, harmonics: np.ndarray) -> np.ndarray:
        """Harmonics (..., T, C, H) over their noise, complex, the channels' common noise removed."""
        scaled = harmonics[..., : self.shape[0], :] * self.weight
        if self.shape[0] > 1 and self.coherence.any():
            share = self.coherence
            second = (scaled[..., 1, :] - share * scaled[..., 0, :]) / np.sqrt(1.0 - abs(share) ** 2)
            scaled[..., 1, :] = second
        return scaled

    def unwhiten(self, whitened: np.ndarray) -> np.ndarray:
        """Harmonics (..., T, C, H) that ``whiten`` turns into these; 0 where nothing is compared."""
        scaled = whitened
        if self.shape[0] > 1 and self.coherence.any():
            share = self.coherence
            second = np.sqrt(1.0 - abs(share) ** 2) * whitened[..., 1, :] + share * whitened[..., 0, :]
            scaled = whitened.astype(complex)
            scaled[..., 1, :] = second
        return np.divide(scaled, self.weight, out=np.zeros_like(scaled), where=self.weight > 0.0)

    def compared(self, simulated: np.ndarray) -> np.ndarray:
        """Harmonics (..., H) that are compared, of simulated ones (..., K); a tone or mean is last."""
        if self.columns == self.shape[1]:
            return simulated[..., : self.shape[1]]
        return np.concatenate([simulated[..., : self.shape[1]], simulated[..., -1:]], axis=-1)

    def aliases(self, simulated: np.ndarray, phase: np.ndarray) -> np.ndarray:
        """What harmonics above half the sampling rate add to those that are compared (..., T, C, H).

        Parameters
        ----------
        simulated : ndarray, shape (..., T, C, K)
            Simulated harmonics; there are no aliases unless there are at least SIMULATED of them.
        phase : ndarray, shape (..., T)
            Phase (rad) of the input at the first sample.
        """
        found = np.zeros((*simulated.shape[:-1], self.columns), complex)
        if simulated.shape[-1] < SIMULATED:
            return found
        orders = np.arange(1, SIMULATED + 1)
        for i, spectrum in enumerate(self.spectra):
            if spectrum.alias_map is not None:
                turn = np.exp(1j * orders * phase[..., i, None, None])
                read = spectrum.alias_map(simulated[..., i, :, :SIMULATED] * turn)
                found[..., i, :, : spectrum.harmonics] = read[..., : spectrum.harmonics]
                if spectrum.tone is not None:
                    found[..., i, :, -1] = read[..., -1]
        found[..., column_load.CHANNEL :, :] = 0.0  # of a load they are filtered out
        return found

    def start_phase(self, simulated: np.ndarray, other: np.ndarray | float = 0.0) -> np.ndarray:
        """Rotation (rad) that brings whitened simulations (..., T, C, H) closest to the measurement.

        It is that of the least misfit under the covariance, by Newton's method from the best one of PHASES
        without it. ``other``: part of the whitened measurement (..., T, C, H) that is not to be compared.
        """
        seen, orders = self.whitened - other, self.turning_orders
        overlap = (seen * simulated.conj()).sum(-2)[..., : self.shape[1]]
        wave = np.fft.fft(overlap, PHASES, axis=-1)  # orders 0..H-1 in place of 1..H: corrected below
        angles = 2.0 * pi * np.arange(PHASES) / PHASES
        phase = angles[np.argmax((wave * np.exp(-1j * angles)).real, axis=-1)]
        for _ in range(NEWTON_STEPS):
            turned = self.rotated(simulated, phase)
            parts = seen - turned, -1j * orders * turned, orders**2 * turned
            left, slope, bend = (self.decorrelated(real(each)) for each in parts)
            gauss = (slope**2).sum(-1)
            bend = gauss + (bend * left).sum(-1)
            # Far from the minimum the misfit may bend the other way.
            bend = np.where(bend > 0.0, bend, gauss)
            step = np.divide(-(slope * left).sum(-1), bend, out=np.zeros_like(bend), where=bend > 0.0)
            step = np.clip(step, -NEWTON_LENGTH, NEWTON_LENGTH)
            phase = phase + step
            if np.abs(step).max(initial=0.0) < NEGLIGIBLE:
                break
        return phase

    def rotated(self, simulated: np.ndarray, phase: np.ndarray) -> np.ndarray:
        """Harmonics (..., T, C, H) rotated by phases (..., T); a tone rotates to match the measurement."""
        turn = np.exp(1j * self.orders * phase[..., None])
        if self.loads:
            turn = np.concatenate([turn, np.ones((*phase.shape, 1))], axis=-1)
        if self.tone is not None:
            overlap = (self.whitened[..., -1] * simulated[..., -1].conj()).sum(-1)
            turn = np.concatenate([turn, np.exp(1j * np.angle(overlap))[..., None]], axis=-1)
        return simulated * turn[..., None, :]


def _tone_phase(spectrum: Spectrum) -> float:
    """Phase (rad) of a tone in the displacement at the first sample, NaN where there is none."""
    seen = spectrum.tone is not None and spectrum.mean[0, -1] != 0.0
    return float(np.angle(spectrum.mean[0, -1])) if seen else nan


def real(values: np.ndarray) -> np.ndarray:
    """Complex (..., T, C, H) as real vectors (..., T, 2 * C * H)."""
    flat = values.reshape(*values.shape[:-2], -1)
    return np.concatenate([flat.real, flat.imag], axis=-1)
