"""Weighted least squares by Levenberg and Marquardt, with bounds on parameters and limits on steps."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from wedgesweep.diagnose.evaluation import Evaluation, Point
from wedgesweep.diagnose.jacobian import conservative_jacobian, jacobian
from wedgesweep.diagnose.model import TIGHT, Fit, Model
from wedgesweep.diagnose.normal_equations import NormalEquations, normal_equations

# Iterations of a fit, and of one that begins near its minimum.
ITERATIONS, BRIEF = 25, 8
# A fit has converged when the next step is predicted to reduce chi-squared by less than this, or by less than
# this share of its excess: far from the data the last digit is of no use.
CONVERGED, CONVERGED_SHARE = 0.02, 1e-3
# Shares of free motions to which a fit from far off is made before it is made to all of them.
BEGINNINGS = (0.25, 0.5)
# Damping of the first step, the least damping, that at which a fit gives up, and the factor by which damping
# rises after a step that failed and falls after one that did not.
DAMPING, LEAST_DAMPING, MOST_DAMPING, FACTOR = 1e-3, 1e-9, 1e8, 8.0
# Eigenvalue of the scaled normal equations below which a combination of parameters is undetermined.
UNDETERMINED = 1e-12
# Largest step of one iteration, in scales of the parameters.
MAX_STEP = 3.0


class Step(NamedTuple):
    """A proposed point, the predicted reduction of chi-squared, and whether a limit cut the step short."""

    point: Point
    predicted: float
    limited: bool


def minimise(model: Model, start: Evaluation, iterations: int = ITERATIONS) -> Fit:
    """Fit from an evaluation: descend to a nearby minimum of chi-squared within the bounds."""
    evaluation, damping, converged = start, DAMPING, False
    matrix, derivatives = np.zeros((len(model.low), len(model.low))), None
    for _ in range(iterations):
        if not evaluation.found:
            break
        derivatives = jacobian(model, evaluation, near=derivatives)
        equations = normal_equations(model, evaluation, derivatives)
        matrix = equations.schur_complement().matrix
        better, predicted = None, np.inf
        negligible = max(CONVERGED, CONVERGED_SHARE * (evaluation.chi2 - model.dof))
        while better is None and damping < MOST_DAMPING:
            step = lm_step(model, evaluation.point, equations, damping)
            predicted = step.predicted
            # A step that a limit cut short may gain nothing where a more damped one still does.
            if predicted < negligible and not step.limited:
                break
            tried = model.evaluate(step.point) if predicted >= negligible else evaluation
            if tried.chi2 < evaluation.chi2:
                better = tried
            else:
                damping *= FACTOR
        if better is None:
            converged = predicted < negligible
            break
        gained = evaluation.chi2 - better.chi2
        damping = max(damping / (FACTOR if gained > 0.5 * predicted else 1.0), LEAST_DAMPING)
        evaluation = better
    return Fit(model, evaluation, _covariance(matrix), converged)


def of_beginnings(model: Model, share: float = BEGINNINGS[0]) -> Model:
    """The model on the beginnings of the tests, at which a fit from far off starts.

    Over a long free motion errors of phase add up, and a mass may come to rest a swing too early or too late.
    So chi-squared has more minima than over a short one (Ribeiro and others, 2020, Automatica 121, 109158).
    """
    data = model.data.beginning(share)
    return model if data is model.data else model.on(data)


def grown(model: Model, fit: Fit) -> Fit:
    """A fit to the beginnings of the tests, continued on longer and longer parts, up to those of a model."""
    if fit.model.data is model.data:
        return fit
    for share in BEGINNINGS[1:]:
        longer = of_beginnings(model, share)
        fit = minimise(longer, longer.evaluate(fit.point))
    return minimise(model, model.evaluate(fit.point))


def fit_from(model: Model, point: Point) -> Fit:
    """Fit from a point far off, to the beginnings of the tests first."""
    begun = of_beginnings(model)
    return grown(model, minimise(begun, begun.evaluate(point)))


def lm_step(model: Model, point: Point, equations: NormalEquations, damping: float) -> Step:
    """The damped Gauss-Newton step from a point, within the bounds of parameters and the limits of steps."""
    x = point.x
    step = _parameter_step(model, x, equations, damping)
    aim = np.clip(x + step, model.low, model.high)
    limited = bool((aim != x + step).any())
    step = aim - x
    local = equations.local_step(step, damping)
    fitted = [each.max_step for each in model.data.nuisances(model.effects)]
    longest_local = np.r_[[np.inf] * equations.eliminated, fitted]
    limited = limited or bool((np.abs(local) > longest_local).any())
    local = np.clip(local, -longest_local, longest_local)
    predicted = equations.predicted_reduction(step, local)
    return Step(point.moved(step, local[:, equations.eliminated :]), predicted, limited)


def _parameter_step(model: Model, x: np.ndarray, equations: NormalEquations, damping: float) -> np.ndarray:
    """Step (k + u,) of the parameters from x, no longer than MAX_STEP; it may lead over a bound.

    A parameter at a bound beyond which chi-squared falls stays there.
    """
    matrix, gradient = equations.schur_complement(damping)
    free = ~(((x <= model.low) & (gradient > 0.0)) | ((x >= model.high) & (gradient < 0.0)))
    longest = MAX_STEP * model.scale
    step = _damped_solution(matrix, gradient, damping, free)
    step /= max(np.max(np.abs(step) / longest, initial=0.0), 1.0)
    return step


def _damped_solution(
    matrix: np.ndarray, gradient: np.ndarray, damping: float, free: np.ndarray
) -> np.ndarray:
    """Step (k,) of the parameters that are ``free`` (k,) towards the minimum of the quadratic model."""
    step = np.zeros(len(gradient))
    if free.any():
        block = matrix[np.ix_(free, free)]
        scale = np.diag(np.diag(block) + 1e-12 * (1.0 + np.trace(block)))
        step[free] = -np.linalg.solve(block + damping * scale, gradient[free])
    return step


def tight_refit(fit: Fit) -> Fit:
    """The fit continued at a tolerance whose error is no longer mistaken for information."""
    model = Model(fit.model.data, fit.model.hypothesis, TIGHT)
    found = minimise(model, model.evaluate(fit.point))
    if not found.evaluation.found:
        return fit
    derivatives = conservative_jacobian(model, found.evaluation)
    equations = normal_equations(model, found.evaluation, derivatives)
    return replace(found, covariance=_covariance(equations.schur_complement().matrix))


def subset_fit(fit: Fit, rows: np.ndarray) -> Fit:
    """The same point on some of a fit's tests."""
    model = Model(fit.model.data.subset(rows), fit.model.hypothesis)
    return Fit(model, model.evaluate(fit.point.subset(rows)), fit.covariance, fit.converged)


def _covariance(matrix: np.ndarray) -> np.ndarray:
    """Inverse of the matrix of normal equations; undetermined combinations are wide, not exact."""
    size = np.sqrt(np.diag(matrix))
    size = np.where(size > 0.0, size, 1.0)
    values, vectors = np.linalg.eigh(matrix / np.outer(size, size))
    inverse = vectors / np.maximum(values, UNDETERMINED) @ vectors.T
    return inverse / np.outer(size, size)
