"""What the nuisances of a fit cannot imitate."""

import numpy as np

from wedgesweep.diagnose.jacobian import jacobian
from wedgesweep.diagnose.steady.model import Evaluation, Fit

# Singular value of the scaled tangents below which a direction is one of the others.
SINGULAR = 1e-9


class Projector:
    """Takes out of a change of the responses what everything that is fitted can take up.

    ``by_parameter`` (T, m, k + u): derivatives of the residual by the numbers; ``misfit``: what a fit leaves
    of the data and of its priors, as one vector.
    """

    def __init__(self, fit: Fit) -> None:
        self._model = fit.model
        self.by_parameter, by_local = jacobian(fit.model, fit.evaluation)
        tests, points, numbers = self.by_parameter.shape
        local = np.zeros((tests, points, tests, by_local.shape[-1]))
        local[np.arange(tests), :, np.arange(tests)] = by_local
        tangents = np.concatenate(
            [local.reshape(tests * points, -1), self.by_parameter.reshape(tests * points, numbers)], axis=1
        )
        self._locals = by_local.shape[-1]
        stiff = self._over_all(fit.model.amplitude_weight, 1.0 / fit.model.prior_std)
        matrix = np.concatenate([tangents, np.diag(stiff)])
        matrix /= np.maximum(np.linalg.norm(matrix, axis=0), 1e-300)
        u, s, _ = np.linalg.svd(matrix, full_matrices=False)
        self._basis = u[:, s > SINGULAR]
        self.misfit = self._left(fit.evaluation.residual, self._priors(fit.evaluation))

    def _over_all(self, amplitudes: np.ndarray, uncertain: np.ndarray) -> np.ndarray:
        """A value for each that is fitted: of amplitudes (T,) and uncertain numbers (u,), else 0."""
        by_local = np.zeros((amplitudes.size, self._locals))
        by_local[:, 1] = amplitudes
        return np.r_[by_local.ravel(), np.zeros(self._model.size), uncertain]

    def _priors(self, evaluation: Evaluation) -> np.ndarray:
        tests = len(evaluation.residual)
        return self._over_all(evaluation.prior[:tests], evaluation.prior[tests:])

    def _left(self, change: np.ndarray, priors: np.ndarray) -> np.ndarray:
        vector = np.r_[change.ravel(), priors]
        return vector - self._basis @ (self._basis.T @ vector)

    def __call__(self, change: np.ndarray) -> np.ndarray:
        """What is left of a change (T, m), as one vector."""
        return self._left(change, np.zeros(len(self._basis) - change.size))
