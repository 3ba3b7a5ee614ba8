"""A way around tests that keep a fit from going on.

The misfit of a test next to breakaway rises steeply to one side; where the bolster sticks it does not change
at all; and a test that has several stable responses may be on the wrong one: a fit goes on with that of its
neighbour, a rig starts at rest. Such tests are left out until the others have said where to look.
"""

from dataclasses import replace

import numpy as np

from wedgesweep.diagnose.least_squares import lm_step, refine, subset_fit
from wedgesweep.diagnose.normal_equations import normal_equations
from wedgesweep.diagnose.steady.model import Fit, Model, Point, best_evaluation_per_test
from wedgesweep.solvers.periodic import at_rest

# A response is another one if its squared misfit differs by more than this (share, and beside it).
OTHERWISE = 0.05, 1.0
# Damping that keeps a step finite where the tests leave a number open.
LEAST_DAMPING = 1e-6
# A test is in the way if its squared misfit grows by this factor.
WORSE = 2.0
# Inputs that are tried for tests that were left out, in standard deviations beside the stated ones.
WITHIN = np.arange(-3.0, 4.0)
# Tests that may be left out, as a share of all.
MOST = 1.0 / 3.0


def refit_without_influential_tests(fit: Fit) -> Fit:
    """The fit, or a better one that was found without the tests that held it up."""
    if fit.model.has_tone or not fit.evaluation.found:
        return fit
    left_out = _elsewhere_from_rest(fit) | _influential(fit) | fit.model.sticks(fit.evaluation)
    if not 0 < left_out.sum() <= MOST * left_out.size:
        return fit
    rows = np.flatnonzero(~left_out)
    few = subset_fit(fit, rows)
    point = refine(few.model, few.evaluation).evaluation.point
    amplitude = np.zeros(left_out.size)
    amplitude[rows] = point.amplitude
    warm = fit.evaluation.point.warm.where(left_out, at_rest(left_out.size))
    start = replace(fit.evaluation.point, x=point.x, amplitude=amplitude, warm=warm)
    again = refine(fit.model, fit.model.evaluate(_at_best_inputs(fit.model, start, left_out)))
    return min(fit, again, key=lambda each: each.chi2)


def _at_best_inputs(model: Model, start: Point, chosen: np.ndarray) -> Point:
    """The point with the inputs of some tests (T,) where they leave least, within what may be.

    From too much input a step down can end where the bolster sticks.
    """
    std = model.data.amplitude_std
    off = np.multiply.outer(WITHIN, np.where(np.isfinite(std), std, 0.0))
    tried = np.where(chosen, off, start.amplitude)
    evaluations = model.evaluate_all([replace(start, amplitude=amplitude) for amplitude in tried])
    return replace(start, amplitude=tried[best_evaluation_per_test(evaluations), np.arange(std.size)])


def _elsewhere_from_rest(fit: Fit) -> np.ndarray:
    """Whether (T,) a test has another response from rest."""
    point = replace(fit.evaluation.point, warm=at_rest(fit.model.data.tests))
    rest = fit.model.evaluate(point)
    return rest.found_tests & ~np.isclose(rest.chi2_by_test, fit.evaluation.chi2_by_test, *OTHERWISE)


def _influential(fit: Fit) -> np.ndarray:
    """Whether (T,) a test gets much worse by the step that is best for all if responses are linear."""
    step, _, _ = lm_step(
        fit.model, fit.evaluation.point, normal_equations(fit.model, fit.evaluation), LEAST_DAMPING
    )
    tried = fit.model.evaluate(step)
    return ~tried.found_tests | (tried.chi2_by_test > WORSE * fit.evaluation.chi2_by_test)
