"""Normal equations in which nuisance parameters belong to one test each, solved by a Schur complement."""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from wedgesweep.diagnose.evaluation import Evaluation
from wedgesweep.diagnose.jacobian import Jacobian, jacobian
from wedgesweep.diagnose.model import Model

# Share of a diagonal element of a local block, plus one, that is added to it.
REGULAR = 1e-12


class Reduced(NamedTuple):
    """Normal equations of the parameters alone: matrix (k, k) and gradient (k,), or those of each test."""

    matrix: np.ndarray
    gradient: np.ndarray


@dataclass(frozen=True)
class NormalEquations:
    """Blocks of the normal equations: L nuisance parameters local to each test, k global parameters.

    ``local_block`` (T, L, L), ``coupling_block`` (T, L, k), ``global_block`` (T, k, k), ``local_gradient``
    (T, L), ``global_gradient`` (T, k): of each test; ``prior``: of the priors of parameters. The first
    ``eliminated`` nuisance parameters are never damped.
    """

    local_block: np.ndarray
    coupling_block: np.ndarray
    global_block: np.ndarray
    local_gradient: np.ndarray
    global_gradient: np.ndarray
    prior: Reduced
    eliminated: int

    def _eliminate(self, damping: float) -> tuple[np.ndarray, np.ndarray]:
        """Inverse of the damped local block times local gradient (T, L), and times coupling (T, L, k)."""
        block = self.local_block.copy()
        for i in range(self.eliminated, block.shape[-1]):
            block[:, i, i] *= 1.0 + damping
        right = np.concatenate([self.coupling_block, self.local_gradient[..., None]], axis=-1)
        solved = np.linalg.solve(block, right)
        return solved[..., -1], solved[..., :-1]

    def of_each_test(self, damping: float = 0.0) -> Reduced:
        """Normal equations of the parameters by each test, (T, k, k) and (T, k), without priors."""
        by_gradient, by_coupling = self._eliminate(damping)
        matrix = self.global_block - np.einsum("tik,til->tkl", self.coupling_block, by_coupling)
        return Reduced(
            matrix, self.global_gradient - np.einsum("tik,ti->tk", self.coupling_block, by_gradient)
        )

    @cached_property
    def of_all_tests(self) -> Reduced:
        """Blocks of the parameters alone, of all tests and priors."""
        both = zip((self.global_block, self.global_gradient), self.prior, strict=True)
        return Reduced(*(each.sum(axis=0) + prior for each, prior in both))

    def schur_complement(self, damping: float = 0.0) -> Reduced:
        """Normal equations of the parameters, nuisance parameters eliminated."""
        both = zip(self.of_each_test(damping), self.prior, strict=True)
        return Reduced(*(each.sum(axis=0) + prior for each, prior in both))

    def local_step(self, step: np.ndarray, damping: float) -> np.ndarray:
        """Best step of the nuisance parameters (T, L) beside a step of the parameters (k,)."""
        by_gradient, by_coupling = self._eliminate(damping)
        return -by_gradient - by_coupling @ step

    def predicted_reduction(self, step: np.ndarray, local: np.ndarray) -> float:
        """Reduction of chi-squared by a step if the responses are linear."""
        matrix, gradient = self.of_all_tests
        slope = gradient @ step + (self.local_gradient * local).sum()
        bend = step @ matrix @ step
        bend += np.einsum("ti,tij,tj->", local, self.local_block, local)
        bend += 2.0 * np.einsum("ti,tik,k->", local, self.coupling_block, step)
        return float(-2.0 * slope - bend)


def normal_equations(
    model: Model, evaluation: Evaluation, derivatives: Jacobian | None = None
) -> NormalEquations:
    """Normal equations at an evaluation, with its own Jacobian if none is given."""
    by_parameter, by_nuisance = jacobian(model, evaluation) if derivatives is None else derivatives
    eliminated, weight = model.data.eliminated, model.nuisance_weight
    local = np.einsum("tmi,tmj->tij", by_nuisance, by_nuisance)
    gradient = np.einsum("tmi,tm->ti", by_nuisance, evaluation.residual)
    for i in range(weight.shape[1]):
        local[:, eliminated + i, eliminated + i] += weight[:, i] ** 2
        gradient[:, eliminated + i] += weight[:, i] * evaluation.nuisance_prior[:, i]
    # A nuisance parameter without influence on a test leaves no singular block.
    own = np.einsum("tii->ti", local)
    own += REGULAR * (1.0 + own)
    global_block = np.einsum("tmk,tml->tkl", by_parameter, by_parameter)
    global_gradient = np.einsum("tmk,tm->tk", by_parameter, evaluation.residual)
    none, std = np.zeros(model.size), model.uncertain.std
    prior = Reduced(np.diag(np.r_[none, std**-2.0]), np.r_[none, evaluation.uncertain_prior / std])
    coupling = np.einsum("tmi,tmk->tik", by_nuisance, by_parameter)
    return NormalEquations(local, coupling, global_block, gradient, global_gradient, prior, eliminated)
