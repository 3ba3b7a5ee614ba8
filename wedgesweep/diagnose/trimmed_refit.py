"""Refit without the tests that keep a fit from its minimum.

Three kinds of test do so. Near breakaway the misfit of a test rises steeply to one side. Where the bolster
sticks in the simulation, the misfit does not react to small steps. And a test with several stable responses
may be on the wrong one, as a fit follows that of its neighbour while a rig starts at rest. Such tests are
left out until the others have settled the parameters, and then taken back in.
"""

from dataclasses import replace

import numpy as np

from wedgesweep.diagnose.evaluation import Point
from wedgesweep.diagnose.least_squares import lm_step, minimise, subset_fit
from wedgesweep.diagnose.model import Fit, Model
from wedgesweep.diagnose.normal_equations import normal_equations

# Two responses differ if their squared misfits differ by more than this share plus this amount.
DIFFERENT = 0.05, 1.0
# Damping that keeps a step finite where the tests leave a parameter undetermined.
LEAST_DAMPING = 1e-6
# A test is influential if its squared misfit would grow by this factor.
WORSE = 2.0
# Nuisance parameters tried for tests that are taken back in, in standard deviations from stated.
WITHIN = np.arange(-3.0, 4.0)
# Share of all tests that may be left out.
MOST_LEFT_OUT = 1.0 / 3.0


def refit_without_influential_tests(fit: Fit) -> Fit:
    """The fit, or a better one of all tests that starts where a fit without influential tests ends."""
    model, point = fit.model, fit.point
    if model.data.needs_alignment(fit.effects) or not fit.evaluation.found:
        return fit
    left_out = _other_response_from_rest(fit) | _influential(fit) | model.data.insensitive(fit.evaluation)
    if not 0 < left_out.sum() <= MOST_LEFT_OUT * left_out.size:
        return fit
    rows = np.flatnonzero(~left_out)
    kept = subset_fit(fit, rows)
    trimmed = minimise(kept.model, kept.evaluation).point
    stated, priors = model.data.as_stated(point), model.nuisance_weight.shape[1]
    nuisance = stated.nuisance
    nuisance[rows, :priors] = trimmed.nuisance[:, :priors]
    start = Point(trimmed.x, nuisance, point.warm.where(left_out, stated.warm))
    again = minimise(model, model.evaluate(_at_best_nuisances(model, start, left_out)))
    return min(fit, again, key=lambda each: each.chi2)


def _at_best_nuisances(model: Model, start: Point, chosen: np.ndarray) -> Point:
    """The point with nuisance parameters of some tests (T,) where they fit best.

    Those with a prior are looked for within it: from too large an input a step down can end where the bolster
    sticks. Those without stay where they are.
    """
    std = model.data.nuisance_std
    priors = std.shape[1]
    off = np.multiply.outer(WITHIN, np.where(np.isfinite(std), std, 0.0))
    tried = np.repeat(start.nuisance[None], len(WITHIN), axis=0)
    tried[..., :priors] += np.where(chosen[:, None], off, 0.0)
    return replace(start, nuisance=model.best_nuisances([replace(start, nuisance=each) for each in tried]))


def _other_response_from_rest(fit: Fit) -> np.ndarray:
    """Whether (T,) a test has another response if it starts at rest."""
    _, at_rest = fit.model.data.start()
    rest = fit.model.evaluate(replace(fit.point, warm=at_rest))
    return rest.found_tests & ~np.isclose(rest.chi2_by_test, fit.evaluation.chi2_by_test, *DIFFERENT)


def _influential(fit: Fit) -> np.ndarray:
    """Whether (T,) a test gets much worse by the step that is best for all if responses are linear."""
    equations = normal_equations(fit.model, fit.evaluation)
    tried = fit.model.evaluate(lm_step(fit.model, fit.point, equations, LEAST_DAMPING).point)
    return ~tried.found_tests | (tried.chi2_by_test > WORSE * fit.evaluation.chi2_by_test)
