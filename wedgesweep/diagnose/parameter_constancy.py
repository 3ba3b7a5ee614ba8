"""Whether the numbers of an explanation are the same in all tests.

What is not the cause may imitate it in every test, but hardly by one number in all of them: then the misfit
that is left points the way in which the number would have to differ from test to test, long before it is too
large for noise as a whole. This is the Lagrange multiplier test (Breusch and Pagan, 1980) of constant
parameters (Nyblom, 1989).
"""

from typing import NamedTuple

import numpy as np
from scipy.special import chdtrc

from wedgesweep.diagnose.projector import Projector
from wedgesweep.diagnose.steady.model import Fit

# Of what a number does in the test that shows it best, less than this share says nothing of it.
FAINT = 1e-3


class Constancy(NamedTuple):
    """Probability that all numbers are constant, and the one that most seems not to be ("effect.key")."""

    p: float
    number: str | None


def parameter_constancy(fit: Fit) -> Constancy:
    """Constancy of the numbers of a fit's hypothesis, each tried alone; simulates once for each of them."""
    size = fit.model.size
    if not (size and fit.evaluation.found):
        return Constancy(1.0, None)
    project = Projector(fit)
    p = [_constant(project, project.by_parameter[..., i]) for i in range(size)]
    least = int(np.argmin(p))
    return Constancy(min(1.0, size * p[least]), fit.model.hypothesis.parameters[least].name)


def _constant(project: Projector, tangent: np.ndarray) -> float:
    """Probability of the misfit along changes of one number, a test at a time; ``tangent`` (T, m)."""
    alone = tangent[None] * np.eye(len(tangent))[..., None]
    ways = np.array([project(each) for each in alone])
    _, size, basis = np.linalg.svd(ways, full_matrices=False)
    basis = basis[size > FAINT * np.linalg.norm(tangent, axis=1).max()]
    return float(chdtrc(len(basis), ((basis @ project.misfit) ** 2).sum())) if len(basis) else 1.0
