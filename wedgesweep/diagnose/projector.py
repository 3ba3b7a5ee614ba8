"""Projection of a change of the responses onto what no fitted parameter can imitate."""

import numpy as np

from wedgesweep.diagnose.jacobian import accurate_jacobian
from wedgesweep.diagnose.model import Fit

# Singular value of the scaled derivatives below which a direction depends on the others.
DEPENDENT = 1e-9


class Projector:
    """Removes from a change of the residual everything that the parameters of a fit can take up.

    ``by_parameter`` (T, m, k + u): derivatives of the residual. ``misfit``: residuals and pulls on priors of
    the fit, projected, as one vector.
    """

    def __init__(self, fit: Fit) -> None:
        self._model = model = fit.model
        self.by_parameter, by_nuisance = accurate_jacobian(model, fit.evaluation)
        tests, observations, parameters = self.by_parameter.shape
        self._nuisances = by_nuisance.shape[-1]
        by_test = np.zeros((tests, observations, tests, self._nuisances))
        by_test[np.arange(tests), :, np.arange(tests)] = by_nuisance
        rows = tests * observations
        derivatives = np.concatenate(
            [by_test.reshape(rows, -1), self.by_parameter.reshape(rows, parameters)], axis=1
        )
        priors = self._over_all(model.nuisance_weight, 1.0 / model.uncertain.std)
        matrix = np.concatenate([derivatives, np.diag(priors)])
        matrix /= np.maximum(np.linalg.norm(matrix, axis=0), 1e-300)
        u, s, _ = np.linalg.svd(matrix, full_matrices=False)
        self._basis = u[:, s > DEPENDENT]
        evaluation = fit.evaluation
        pulls = self._over_all(evaluation.nuisance_prior, evaluation.uncertain_prior)
        self.misfit = self._project(evaluation.residual, pulls)

    def _over_all(self, nuisance: np.ndarray, uncertain: np.ndarray) -> np.ndarray:
        """One vector with a value for each column of derivatives.

        That of nuisance parameters with a prior (T, P) and of uncertain parameters (u,), 0 for all others.
        """
        eliminated = self._model.data.eliminated
        by_test = np.zeros((len(nuisance), self._nuisances))
        by_test[:, eliminated : eliminated + nuisance.shape[1]] = nuisance
        return np.r_[by_test.ravel(), np.zeros(self._model.size), uncertain]

    def _project(self, change: np.ndarray, priors: np.ndarray) -> np.ndarray:
        vector = np.r_[change.ravel(), priors]
        return vector - self._basis @ (self._basis.T @ vector)

    def __call__(self, change: np.ndarray) -> np.ndarray:
        """What remains of a change (T, m), as one vector."""
        return self._project(change, np.zeros(len(self._basis) - change.size))
