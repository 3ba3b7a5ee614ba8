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

from wedgesweep.diagnose.least_squares import BRIEF, minimise, tight_refit
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.smoothing import TWO_SIDED

# Rise of chi-squared at the ends of a 95 % interval of one parameter.
RISE = TWO_SIDED**2
# An end is found where chi-squared has risen by at least this share of RISE, or after this many tries.
RISE_SHARE, TRIES = 0.8, 5
# The next try is at most this many times further out.
FURTHER = 3.0
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


class _Side(NamedTuple):
    """The upper (1) or lower (-1) side of one parameter of a fit."""

    fit: Fit
    parameter: int
    sign: float

    @property
    def std(self) -> float:
        """Standard deviation by the curvature, in which distances from the fit are told."""
        return float(np.sqrt(self.fit.covariance[self.parameter, self.parameter]))

    @property
    def furthest(self) -> float:
        """Distance to the bound; 0 if the parameter is at it."""
        model = self.fit.model
        bound = (model.high if self.sign > 0.0 else model.low)[self.parameter]
        return float(abs(bound - self.fit.x[self.parameter])) / self.std

    @property
    def nearest(self) -> Fit:
        """Fit with the parameter where its interval ends by the curvature, or at its bound before that."""
        return self.held(min(TWO_SIDED, self.furthest), self.fit)

    def held(self, off: float, start: Fit) -> Fit:
        """Fit with the parameter held at a distance.

        The others begin where the covariance predicts them, extrapolated from the fit ``start``.
        """
        fit, parameter = self.fit, self.parameter
        value = fit.x[parameter] + self.sign * off * self.std
        model = fit.model.holding(parameter, value)
        slope = fit.covariance[:, parameter] / fit.covariance[parameter, parameter]
        x = np.clip(start.x + slope * (value - start.x[parameter]), model.low, model.high)
        return minimise(model, model.evaluate(replace(start.point, x=x)), BRIEF)


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
    ends = np.full((fit.model.size, 2), TWO_SIDED)
    for _ in range(RESTARTS if fit.evaluation.found else 0):
        sides = [_Side(fit, *one) for one in product(range(fit.model.size), (1.0, -1.0))]
        # A lower minimum is mostly next to the fit: the near ends come first, as all others are moot then.
        nearest = each(lambda side: side.nearest, sides)
        best = _lowest(fit, nearest)
        if best is fit:
            found = each(lambda one: _profile_end(*one), list(zip(sides, nearest, strict=True)))
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


def _profile_end(side: _Side, nearest: Fit) -> ProfileEnd:
    """Move one parameter out until chi-squared has risen by about RISE, or is lower than at the fit."""
    fit, furthest = side.fit, side.furthest
    low, high = fit.model.low[side.parameter], fit.model.high[side.parameter]
    switches = fit.model.hypothesis.parameters[side.parameter].switches
    if TWO_SIDED * side.std > high - low and (switches or fit.x[side.parameter] in (low, high)):
        return _end_by_bisection(side, nearest)
    if switches:
        return _end_beyond_ridges(side, nearest)
    end, held = TWO_SIDED, nearest
    for tries in range(TRIES):
        off = min(end, furthest)
        held = side.held(off, held) if tries else nearest
        rise = held.chi2 - fit.chi2
        if rise < -LOWER:
            return ProfileEnd(end, held)
        share = np.sqrt(RISE / max(rise, RISE / FURTHER**2))
        end = max(off * share, TWO_SIDED)
        if rise > RISE_SHARE * RISE or off == furthest:
            break
    return ProfileEnd(end, fit)


def _end_by_bisection(side: _Side, nearest: Fit) -> ProfileEnd:
    """The end where the curvature tells nothing, by bisection between the fit and the bound on one side.

    ``nearest``: the fit at the bound, which comes before the end by the curvature.
    """
    low, high = 0.0, side.furthest
    middle = high
    for tries in range(TRIES if high else 0):
        held = side.held(middle, side.fit) if tries else nearest
        rise = held.chi2 - side.fit.chi2
        if rise < -LOWER:
            return ProfileEnd(middle, held)
        low, high = (middle, high) if rise < RISE else (low, middle)
        if low == high:
            break
        middle = 0.5 * (low + high)
    return ProfileEnd(high, side.fit)


def _end_beyond_ridges(side: _Side, nearest: Fit) -> ProfileEnd:
    """The end for the parameter of a switch: the first tried value beyond all that fit nearly as well.

    There chi-squared is rugged: impacts come and go, and several responses are equally steady.
    """
    fit, furthest = side.fit, side.furthest
    end = TWO_SIDED
    if furthest <= TWO_SIDED:
        return ProfileEnd(end, fit)
    values = np.geomspace(TWO_SIDED, furthest, VALUES)
    for value, beyond in zip(values, [*values[1:], furthest], strict=True):
        held = nearest if value == values[0] else side.held(value, fit)
        rise = held.chi2 - fit.chi2
        if rise < -LOWER:
            return ProfileEnd(value, held)
        if rise > FAR_BEYOND * RISE:
            break
        if rise < RISE:
            end = beyond
    return ProfileEnd(float(end), fit)
