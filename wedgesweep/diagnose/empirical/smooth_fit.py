"""Least squares of a tabulated force with a penalty of its roughness, chosen by tests left out.

The force of node i is x_i. With the whitened residual r, nuisance parameters at their best,

    minimise  |r(x)|^2 + a |D_z x|^2 + b |D_v x|^2

where D_z and D_v are second differences over displacement and velocity (P-splines: Eilers and Marx, 1996);
springs and dampers have none.
The weights a and b are those at which groups of tests are predicted best by a fit to all others.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from wedgesweep.diagnose.empirical.hypothesis import EmpiricalHypothesis
from wedgesweep.diagnose.evaluation import Evaluation
from wedgesweep.diagnose.least_squares import CONVERGED_SHARE
from wedgesweep.diagnose.model import Fit, Model
from wedgesweep.diagnose.normal_equations import NormalEquations, normal_equations
from wedgesweep.effects.empirical_force import PLACES, SPEEDS, nodes

# Powers of ten of weights of roughness over what the tests know of a node on average: the first ones that are
# tried, from which those beside them are as long as these predict better, and the ends.
FIRST, ENDS = (-2, -2), (-7, 3)
# Added to the information of each node, over what the tests know of a node on average: no test knows a force
# that acts everywhere alike, as all sensors have an unknown zero.
RIDGE = 1e-9
# Gauss-Newton steps of a fit, and shares of a step that are tried.
ROUNDS, SHARES = 3, (1.0, 0.5, 0.2, 0.05)


@dataclass(frozen=True)
class SmoothFit:
    """Where a fit ended.

    ``information`` (T, k, k) and ``gradient`` (T, k): of each test, its nuisance parameters eliminated;
    ``prior`` (k, k): penalty and priors; ``pull`` (k,): their gradient.
    """

    model: Model
    evaluation: Evaluation
    information: np.ndarray
    gradient: np.ndarray
    prior: np.ndarray
    pull: np.ndarray
    equations: NormalEquations

    @property
    def hypothesis(self) -> EmpiricalHypothesis:
        assert isinstance(self.model.hypothesis, EmpiricalHypothesis)
        return self.model.hypothesis

    @property
    def x(self) -> np.ndarray:
        return self.evaluation.point.x

    @property
    def as_fit(self) -> Fit:
        """The same in the form of other fits."""
        return Fit(self.model, self.evaluation, self.covariance, True)

    @property
    def covariance(self) -> np.ndarray:
        """Covariance (k, k) of the parameters; larger where the fit leaves more than its weights expect."""
        left = self.evaluation.chi2 / max(float(self.model.data.dof.sum()) - self.freedom, 1.0)
        return max(left, 1.0) * np.linalg.inv(self.information.sum(axis=0) + self.prior)

    @property
    def freedom(self) -> float:
        """Effective number of fitted parameters (degrees of freedom of the smoother)."""
        total = self.information.sum(axis=0)
        return float(np.trace(np.linalg.solve(total + self.prior, total)))

    def without(self, tests: np.ndarray) -> np.ndarray:
        """Parameters (k,) of a fit to all other tests, if their responses are linear nearby."""
        rest = np.setdiff1d(np.arange(len(self.gradient)), tests)
        return _stepped(self, rest, self.prior, self.pull, 1.0)


def fit(model: Model, start: Evaluation, groups: Sequence[np.ndarray]) -> SmoothFit:
    """Fit from an evaluation; ``groups``: tests that are left out together to choose the weights."""
    here = _around(model, start, groups)
    for _ in range(ROUNDS):
        better = _better(here)
        if better is None:
            break
        gained = _objective(here, here.evaluation) - _objective(here, better)
        here = _around(model, better, groups)
        if gained < CONVERGED_SHARE * here.evaluation.chi2:
            break
    return here


def _around(model: Model, evaluation: Evaluation, groups: Sequence[np.ndarray]) -> SmoothFit:
    """Everything about an evaluation that steps need, with the best weights of roughness."""
    equations = normal_equations(model, evaluation)
    plain = SmoothFit(model, evaluation, *equations.of_each_test(), *equations.prior, equations)
    return _with_best_roughness(plain, groups)


def _with_best_roughness(plain: SmoothFit, groups: Sequence[np.ndarray]) -> SmoothFit:
    """The fit with the weights of roughness at which tests that are left out are predicted best."""
    tried: dict[tuple[int, int], float] = {}
    best, beside = FIRST, [FIRST]
    while beside:
        for powers in beside:
            tried[powers] = _predicted_misfit(_with_roughness(plain, powers), groups)
        best = min(tried, key=lambda powers: tried[powers])
        steps = ((1, 0), (-1, 0), (0, 1), (0, -1))
        around = [(best[0] + one, best[1] + other) for one, other in steps]
        beside = [
            each for each in around if each not in tried and ENDS[0] <= min(each) and max(each) <= ENDS[1]
        ]
    return _with_roughness(plain, best)


def _with_roughness(plain: SmoothFit, powers: tuple[int, int]) -> SmoothFit:
    """A fit with a penalty of roughness over displacement and over velocity, weights as powers of ten."""
    own = plain.hypothesis.nodes
    known = np.trace(plain.information.sum(axis=0)[own, own]) / (PLACES * SPEEDS)
    places, speeds = nodes(1.0, 1.0)
    over_place = np.kron(_second_differences(places), np.eye(SPEEDS))
    over_speed = np.kron(np.eye(PLACES), _second_differences(speeds))
    penalty = (
        10.0 ** powers[0] * over_place + 10.0 ** powers[1] * over_speed + RIDGE * np.eye(PLACES * SPEEDS)
    )
    prior, pull = plain.prior.copy(), plain.pull.copy()
    prior[own, own] += known * penalty
    pull[own] += known * penalty @ plain.x[own]
    return replace(plain, prior=prior, pull=pull)


def _second_differences(nodes: np.ndarray) -> np.ndarray:
    """Matrix (n, n) of the squared sum of second differences; 0 for what is linear between uneven nodes."""
    slopes = np.diff(np.eye(nodes.size), axis=0) / np.diff(nodes)[:, None]
    before, after = np.diff(nodes)[:-1], np.diff(nodes)[1:]
    rows = (2.0 * before * after / (before + after))[:, None] * np.diff(slopes, axis=0)
    return rows.T @ rows


def _predicted_misfit(here: SmoothFit, groups: Sequence[np.ndarray]) -> float:
    """Squared misfit of all tests when left out, less a constant, if responses are linear."""
    found = 0.0
    for tests in groups:
        step = here.without(tests) - here.x
        information, gradient = here.information[tests].sum(axis=0), here.gradient[tests].sum(axis=0)
        found += 2.0 * gradient @ step + step @ information @ step
    return found


def _stepped(
    here: SmoothFit, tests: np.ndarray, prior: np.ndarray, pull: np.ndarray, share: float
) -> np.ndarray:
    """Parameters (k,) after a share of the Gauss-Newton step of some tests; bounds hold."""
    matrix = here.information[tests].sum(axis=0) + prior
    gradient = here.gradient[tests].sum(axis=0) + pull
    model, x = here.model, here.x
    step = -np.linalg.solve(matrix, gradient)
    beyond = (x + step < model.low) | (x + step > model.high)
    if beyond.any():
        step[beyond] = np.clip(step, model.low - x, model.high - x)[beyond]
        free = ~beyond
        right = gradient[free] + matrix[np.ix_(free, beyond)] @ step[beyond]
        step[free] = -np.linalg.solve(matrix[np.ix_(free, free)], right)
    return np.clip(x + share * step, model.low, model.high)


def _objective(here: SmoothFit, there: Evaluation) -> float:
    """Chi-squared and penalty."""
    own = here.hypothesis.nodes
    x = there.point.x[own]
    return float(there.chi2 + x @ here.prior[own, own] @ x)


def _better(here: SmoothFit) -> Evaluation | None:
    """An evaluation that fits better, by a step or a part of it; None if there is none."""
    model, now = here.model, _objective(here, here.evaluation)
    equations = here.equations
    limits = [each.max_step for each in model.data.nuisances(model.effects)]
    for share in SHARES:
        step = _stepped(here, np.arange(len(here.gradient)), here.prior, here.pull, share) - here.x
        local = share * equations.local_step(step / share, 0.0)[:, equations.eliminated :]
        local = np.clip(local, np.negative(limits), limits)
        tried = model.evaluate(here.evaluation.point.moved(step, local))
        if tried.found and _objective(here, tried) < now:
            return tried
    return None
