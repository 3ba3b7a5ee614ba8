"""Whether the parameters of an explanation are the same in all tests.

A wrong cause may imitate the right one in every single test, but hardly with one value in all of them. The
residual then points in the direction in which the value would have to differ from test to test, long before
chi-squared as a whole shows it. This is the Lagrange multiplier test (Breusch and Pagan, 1980) of constant
parameters (Nyblom, 1989).
"""

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.linalg import orth
from scipy.special import chdtrc

from wedgesweep.diagnose.jacobian import accurate_jacobian

if TYPE_CHECKING:
    from wedgesweep.diagnose.model import Fit


class Projector:
    """Removes from a change of the residual everything that the parameters of a fit can take up.

    ``by_parameter`` (T, m, k + u): derivatives of the residual. ``misfit``: residuals and pulls on priors of
    the fit, projected, as one vector.
    """

    def __init__(self, fit: "Fit") -> None:
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
        self._basis = orth(matrix / np.maximum(np.linalg.norm(matrix, axis=0), 1e-300))
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


# Directions in which a parameter shows less than this share of what it does in its best test are left out.
FAINT = 1e-3


class Constancy(NamedTuple):
    """P-value of the test that all parameters are constant, and the least constant one ("effect.key")."""

    p: float
    parameter: str | None


def parameter_constancy(fit: "Fit") -> Constancy:
    """Test the parameters of a fit's hypothesis one by one, with a Bonferroni correction."""
    size = fit.model.size
    if not (size and fit.evaluation.found):
        return Constancy(1.0, None)
    project = Projector(fit)
    # A model error has one shape in each test, which may be that of a change of the parameter.
    variance = 1.0 + float(fit.model.data.model_misfit.mean())
    p = [_p_constant(project, project.by_parameter[..., i], variance) for i in range(size)]
    least = int(np.argmin(p))
    return Constancy(min(1.0, size * p[least]), fit.model.hypothesis.parameters[least].name)


def _p_constant(project: Projector, derivative: np.ndarray, variance: float = 1.0) -> float:
    """P-value of the misfit along changes of one parameter in single tests.

    ``derivative`` (T, m): of the residual by the parameter; ``variance``: of the misfit in any direction.
    """
    alone = derivative[None] * np.eye(len(derivative))[..., None]
    directions = np.array([project(each) for each in alone])
    _, size, basis = np.linalg.svd(directions, full_matrices=False)
    basis = basis[size > FAINT * np.linalg.norm(derivative, axis=1).max()]
    along = ((basis @ project.misfit) ** 2).sum() / variance
    return float(chdtrc(len(basis), along)) if len(basis) else 1.0
