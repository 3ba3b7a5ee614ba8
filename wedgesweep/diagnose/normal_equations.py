"""Normal equations of a trial, in which amplitudes and phases are local to their tests."""

from dataclasses import dataclass

import numpy as np

from wedgesweep.diagnose.jacobian import Jacobian, jacobian
from wedgesweep.diagnose.steady.model import Evaluation, Model


@dataclass(frozen=True)
class NormalEquations:
    """Normal equations: numbers (k), and what is local to each test (T, L), solved for first.

    Local are start phase, amplitude, and the phase of a foreign vibration where the point has one.
    """

    local_block: np.ndarray
    coupling_block: np.ndarray
    local_gradient: np.ndarray
    global_block: np.ndarray
    global_gradient: np.ndarray

    def eliminated(self, damping: float) -> tuple[np.ndarray, np.ndarray]:
        """What is local does by itself (T, L), and along with the numbers (T, L, k)."""
        inner = self.local_block.copy()
        for i in range(1, inner.shape[-1]):
            inner[:, i, i] *= 1.0 + damping
        solved = np.linalg.solve(
            inner, np.concatenate([self.coupling_block, self.local_gradient[..., None]], axis=-1)
        )
        return solved[..., -1], solved[..., :-1]

    def schur_complement(self, damping: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
        """Matrix (k, k) and gradient (k,) for the numbers alone."""
        own, along = self.eliminated(damping)
        matrix = self.global_block - np.einsum("tik,til->kl", self.coupling_block, along)
        return matrix, self.global_gradient - np.einsum("tik,ti->k", self.coupling_block, own)

    def local_step(self, numbers: np.ndarray, damping: float) -> np.ndarray:
        """Steps of what is local (T, L) that go with a step of the numbers (k,)."""
        own, along = self.eliminated(damping)
        return -own - along @ numbers

    def predicted_reduction(self, numbers: np.ndarray, local: np.ndarray) -> float:
        """What a step takes off Q if the responses are linear."""
        slope = self.global_gradient @ numbers + (self.local_gradient * local).sum()
        bend = numbers @ self.global_block @ numbers + np.einsum(
            "ti,tij,tj->", local, self.local_block, local
        )
        bend += 2.0 * np.einsum("ti,tik,k->", local, self.coupling_block, numbers)
        return float(-2.0 * slope - bend)


def normal_equations(
    model: Model, evaluation: Evaluation, tangents: Jacobian | None = None
) -> NormalEquations:
    """Normal equations of a step from a trial, with its own derivatives if none are given."""
    by_parameter, by_local = jacobian(model, evaluation) if tangents is None else tangents
    tests = model.data.tests
    inner = np.einsum("tmi,tmj->tij", by_local, by_local)
    inner[:, 1, 1] += model.amplitude_weight**2
    inner += 1e-12 * (1.0 + np.einsum("tii->t", inner))[:, None, None] * np.eye(inner.shape[-1])
    right = np.einsum("tmi,tm->ti", by_local, evaluation.residual)
    right[:, 1] += model.amplitude_weight * evaluation.prior[:tests]
    outer = np.einsum("tmk,tml->kl", by_parameter, by_parameter)
    gradient = np.einsum("tmk,tm->k", by_parameter, evaluation.residual)
    free = np.arange(model.size, len(gradient))
    outer[free, free] += model.prior_std**-2.0
    gradient[model.size :] += evaluation.prior[tests:] / model.prior_std
    return NormalEquations(inner, np.einsum("tmi,tmk->tik", by_local, by_parameter), right, outer, gradient)
