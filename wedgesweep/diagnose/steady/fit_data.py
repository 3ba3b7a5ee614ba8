"""The measured tests as one vector of whitened differences, and what is unknown about each test."""

from dataclasses import dataclass, replace
from functools import cached_property
from math import inf, nan, pi

import numpy as np

from wedgesweep.config import Config
from wedgesweep.diagnose.steady.simulation import LONGEST_SIMULATED, ToneTiming
from wedgesweep.diagnose.steady.spectra import SIMULATED, Spectrum

# Phases at which the best rotation is looked for.
TURNS = 256


@dataclass(frozen=True)
class FitData:
    """What the measurement says, with T tests, C channels and H harmonics (absent ones weigh nothing).

    ``amplitude`` (T,): input amplitude in m, NaN where unknown; ``amplitude_std`` (T,): relative, 0 where
    exact, inf where unknown. ``uncertain``: numbers of the model with their relative standard deviations.
    ``tone``: a foreign frequency (Hz) in the records, known to ``tone_std``; its complex amplitude is one
    more column behind the harmonics, with a phase of its own in each test. ``start`` (T,): phase (rad) of the
    input at the first sample of each record, as a first fit found it.
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
    start: np.ndarray | None = None

    @cached_property
    def timings(self) -> tuple[ToneTiming, ...]:
        """How input and tone met in each test; the input starts at phase 0 where that is not known yet."""
        starts = np.zeros(self.tests) if self.start is None else self.start
        return tuple(
            ToneTiming(min(s.periods, LONGEST_SIMULATED), float(start), _phase(s))
            for s, start in zip(self.spectra, starts, strict=True)
        )

    @cached_property
    def omega(self) -> np.ndarray:
        return np.array([2.0 * pi * each.frequency for each in self.spectra])

    @property
    def tests(self) -> int:
        return len(self.spectra)

    @cached_property
    def shape(self) -> tuple[int, int]:
        """Channels and harmonics of the padded arrays, a tone not counted."""
        return max(s.mean.shape[0] for s in self.spectra), max(s.harmonics for s in self.spectra)

    @property
    def columns(self) -> int:
        """Harmonics, and the tone where there is one."""
        return self.shape[1] + (self.tone is not None)

    def subset(self, rows: np.ndarray) -> "FitData":
        """The same problem with some of its tests."""
        return replace(
            self,
            names=tuple(self.names[i] for i in rows),
            spectra=tuple(self.spectra[i] for i in rows),
            amplitude=self.amplitude[rows],
            amplitude_std=self.amplitude_std[rows],
            start=None if self.start is None else self.start[rows],
        )

    def _padded(self, values: list[np.ndarray], fill: float) -> np.ndarray:
        full = np.full((self.tests, self.shape[0], self.columns), fill, dtype=values[0].dtype)
        for row, value, spectrum in zip(full, values, self.spectra, strict=True):
            channels, harmonics = value.shape[0], spectrum.harmonics
            row[:channels, :harmonics] = value[:, :harmonics]
            if spectrum.tone is not None:
                row[:channels, -1] = value[:, -1]
        return full

    @cached_property
    def measured(self) -> np.ndarray:
        """Harmonics (T, C, H), complex; 0 where absent."""
        return self._padded([s.mean for s in self.spectra], 0.0)

    @cached_property
    def weight(self) -> np.ndarray:
        """One over the noise of a real part, (T, C, H); 0 where absent or covered by a tone."""
        weight = np.sqrt(2.0 / self._padded([s.variance for s in self.spectra], inf))
        for row, spectrum in zip(weight, self.spectra, strict=True):
            if spectrum.masked is not None:
                row[:, spectrum.masked - 1] = 0.0
        return weight

    @cached_property
    def coherence(self) -> np.ndarray:
        return np.array([s.coherence for s in self.spectra])

    @cached_property
    def observations(self) -> np.ndarray:
        """Real numbers that each test contributes, (T,)."""
        return np.array([s.observations for s in self.spectra])

    @property
    def dof(self) -> np.ndarray:
        """Points of each test less its start phase, and its amplitude where that is unknown, (T,)."""
        return self.observations - 1 - np.isinf(self.amplitude_std)

    def whiten(self, harmonics: np.ndarray) -> np.ndarray:
        """Harmonics (..., T, C, H) over their noise, complex, with the channels' common noise taken out."""
        scaled = harmonics[..., : self.shape[0], :] * self.weight
        if self.shape[0] == 2 and self.coherence.any():
            share = self.coherence[:, None]
            second = (scaled[..., 1, :] - share * scaled[..., 0, :]) / np.sqrt(1.0 - abs(share) ** 2)
            scaled = np.stack([scaled[..., 0, :], second], axis=-2)
        return scaled

    def compared(self, simulated: np.ndarray) -> np.ndarray:
        """Of simulated harmonics (..., K), a tone last, those that are compared (..., H)."""
        if self.tone is None:
            return simulated[..., : self.shape[1]]
        return np.concatenate([simulated[..., : self.shape[1]], simulated[..., -1:]], axis=-1)

    def aliases(self, simulated: np.ndarray, phase: np.ndarray) -> np.ndarray:
        """What simulated harmonics (..., T, C, K) at phases (..., T) add to those compared (..., T, C, H).

        Nothing but by those above half the sampling rate, see folding.py.
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
        return found

    @cached_property
    def whitened(self) -> np.ndarray:
        """The measured harmonics over their noise, (T, C, H)."""
        return self.whiten(self.measured)

    @cached_property
    def power(self) -> np.ndarray:
        """Sum of squares of what was measured, over its noise (T,)."""
        return (np.abs(self.whitened) ** 2).sum(axis=(-2, -1))

    @cached_property
    def orders(self) -> np.ndarray:
        return np.arange(1, self.shape[1] + 1)

    def start_phase(self, simulated: np.ndarray, beside: np.ndarray | float = 0.0) -> np.ndarray:
        """Rotation (rad) that brings whitened simulations (..., T, C, H) closest to the measurement.

        ``beside``: what of the whitened measurement (..., T, C, H) is something else.
        """
        overlap = ((self.whitened - beside) * simulated.conj()).sum(-2)[..., : self.shape[1]]
        wave = np.fft.fft(overlap, TURNS, axis=-1)  # of orders 0..H-1: one turn too few, no matter to |.|
        angles = 2.0 * pi * np.arange(TURNS) / TURNS
        phase = angles[np.argmax((wave * np.exp(-1j * angles)).real, axis=-1)]
        for _ in range(4):
            turned = overlap * np.exp(-1j * self.orders * phase[..., None])
            slope = (self.orders * turned.imag).sum(-1)
            bend = -(self.orders**2 * turned.real).sum(-1)
            step = np.divide(-slope, bend, out=np.zeros_like(slope), where=bend < 0.0)
            phase = phase + np.clip(step, -0.02, 0.02)
        return phase

    def rotated(self, simulated: np.ndarray, phase: np.ndarray) -> np.ndarray:
        """Harmonics (..., T, C, H) turned by phases (..., T); a tone turns to suit the measurement."""
        turn = np.exp(1j * self.orders * phase[..., None])
        if self.tone is not None:
            overlap = (self.whitened[..., -1] * simulated[..., -1].conj()).sum(-1)
            turn = np.concatenate([turn, np.exp(1j * np.angle(overlap))[..., None]], axis=-1)
        return simulated * turn[..., None, :]


def _phase(spectrum: Spectrum) -> float:
    """Phase (rad) of a tone in the displacement, NaN where there is none."""
    seen = spectrum.tone is not None and spectrum.mean[0, -1] != 0.0
    return float(np.angle(spectrum.mean[0, -1])) if seen else nan


def real(values: np.ndarray) -> np.ndarray:
    """Complex (..., T, C, H) as real vectors (..., T, 2 * C * H)."""
    flat = values.reshape(*values.shape[:-2], -1)
    return np.concatenate([flat.real, flat.imag], axis=-1)
