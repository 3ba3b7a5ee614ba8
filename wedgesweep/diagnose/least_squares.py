"""Weighted least squares of a hypothesis and all that is unknown beside it (Levenberg and Marquardt).

Amplitudes are local to a test, so that each step solves for them test by test.
"""

from dataclasses import replace

import numpy as np

from wedgesweep.diagnose.jacobian import conservative_jacobian
from wedgesweep.diagnose.normal_equations import NormalEquations, normal_equations
from wedgesweep.diagnose.steady import simulation
from wedgesweep.diagnose.steady.model import Evaluation, Fit, Model, Point

ITERATIONS = 25
# A fit has arrived when a step promises less than this of Q, or this share of what Q has above noise: far
# from the data the last digit is of no use.
CONVERGED, CONVERGED_SHARE = 0.02, 1e-3
# Damping of a step at the start, and at which it has failed.
DAMPING, MOST_DAMPING = 1e-3, 1e8
# Eigenvalue of scaled normal equations below which they leave a combination of numbers open.
SINGULAR = 1e-12
# Largest step of one iteration, in widths of the coordinates.
MAX_STEP = 3.0
# Largest relative step of an input amplitude.
MAX_AMPLITUDE_STEP = 0.1
# And of the phase of a foreign vibration (rad).
MAX_TONE_PHASE_STEP = 0.3


def refine(model: Model, start: Evaluation, iterations: int = ITERATIONS) -> Fit:
    """Follow a trial to the nearest minimum of Q within the bounds."""
    evaluation, damping, converged = start, DAMPING, False
    matrix = np.zeros((len(model.low), len(model.low)))
    for _ in range(iterations):
        if not evaluation.found:
            break
        equations = normal_equations(model, evaluation)
        matrix, _ = equations.schur_complement()
        better, predicted = None, np.inf
        little = max(CONVERGED, CONVERGED_SHARE * (evaluation.chi2 - model.dof))
        while better is None and damping < MOST_DAMPING:
            step, predicted, limited = lm_step(model, evaluation.point, equations, damping)
            # A step cut short at a limit may promise nothing; a more damped one still may.
            if predicted < little and not limited:
                break
            better = _better(model, evaluation, step) if predicted >= little else None
            if better is None:
                damping *= 8.0
        if better is None:
            converged = predicted < little
            break
        gained = evaluation.chi2 - better.chi2
        evaluation, damping = better, max(damping / (8.0 if gained > 0.5 * predicted else 1.0), 1e-9)
    return Fit(model, evaluation, _covariance(matrix), converged)


def _better(model: Model, evaluation: Evaluation, step: Point) -> Evaluation | None:
    tried = model.evaluate(step)
    return tried if tried.chi2 < evaluation.chi2 else None


def tight_refit(fit: Fit) -> Fit:
    """A fit followed on with responses so exact that their error cannot pass for information."""
    model = Model(fit.model.data, fit.model.hypothesis, fit.model.reference, simulation.TIGHT)
    found = refine(model, model.evaluate(fit.evaluation.point))
    if not found.evaluation.found:
        return fit
    matrix, _ = normal_equations(
        model, found.evaluation, conservative_jacobian(model, found.evaluation)
    ).schur_complement()
    return replace(found, covariance=_covariance(matrix))


def subset_fit(fit: Fit, rows: np.ndarray) -> Fit:
    """The same point on some of a fit's tests."""
    model = Model(fit.model.data.subset(rows), fit.model.hypothesis, fit.model.reference[rows])
    point = fit.evaluation.point
    evaluation = model.evaluate(
        Point(point.x, point.amplitude[rows], point.tone_phase[rows], point.warm.of(rows))
    )
    return Fit(model, evaluation, fit.covariance, fit.converged)


def lm_step(
    model: Model, point: Point, equations: NormalEquations, damping: float
) -> tuple[Point, float, bool]:
    """The point after a damped step, what it promises to take off Q, and whether a limit cut it short."""
    x = point.x
    matrix, gradient = equations.schur_complement(damping)
    free = ~(((x <= model.low) & (gradient > 0.0)) | ((x >= model.high) & (gradient < 0.0)))
    step = np.zeros(len(x))
    if free.any():
        inner = matrix[np.ix_(free, free)]
        scale = np.diag(np.diag(inner) + 1e-12 * (1.0 + np.trace(inner)))
        step[free] = -np.linalg.solve(inner + damping * scale, gradient[free])
    longest = np.max(np.abs(step) / model.scale, initial=0.0)
    if longest > MAX_STEP:
        step *= MAX_STEP / longest
    aim = np.clip(x + step, model.low, model.high)
    limited = bool((aim != x + step).any())
    within = aim - x
    local = equations.local_step(within, damping)
    max_local_step = np.array([np.inf, MAX_AMPLITUDE_STEP, MAX_TONE_PHASE_STEP])[: local.shape[1]]
    limited = limited or bool((np.abs(local) > max_local_step).any())
    local = np.clip(local, -max_local_step, max_local_step)
    predicted = equations.predicted_reduction(within, local)
    return point.moved(within, local[:, 1:]), predicted, limited


def _covariance(matrix: np.ndarray) -> np.ndarray:
    """Inverse of the matrix of normal equations; what they say nothing of is wide, not exact."""
    size = np.sqrt(np.diag(matrix))
    size = np.where(size > 0.0, size, 1.0)
    values, vectors = np.linalg.eigh(matrix / np.outer(size, size))
    inverse = vectors / np.maximum(values, SINGULAR) @ vectors.T
    return inverse / np.outer(size, size)
