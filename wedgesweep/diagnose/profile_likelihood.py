"""Confidence intervals from the rise of chi-squared (profile likelihood).

Near breakaway chi-squared is rugged: a fit may stop short of its minimum, and the curvature there makes a
parameter look more certain than it is. So each parameter is held where its interval should end and the others
are fitted again, as MINUIT's MINOS does (James and Roos, 1975, Computer Physics Communications 10, 343).
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import product
from typing import NamedTuple

import numpy as np

from wedgesweep.diagnose.least_squares import minimise, tight_refit
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.smoothing import TWO_SIDED

# Rise of chi-squared at the ends of a 95 % interval of one parameter.
RISE = TWO_SIDED**2
# An end is found where chi-squared has risen by at least this share of RISE, or after this many tries.
RISE_SHARE, TRIES = 0.8, 5
# The next try is at most this many times further out.
FURTHER = 3.0
# Iterations of a fit with a parameter held.
ITERATIONS = 10
# Number of values at which the parameter of a switch is held, from the end by the curvature to the bound.
VALUES = 6
# No further value is tried once chi-squared has risen by FAR_BEYOND times RISE. Other minima further away are
# no part of the interval; the scan over the whole range has looked there (search.single_fit).
FAR_BEYOND = 10.0
# A fit whose chi-squared is lower by this much becomes the new centre, at most this many times.
LOWER, RESTARTS = 0.5, 6


class ProfileEnd(NamedTuple):
    """End of an interval, in standard deviations by the curvature, and the best fit on the way there."""

    end: float
    best: Fit


def profile_likelihood(fit: Fit, each: Callable[[Callable, list], list]) -> Fit:
    """The fit, or a better one found beside it, with a covariance as wide as its profile likelihood.

    Intervals never become narrower than by the curvature: a fit with a parameter held may stop short as well.
    Only where the curvature tells nothing, and a parameter is at a bound or belongs to a switch, does the
    profile alone count.

    Parameters
    ----------
    fit : Fit
        A fit with its covariance by the curvature.
    each : callable
        Maps a function over a list.
    """
    sides = list(product(range(fit.model.size), (1.0, -1.0)))
    ends = np.full((fit.model.size, 2), TWO_SIDED)
    for _ in range(RESTARTS if fit.evaluation.found else 0):
        # A lower minimum is mostly next to the fit: the near ends come first, as all others are moot then.
        nearest = each(lambda side, fit=fit: _nearest(fit, *side), sides)
        best = _lowest(fit, nearest)
        if best is fit:
            tries = [(*side, near) for side, near in zip(sides, nearest, strict=True)]
            found = each(lambda one, fit=fit: _profile_end(fit, *one), tries)
            ends = np.reshape([one.end for one in found], ends.shape)
            best = _lowest(fit, [one.best for one in found])
        better = fit if best is fit else tight_refit(replace(best, model=fit.model))
        if better.chi2 > fit.chi2 - LOWER:
            break
        fit = better
    wider = np.r_[ends.max(axis=1) / TWO_SIDED, np.ones(len(fit.x) - fit.model.size)]
    return replace(fit, covariance=wider[:, None] * fit.covariance * wider)


def _lowest(fit: Fit, others: Sequence[Fit]) -> Fit:
    """The best of some fits, or ``fit`` if that is not markedly worse."""
    best = min(others, key=lambda one: one.chi2, default=fit)
    return best if best.chi2 < fit.chi2 - LOWER else fit


def _furthest(fit: Fit, parameter: int, side: float) -> float:
    """Distance of a parameter to its bound on one side, in standard deviations."""
    bound = (fit.model.high if side > 0.0 else fit.model.low)[parameter]
    return abs(bound - fit.x[parameter]) / np.sqrt(fit.covariance[parameter, parameter])


def _nearest(fit: Fit, parameter: int, side: float) -> Fit:
    """Fit with a parameter held where its interval ends by the curvature, or at its bound before that.

    ``side``: 1 for the upper end, -1 for the lower one.
    """
    return _held(fit, fit, parameter, side * min(TWO_SIDED, _furthest(fit, parameter, side)))


def _profile_end(fit: Fit, parameter: int, side: float, nearest: Fit) -> ProfileEnd:
    """Move one parameter out until chi-squared has risen by about RISE, or is lower than at the fit.

    ``nearest``: see ``_nearest``.
    """
    bounds = fit.model.low[parameter], fit.model.high[parameter]
    std = np.sqrt(fit.covariance[parameter, parameter])
    furthest = _furthest(fit, parameter, side)
    switches = fit.model.hypothesis.parameters[parameter].switches
    if TWO_SIDED * std > bounds[1] - bounds[0] and (switches or fit.x[parameter] in bounds):
        return _end_by_bisection(fit, parameter, side, furthest, nearest)
    if switches:
        return _end_beyond_ridges(fit, parameter, side, furthest, nearest)
    end, held = TWO_SIDED, nearest
    for tries in range(TRIES):
        off = min(end, furthest)
        held = _held(fit, held, parameter, side * off) if tries else nearest
        rise = held.chi2 - fit.chi2
        if rise < -LOWER:
            return ProfileEnd(end, held)
        share = np.sqrt(RISE / max(rise, RISE / FURTHER**2))
        end = max(off * share, TWO_SIDED)
        if rise > RISE_SHARE * RISE or off == furthest:
            break
    return ProfileEnd(end, fit)


def _end_by_bisection(fit: Fit, parameter: int, side: float, furthest: float, nearest: Fit) -> ProfileEnd:
    """The end where the curvature tells nothing, by bisection between the fit and the bound on one side.

    ``furthest``: distance to that bound in standard deviations; 0 if the parameter is at it. ``nearest``: the
    fit there, as the bound comes before the end by the curvature.
    """
    low, high = 0.0, furthest
    middle = high
    for tries in range(TRIES if furthest else 0):
        held = _held(fit, fit, parameter, side * middle) if tries else nearest
        rise = held.chi2 - fit.chi2
        if rise < -LOWER:
            return ProfileEnd(middle, held)
        low, high = (middle, high) if rise < RISE else (low, middle)
        if low == high:
            break
        middle = 0.5 * (low + high)
    return ProfileEnd(high, fit)


def _end_beyond_ridges(fit: Fit, parameter: int, side: float, furthest: float, nearest: Fit) -> ProfileEnd:
    """The end for the parameter of a switch: the first tried value beyond all that fit nearly as well.

    There chi-squared is rugged: impacts come and go, and several responses are equally steady.
    ``nearest``: see ``_nearest``.
    """
    if furthest <= TWO_SIDED:
        return ProfileEnd(TWO_SIDED, fit)
    end = TWO_SIDED
    values = np.geomspace(TWO_SIDED, furthest, VALUES)
    for value, beyond in zip(values, [*values[1:], furthest], strict=True):
        held = nearest if value == values[0] else _held(fit, fit, parameter, side * value)
        rise = held.chi2 - fit.chi2
        if rise < -LOWER:
            return ProfileEnd(value, held)
        if rise > FAR_BEYOND * RISE:
            break
        if rise < RISE:
            end = beyond
    return ProfileEnd(float(end), fit)


def _held(fit: Fit, start: Fit, parameter: int, off: float) -> Fit:
    """Fit with one parameter held ``off`` standard deviations from where ``fit`` has it.

    The others begin where the covariance of ``fit`` predicts them, extrapolated from the fit ``start``.
    """
    variance = fit.covariance[parameter, parameter]
    value = fit.x[parameter] + off * np.sqrt(variance)
    model = fit.model.holding(parameter, value)
    slope = fit.covariance[:, parameter] / variance
    x = np.clip(start.x + slope * (value - start.x[parameter]), model.low, model.high)
    return minimise(model, model.evaluate(replace(start.point, x=x)), ITERATIONS)
