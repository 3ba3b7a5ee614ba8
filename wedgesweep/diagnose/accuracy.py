"""How accurate a model is: the smallest relative model error at which it is adequate.

No model is right to within the noise of a good sensor. So the variance of each compared number is raised by
that of an error of tau times the response. Chi-squared falls as tau grows, and a model is adequate from some
tau on: that is its accuracy. Where noise is small, it is the rms of the residual over that of the response.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from math import exp, inf, log
from typing import NamedTuple

from scipy.optimize import brentq
from scipy.special import chdtri

from wedgesweep.diagnose.evaluation import Evaluation
from wedgesweep.diagnose.explanation import ADEQUATE
from wedgesweep.diagnose.fit_data import FitData
from wedgesweep.diagnose.least_squares import BRIEF, minimise
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.parameter_constancy import parameter_constancy

# Range in which an accuracy is searched, and how closely.
SMALLEST, LARGEST, PRECISION = 1e-6, 100.0, 1e-3
# A fit is repeated at its accuracy until that improves by less than this share, at most this many times.
GAINED, ROUNDS = 0.01, 3


class Accuracy(NamedTuple):
    """Accuracy of a model (0: adequate without any model error; inf: at none), and its fit there."""

    size: float
    fit: Fit


def smallest_adequate(chi2: Callable[[float], float], dof: float) -> float:
    """Smallest model error at which chi-squared, a falling function of it, is adequate; inf if at none."""
    limit = float(chdtri(dof, ADEQUATE))
    return _smallest(lambda size: log(max(chi2(size), 1e-300) / limit))


def _smallest(over: Callable[[float], float]) -> float:
    """Smallest model error at which a falling function is not above 0; inf if at none."""
    if over(0.0) <= 0.0:
        return 0.0
    if not over(LARGEST) < 0.0:
        return inf
    if over(SMALLEST) <= 0.0:
        return SMALLEST
    return exp(brentq(lambda size: over(exp(size)), log(SMALLEST), log(LARGEST), xtol=PRECISION))


def of_responses(parts: Sequence[tuple[FitData, Evaluation]], dof: float) -> float:
    """Accuracy of what was simulated, pulls on priors left out; inf if a response does not exist."""
    if not all(evaluation.found for _, evaluation in parts):
        return inf

    def chi2(size: float) -> float:
        again = (data.with_model_error(size).compared_again(evaluation) for data, evaluation in parts)
        return sum(float((each.residual**2).sum()) for each in again)

    return smallest_adequate(chi2, dof)


def of_fit(fit: Fit, dof: float | None = None) -> float:
    """Accuracy of a fit where it ended; ``dof``: degrees of freedom, by default those of the fit."""

    def chi2(size: float) -> float:
        return fit.model.data.with_model_error(size).compared_again(fit.evaluation).chi2

    return smallest_adequate(chi2, fit.dof if dof is None else dof) if fit.evaluation.found else inf


def with_constant_parameters(fit: Fit) -> float:
    """Smallest model error at which the parameters of a fit may be the same in all tests; inf if at none."""

    def over(size: float) -> float:
        data = fit.model.data.with_model_error(size)
        here = replace(fit, model=fit.model.on(data), evaluation=data.compared_again(fit.evaluation))
        return log(ADEQUATE / max(parameter_constancy(here).p, 1e-300))

    return _smallest(over)


def refined(fit: Fit) -> Accuracy:
    """Accuracy of a model, fitted again with weights that contain its own model error.

    A fit with the weights of noise alone is not the best one at a large model error: tests with little noise
    dominate it, and take nuisance parameters far from stated.
    """
    best = Accuracy(of_fit(fit), fit)
    size = min(best.size, of_responses([(fit.model.data, fit.evaluation)], fit.dof))
    for _ in range(ROUNDS):
        if size in (0.0, inf):
            break
        again = _minimised(best.fit, size)
        found = of_fit(again)
        gained = found < best.size
        done = found > (1.0 - GAINED) * min(size, best.size)
        best = Accuracy(found, again) if gained else best
        # Where pulls on priors alone are too large, a larger model error relaxes them.
        size = best.size if best.size < inf else 2.0 * size
        if done and best.size < inf:
            break
    return best


def _minimised(fit: Fit, size: float) -> Fit:
    """A fit under a model error, from where it is."""
    data = fit.model.data.with_model_error(size)
    return minimise(fit.model.on(data), data.compared_again(fit.evaluation), BRIEF)
