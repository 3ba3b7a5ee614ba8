"""Normal equations of a trial, in which amplitudes and phases are local to their tests."""

from dataclasses import dataclass

import numpy as np

from wedgesweep.diagnose.model import Model, Trial
from wedgesweep.diagnose.tangents import Tangents, tangents_of


@dataclass(frozen=True)
class Equations:
    """Normal equations: numbers (k), and what is local to each test (T, L), solved for first.

    Local are start phase, amplitude, and the phase of a foreign vibration where the point has one.
    """

    inner: np.ndarray
    mixed: np.ndarray
    right: np.ndarray
    outer: np.ndarray
    gradient: np.ndarray

    def eliminated(self, damping: float) -> tuple[np.ndarray, np.ndarray]:
        """What is local does by itself (T, L), and along with the numbers (T, L, k)."""
        inner = self.inner.copy()
        for i in range(1, inner.shape[-1]):
            inner[:, i, i] *= 1.0 + damping
        solved = np.linalg.solve(inner, np.concatenate([self.mixed, self.right[..., None]], axis=-1))
        return solved[..., -1], solved[..., :-1]

    def reduced(self, damping: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
        """Matrix (k, k) and gradient (k,) for the numbers alone."""
        own, along = self.eliminated(damping)
        matrix = self.outer - np.einsum("tik,til->kl", self.mixed, along)
        return matrix, self.gradient - np.einsum("tik,ti->k", self.mixed, own)

    def local(self, numbers: np.ndarray, damping: float) -> np.ndarray:
        """Steps of what is local (T, L) that go with a step of the numbers (k,)."""
        own, along = self.eliminated(damping)
        return -own - along @ numbers

    def promise(self, numbers: np.ndarray, local: np.ndarray) -> float:
        """What a step takes off Q if the responses are linear."""
        slope = self.gradient @ numbers + (self.right * local).sum()
        bend = numbers @ self.outer @ numbers + np.einsum("ti,tij,tj->", local, self.inner, local)
        bend += 2.0 * np.einsum("ti,tik,k->", local, self.mixed, numbers)
        return float(-2.0 * slope - bend)


def equations_of(model: Model, trial: Trial, tangents: Tangents | None = None) -> Equations:
    """Normal equations of a step from a trial, with its own derivatives if none are given."""
    by_number, by_test = tangents_of(model, trial) if tangents is None else tangents
    tests = model.problem.tests
    inner = np.einsum("tmi,tmj->tij", by_test, by_test)
    inner[:, 1, 1] += model.amplitude_weight**2
    inner += 1e-12 * (1.0 + np.einsum("tii->t", inner))[:, None, None] * np.eye(inner.shape[-1])
    right = np.einsum("tmi,tm->ti", by_test, trial.residual)
    right[:, 1] += model.amplitude_weight * trial.prior[:tests]
    outer = np.einsum("tmk,tml->kl", by_number, by_number)
    gradient = np.einsum("tmk,tm->k", by_number, trial.residual)
    free = np.arange(model.size, len(gradient))
    outer[free, free] += model.prior_std**-2.0
    gradient[model.size :] += trial.prior[tests:] / model.prior_std
    return Equations(inner, np.einsum("tmi,tmk->tik", by_test, by_number), right, outer, gradient)
