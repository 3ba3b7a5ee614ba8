"""Weighted least squares of a hypothesis and all that is unknown beside it (Levenberg and Marquardt).

Amplitudes are local to a test, so that each step solves for them test by test.
"""

from dataclasses import replace

import numpy as np

from wedgesweep.diagnose import simulation
from wedgesweep.diagnose.equations import Equations, equations_of
from wedgesweep.diagnose.model import Fit, Model, Point, Trial
from wedgesweep.diagnose.tangents import cautious

ITERATIONS = 25
# A fit has arrived when a step promises less than this of Q, or this share of what Q has above noise: far
# from the data the last digit is of no use.
ARRIVED, ARRIVED_SHARE = 0.02, 1e-3
# Damping of a step at the start, and at which it has failed.
DAMPING, STUCK = 1e-3, 1e8
# Eigenvalue of scaled normal equations below which they leave a combination of numbers open.
OPEN = 1e-12
# Largest step of one iteration, in widths of the coordinates.
LONGEST_STEP = 3.0
# Largest relative step of an input amplitude.
LONGEST_AMPLITUDE = 0.1
# And of the phase of a foreign vibration (rad).
LONGEST_AHEAD = 0.3


def refine(model: Model, start: Trial, iterations: int = ITERATIONS) -> Fit:
    """Follow a trial to the nearest minimum of Q within the bounds."""
    trial, damping, arrived = start, DAMPING, False
    matrix = np.zeros((len(model.low), len(model.low)))
    for _ in range(iterations):
        if not trial.found:
            break
        equations = equations_of(model, trial)
        matrix, _ = equations.reduced()
        better, promised = None, np.inf
        little = max(ARRIVED, ARRIVED_SHARE * (trial.q - model.dof))
        while better is None and damping < STUCK:
            step, promised, limited = damped(model, trial.point, equations, damping)
            # A step cut short at a limit may promise nothing; a more damped one still may.
            if promised < little and not limited:
                break
            better = _better(model, trial, step) if promised >= little else None
            if better is None:
                damping *= 8.0
        if better is None:
            arrived = promised < little
            break
        gained = trial.q - better.q
        trial, damping = better, max(damping / (8.0 if gained > 0.5 * promised else 1.0), 1e-9)
    return Fit(model, trial, _covariance(matrix), arrived)


def _better(model: Model, trial: Trial, step: Point) -> Trial | None:
    tried = model.trial(step)
    return tried if tried.q < trial.q else None


def exact(fit: Fit) -> Fit:
    """A fit followed on with responses so exact that their error cannot pass for information."""
    model = Model(fit.model.problem, fit.model.hypothesis, fit.model.reference, simulation.TIGHT)
    found = refine(model, model.trial(fit.trial.point))
    if not found.trial.found:
        return fit
    matrix, _ = equations_of(model, found.trial, cautious(model, found.trial)).reduced()
    return replace(found, covariance=_covariance(matrix))


def restrict(fit: Fit, rows: np.ndarray) -> Fit:
    """The same point on some of a fit's tests."""
    model = Model(fit.model.problem.subset(rows), fit.model.hypothesis, fit.model.reference[rows])
    point = fit.trial.point
    trial = model.trial(Point(point.x, point.amplitude[rows], point.ahead[rows], point.warm.of(rows)))
    return Fit(model, trial, fit.covariance, fit.arrived)


def damped(model: Model, point: Point, equations: Equations, damping: float) -> tuple[Point, float, bool]:
    """The point after a damped step, what it promises to take off Q, and whether a limit cut it short."""
    x = point.x
    matrix, gradient = equations.reduced(damping)
    free = ~(((x <= model.low) & (gradient > 0.0)) | ((x >= model.high) & (gradient < 0.0)))
    step = np.zeros(len(x))
    if free.any():
        inner = matrix[np.ix_(free, free)]
        scale = np.diag(np.diag(inner) + 1e-12 * (1.0 + np.trace(inner)))
        step[free] = -np.linalg.solve(inner + damping * scale, gradient[free])
    longest = np.max(np.abs(step) / model.width, initial=0.0)
    if longest > LONGEST_STEP:
        step *= LONGEST_STEP / longest
    aim = np.clip(x + step, model.low, model.high)
    limited = bool((aim != x + step).any())
    within = aim - x
    local = equations.local(within, damping)
    longest_local = np.array([np.inf, LONGEST_AMPLITUDE, LONGEST_AHEAD])[: local.shape[1]]
    limited = limited or bool((np.abs(local) > longest_local).any())
    local = np.clip(local, -longest_local, longest_local)
    promised = equations.promise(within, local)
    return point.moved(within, local[:, 1:]), promised, limited


def _covariance(matrix: np.ndarray) -> np.ndarray:
    """Inverse of the matrix of normal equations; what they say nothing of is wide, not exact."""
    size = np.sqrt(np.diag(matrix))
    size = np.where(size > 0.0, size, 1.0)
    values, vectors = np.linalg.eigh(matrix / np.outer(size, size))
    inverse = vectors / np.maximum(values, OPEN) @ vectors.T
    return inverse / np.outer(size, size)
