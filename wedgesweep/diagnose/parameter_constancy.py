"""Whether the parameters of an explanation are the same in all tests.

A wrong cause may imitate the right one in every single test, but hardly with one value in all of them. The
residual then points in the direction in which the value would have to differ from test to test, long before
chi-squared as a whole shows it. This is the Lagrange multiplier test (Breusch and Pagan, 1980) of constant
parameters (Nyblom, 1989).
"""

from typing import NamedTuple

import numpy as np
from scipy.special import chdtrc

from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.projector import Projector

# Directions in which a parameter shows less than this share of what it does in its best test are left out.
FAINT = 1e-3


class Constancy(NamedTuple):
    """P-value of the test that all parameters are constant, and the least constant one ("effect.key")."""

    p: float
    parameter: str | None


def parameter_constancy(fit: Fit) -> Constancy:
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
