"""Steady harmonics of tests whose input is not exactly known, which makes their residuals correlated.

In units of the responses' own noise and of the model error that is allowed, the residual of a test has a
covariance matrix that is not the unit matrix. It depends on how the model passes the input on. All
explanations are compared under one covariance.
"""

from abc import abstractmethod
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Self

import numpy as np

from wedgesweep.diagnose.evaluation import Point, Scenario
from wedgesweep.diagnose.steady.harmonic_data import HarmonicData
from wedgesweep.diagnose.steady.whitened import real

# A covariance is replaced if the variance of some combination of residuals changes by more than this factor.
CHANGED = 1.1


@dataclass(frozen=True)
class CorrelatedHarmonics(HarmonicData):
    """Harmonics of steady tests, m real numbers in each, with a covariance.

    ``whitening`` (T, m, m): turns residuals over the noise of the responses into such of unit covariance;
    None before the covariance is known.
    """

    whitening: np.ndarray | None = None

    @abstractmethod
    def covariance(self, scenario: Scenario) -> np.ndarray:
        """Of residuals over the noise of the responses, (T, m, m), by the response in a scenario."""

    @cached_property
    def power(self) -> np.ndarray:
        """Squared misfit of a simulation of nothing at all, (T,)."""
        return (self.decorrelated(real(self.whitened)) ** 2).sum(-1)

    def decorrelated(self, residual: np.ndarray) -> np.ndarray:
        if self.whitening is None:
            return residual
        return np.einsum("tij,...tj->...ti", self.whitening, residual)

    def correlated(self, noise: np.ndarray) -> np.ndarray:
        """Noise of unit covariance (..., T, m) as residuals over the noise of the responses alone."""
        if self.whitening is None:
            return noise
        return np.einsum("tij,...tj->...ti", np.linalg.inv(self.whitening), noise)

    def subset(self, rows: np.ndarray) -> Self:
        some = super().subset(rows)
        whitening = None if self.whitening is None else self._cut(self.whitening[rows], some)
        return replace(some, whitening=whitening)

    def _cut(self, whitening: np.ndarray, some: HarmonicData) -> np.ndarray:
        """The matrices for data padded to fewer harmonics or channels."""
        kept = np.zeros((2, self.shape[0], self.columns), bool)
        kept[:, : some.shape[0], : some.shape[1]] = True
        if self.tone is not None:
            kept[:, : some.shape[0], -1] = True
        place = np.flatnonzero(kept)
        return whitening[:, place[:, None], place]

    def with_undetected(self, effect: str) -> Self:
        wider = super().with_undetected(effect)
        if self.whitening is None:
            return wider
        # What is unknown of an input does not matter at a tone between its harmonics.
        harmonic = np.zeros((2, self.shape[0], wider.columns), bool)
        harmonic[..., : self.shape[1]] = True
        place = np.flatnonzero(harmonic)
        whitening = np.tile(np.eye(harmonic.size), (self.tests, 1, 1))
        whitening[:, place[:, None], place] = self.whitening
        return replace(wider, whitening=whitening)

    def bare(self) -> Self:
        """The data as if inputs were exactly known."""
        return replace(self, whitening=None)

    def with_covariance(self, scenario: Scenario) -> Self:
        """The data with the covariance of their residuals in a scenario."""
        return replace(self, whitening=_inverse_root(self.covariance(scenario)))

    def renewed(self, scenario: Scenario) -> Self:
        if self.whitening is None:
            return self
        there = self.with_covariance(scenario)
        assert there.whitening is not None
        both = self.whitening @ np.linalg.inv(there.whitening)
        ratio = np.linalg.eigvalsh(both @ np.swapaxes(both, 1, 2))
        return there if np.abs(np.log(ratio)).max() > np.log(CHANGED) else self

    def with_model_error(self, size: float) -> Self:
        some = super().with_model_error(size)
        if self.whitening is None:
            return some
        turn = _real_matrix(some.whitening_of_responses @ self._unwhitening_of_responses)
        return replace(some, whitening=self._transformed_whitening(turn))

    def _transformed_whitening(self, turn: np.ndarray) -> np.ndarray:
        """The whitening after residuals were multiplied by matrices ``turn`` (T, m, m)."""
        by_input = turn @ self.by_input @ np.swapaxes(turn, 1, 2)
        return _inverse_root(np.eye(by_input.shape[-1]) + by_input)

    @cached_property
    def by_input(self) -> np.ndarray:
        """Covariance (T, m, m) that the inputs add to the unit matrix of the responses' own noise."""
        assert self.whitening is not None
        inverse = np.linalg.inv(self.whitening)
        return inverse @ inverse - np.eye(inverse.shape[-1])

    @cached_property
    def _unwhitening_of_responses(self) -> np.ndarray:
        """What takes back ``whitening_of_responses``, (T, n, n)."""
        return np.linalg.pinv(self.whitening_of_responses)

    @property
    def whitening_of_responses(self) -> np.ndarray:
        """What ``whiten`` does as matrices (T, n, n) for the n harmonics of all channels."""
        size = self.shape[0] * self.columns
        unit = np.eye(size, dtype=complex).reshape(size, 1, self.shape[0], self.columns)
        columns = self.whiten(np.repeat(unit, self.tests, axis=1)).reshape(size, self.tests, size)
        return columns.transpose(1, 2, 0)


def _real_matrix(matrices: np.ndarray) -> np.ndarray:
    """Matrices (T, n, n) for complex vectors as (T, 2 n, 2 n) for their real and imaginary parts."""
    top = np.concatenate([matrices.real, -matrices.imag], axis=2)
    return np.concatenate([top, np.concatenate([matrices.imag, matrices.real], axis=2)], axis=1)


def _inverse_root(covariance: np.ndarray) -> np.ndarray:
    """Symmetric matrices W (T, m, m) with W covariance W = 1; eigenvalues below 0.1 count as 0.1."""
    values, vectors = np.linalg.eigh(covariance)
    return (vectors / np.sqrt(np.maximum(values, 0.1))[:, None, :]) @ np.swapaxes(vectors, 1, 2)


def stated(data: HarmonicData) -> Scenario:
    """The scenario of the base model as stated, each test starting at rest."""
    return Scenario({}, Point(np.zeros(0), *data.start()))
