"""How far numbers may be from where a fit ended, by what Q rises there (profile likelihood).

Next to breakaway Q is rugged: a fit stops short of the least Q, and the curvature there makes a number seem
more certain than it is. So each number is held where its interval should end, and the rest are fitted
again, as MINUIT's MINOS does (James and Roos, 1975, Computer Physics Communications 10, 343).
"""

from collections.abc import Callable
from dataclasses import replace
from itertools import product
from typing import NamedTuple

import numpy as np

from wedgesweep.diagnose.least_squares import refine, tight_refit
from wedgesweep.diagnose.steady.model import Fit

# Half a 95 % interval of one number in standard deviations, and the rise of Q at its ends.
TWO_SIDED = 1.959964
RISE = TWO_SIDED**2
# An end is found if Q has risen by this share of that, or after so many tries.
CLOSE_ENOUGH, TRIES = 0.8, 5
# The next try is no more than this many times further off.
FURTHER = 3.0
# Iterations of a fit with a number held.
ITERATIONS = 10
# A fit that takes this much off Q is better, and is gone on from, so many times at the most.
LOWER, ONWARD = 0.5, 6


class ProfileEnd(NamedTuple):
    """End of an interval, in standard deviations by the curvature, and the fit of the least Q on the way."""

    end: float
    least: Fit


def profile_likelihood(fit: Fit, each: Callable[[Callable, list], list]) -> Fit:
    """A fit or a better one next to it, its covariance no less than where Q says that intervals end.

    ``each`` maps a function. An interval is never narrower than by the curvature at the minimum: where Q is
    rugged a fit with a number held may have stopped short, too.
    """
    sides = list(product(range(fit.model.size), (1.0, -1.0)))
    ends = np.full((fit.model.size, 2), TWO_SIDED)
    for _ in range(ONWARD if fit.evaluation.found else 0):
        ends_found = each(lambda side, fit=fit: _profile_end(fit, *side), sides)
        ends = np.reshape([each.end for each in ends_found], ends.shape)
        least = min((each.least for each in ends_found), key=lambda found: found.chi2, default=fit)
        better = fit if least is fit else tight_refit(replace(least, model=fit.model))
        if better.chi2 > fit.chi2 - LOWER:
            break
        fit = better
    wider = np.r_[ends.max(axis=1) / TWO_SIDED, np.ones(len(fit.x) - fit.model.size)]
    return replace(fit, covariance=wider[:, None] * fit.covariance * wider)


def _profile_end(fit: Fit, number: int, side: float) -> ProfileEnd:
    """Out from a fit along one number until Q has risen enough, or is lower than where it began."""
    std = np.sqrt(fit.covariance[number, number])
    bound = (fit.model.high if side > 0.0 else fit.model.low)[number]
    furthest = abs(bound - fit.x[number]) / std
    end, held = TWO_SIDED, fit
    for _ in range(TRIES):
        off = min(end, furthest)
        held = _held(fit, held, number, fit.x[number] + side * off * std)
        rise = held.chi2 - fit.chi2
        if rise < -LOWER:
            return ProfileEnd(end, held)
        share = np.sqrt(RISE / max(rise, RISE / FURTHER**2))
        end = max(off * share, TWO_SIDED)
        if rise > CLOSE_ENOUGH * RISE or off == furthest:
            break
    return ProfileEnd(end, fit)


def _held(fit: Fit, start: Fit, number: int, value: float) -> Fit:
    """Fit with a number held, from where the others go with it by the covariance."""
    model = fit.model.holding(number, value)
    along = fit.covariance[:, number] / fit.covariance[number, number]
    x = np.clip(start.x + along * (value - start.x[number]), model.low, model.high)
    return refine(model, model.evaluate(replace(start.evaluation.point, x=x)), ITERATIONS)
