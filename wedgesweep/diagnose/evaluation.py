"""Points of the parameter space, and their simulations compared with the measured tests."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple, Protocol

import numpy as np

from wedgesweep.diagnose.fit_parameters import Values


class WarmStart(Protocol):
    """Where the simulations of T tests start from; opaque to the fit."""

    def of(self, rows: Any) -> Any:
        """The warm start of some tests."""


class NoStart(NamedTuple):
    """The warm start of simulations that do not depend on earlier ones."""

    def of(self, rows: Any) -> "NoStart":
        return self


@dataclass(frozen=True)
class Point:
    """One guess of everything that is fitted by simulation.

    ``x`` (k + u,): parameters of the hypothesis, then uncertain parameters of the base model as scales.
    ``nuisance`` (T, N): nuisance parameters of each test, those with a prior first.
    ``warm``: a WarmStart.
    """

    x: np.ndarray
    nuisance: np.ndarray
    warm: Any

    def moved(self, step: np.ndarray, nuisance_step: np.ndarray) -> "Point":
        """The point after a step of x (k + u,) and of the first L nuisance parameters, (T, L) or (L,)."""
        nuisance = self.nuisance.copy()
        nuisance[:, : nuisance_step.shape[-1]] += nuisance_step
        return replace(self, x=self.x + step, nuisance=nuisance)

    def subset(self, rows: np.ndarray) -> "Point":
        """The point for some of its tests."""
        return Point(self.x, self.nuisance[rows], self.warm.of(rows))


class Scenario(NamedTuple):
    """What to simulate: the values of all effects (SI), and the point that they belong to."""

    values: Values
    point: Point


class Comparison(NamedTuple):
    """One simulated scenario compared with the measurement.

    ``response``: what was simulated, in the terms of the kind of record. ``residual`` (T, m): measurement
    less simulation, whitened: of unit variance and uncorrelated. ``found`` (T,): whether a response exists.
    """

    response: Any
    residual: np.ndarray
    found: np.ndarray
    warm: Any


class NuisanceParameter(NamedTuple):
    """A nuisance parameter fitted by simulation: finite-difference step, largest step of one iteration."""

    step: float
    max_step: float


# In the place of a nuisance parameter that no test needs: it is never moved.
UNUSED = NuisanceParameter(step=0.0, max_step=0.0)


@dataclass(frozen=True)
class Evaluation:
    """A point with its simulation and its residuals.

    ``residual`` (T, m) and ``found_tests`` (T,): see Comparison. ``nuisance_prior`` (T, P) and
    ``uncertain_prior`` (u,): pulls on the priors of nuisance and uncertain parameters (distance from stated
    in standard deviations).
    """

    point: Point
    response: Any
    residual: np.ndarray
    nuisance_prior: np.ndarray
    uncertain_prior: np.ndarray
    found_tests: np.ndarray

    @property
    def found(self) -> bool:
        """Whether all tests have a response."""
        return bool(self.found_tests.all())

    @cached_property
    def chi2_by_test(self) -> np.ndarray:
        """Squared misfit of each test, pulls on its own priors included, (T,)."""
        return (self.residual**2).sum(-1) + (self.nuisance_prior**2).sum(-1)

    @cached_property
    def chi2(self) -> float:
        """Squared misfit of all tests, pulls on priors included; infinite if a response does not exist."""
        return float(self.chi2_by_test.sum() + (self.uncertain_prior**2).sum()) if self.found else np.inf


def best_evaluation_per_test(evaluations: Sequence[Evaluation]) -> np.ndarray:
    """Index (T,) of the evaluation that fits each test best."""
    misfit = [np.where(each.found_tests, each.chi2_by_test, np.inf) for each in evaluations]
    return np.argmin(misfit, axis=0)
