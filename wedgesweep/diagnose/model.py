"""A hypothesis on measured tests: evaluates points, and knows free parameters, bounds and priors."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.special import chdtrc

from wedgesweep.diagnose.evaluation import Comparison, Evaluation, Point, Scenario, best_evaluation_per_test
from wedgesweep.diagnose.explanation import POSSIBLE, parameter_penalty
from wedgesweep.diagnose.fit_data import FitData
from wedgesweep.diagnose.fit_parameters import Hypothesis, Values
from wedgesweep.diagnose.parameter_constancy import Constancy, parameter_constancy
from wedgesweep.diagnose.work import Best
from wedgesweep.uncertain import UncertainNumbers, uncertain_numbers

# Relative errors of simulations: negligible beside noise of 4 %, negligible in derivatives as well, and small
# enough to choose the points from which a fit starts.
TOLERANCE, TIGHT, ROUGH = 1e-6, 1e-8, 1e-5
# The base model is also fitted from starts with an uncertain parameter this many standard deviations off.
START_OFFSET = 1.5
# Uncertain parameters that a fit moves by more standard deviations than this are not those of the rig.
IMPLAUSIBLE = 4.0
# A nuisance parameter that is stated as exact has this standard deviation.
EXACT = 1e-6


@dataclass(frozen=True)
class Model:
    """A hypothesis on the tests of some data, simulated to a tolerance.

    Its parameters x (k + u,) are the k of the hypothesis, then the u uncertain ones of the base model.
    ``held``: index (or slice) and value of parameters that are not fitted. ``as_stated``: whether
    uncertain parameters are held at what is stated, and so no part of x.
    """

    data: FitData
    hypothesis: Hypothesis
    tolerance: float = TOLERANCE
    held: tuple[int | slice, float | np.ndarray] | None = None
    as_stated: bool = False

    @property
    def size(self) -> int:
        """Number k of parameters of the hypothesis."""
        return len(self.hypothesis.parameters)

    @property
    def effects(self) -> tuple[str, ...]:
        return self.hypothesis.effects

    @cached_property
    def uncertain(self) -> UncertainNumbers:
        """Uncertain parameters (u,) of the base model with their priors; a candidate effect has no prior."""
        declared = {} if self.as_stated else self.data.uncertain
        stds = {k: s for k, s in declared.items() if k not in self.effects}
        return uncertain_numbers(stds, self.data.model.effects)

    @cached_property
    def low(self) -> np.ndarray:
        """Lower bounds of x, (k + u,)."""
        return self._bound(self.hypothesis.low, self.uncertain.low)

    @cached_property
    def high(self) -> np.ndarray:
        """Upper bounds of x, (k + u,)."""
        return self._bound(self.hypothesis.high, self.uncertain.high)

    def _bound(self, hypothesis: np.ndarray, uncertain: np.ndarray) -> np.ndarray:
        bound = np.r_[hypothesis, uncertain]
        if self.held is not None:
            bound[self.held[0]] = self.held[1]
        return bound

    @cached_property
    def scale(self) -> np.ndarray:
        """Typical changes of x, (k + u,)."""
        return np.r_[self.hypothesis.scale, self.uncertain.scale]

    @cached_property
    def nuisance_weight(self) -> np.ndarray:
        """One over the prior standard deviation of nuisance parameters, (T, P); 0 without a prior."""
        return 1.0 / np.maximum(self.data.nuisance_std, EXACT)

    @property
    def dof(self) -> int:
        """Observations less everything that is fitted without a prior."""
        return int(self.data.dof.sum()) - int(self.data.extra_nuisances(self.effects).sum()) - self.size

    def holding(self, parameter: int | slice, value: float | np.ndarray) -> "Model":
        """The model with one of its parameters known, or several."""
        return replace(self, held=(parameter, value))

    def on(self, data: FitData) -> "Model":
        """The same hypothesis on other data."""
        return replace(self, data=data)

    def uncertain_starts(self) -> np.ndarray:
        """Starts (n, u) of the uncertain parameters: as stated, and with each factor off to either side."""
        factors = [each.factor for each in self.uncertain.numbers]
        off = START_OFFSET * np.diag(self.uncertain.std)[factors]
        stated = self.uncertain.mean[None]
        return np.maximum(np.concatenate([stated, stated + off, stated - off]), self.uncertain.low)

    def values(self, x: np.ndarray) -> Values:
        """Values of all effects in SI."""
        return {**self.uncertain.values(x[self.size :]), **self.hypothesis.values(x[: self.size])}

    def scenario(self, point: Point) -> Scenario:
        """What to simulate at a point."""
        return Scenario(self.values(point.x), point)

    def evaluate(self, point: Point) -> Evaluation:
        """Simulate a point and compare it with the measurement."""
        return self.evaluate_all([point])[0]

    def evaluate_all(self, points: Sequence[Point]) -> list[Evaluation]:
        """Simulate many points at once."""
        compared = self.data.compare([self.scenario(point) for point in points], self.tolerance)
        return [self._evaluation(*each) for each in zip(points, compared, strict=True)]

    def _evaluation(self, point: Point, found: Comparison) -> Evaluation:
        nuisance = point.nuisance[:, : self.nuisance_weight.shape[1]] * self.nuisance_weight
        uncertain = (point.x[self.size :] - self.uncertain.mean) / self.uncertain.std
        here = replace(point, warm=found.warm)
        return Evaluation(here, found.response, found.residual, nuisance, uncertain, found.found)

    def best_nuisances(self, points: Sequence[Point]) -> np.ndarray:
        """Nuisance parameters (T, N) of each test from the point that fits it best."""
        best = best_evaluation_per_test(self.evaluate_all(points))
        return np.array([each.nuisance for each in points])[best, np.arange(best.size)]

    def start(self, base: "Fit | None", x: np.ndarray) -> Point:
        """The point with parameters x (k,) of the hypothesis, and everything else as in a base fit.

        Without one, everything else is as stated.
        """
        if base is None:
            return Point(np.r_[x, self.uncertain.mean], *self.data.start())
        known = base.model.uncertain.values(base.x[base.model.size :])
        return replace(base.evaluation.point, x=np.r_[x, self.uncertain.at(known)])


@dataclass(frozen=True)
class Fit:
    """Where a fit ended; ``covariance`` (k + u, k + u) is that of x."""

    model: Model
    evaluation: Evaluation
    covariance: np.ndarray
    converged: bool

    @property
    def effects(self) -> tuple[str, ...]:
        return self.model.effects

    @property
    def chi2(self) -> float:
        return self.evaluation.chi2

    @property
    def best(self) -> Best:
        """What a stage that changes this fit is judged by."""
        return Best(self.effects, self.chi2)

    @property
    def dof(self) -> int:
        return self.model.dof

    @property
    def excess(self) -> float:
        """Chi-squared less its expectation."""
        return self.chi2 - self.dof

    @property
    def point(self) -> Point:
        return self.evaluation.point

    @property
    def x(self) -> np.ndarray:
        return self.evaluation.point.x

    @property
    def p(self) -> float:
        """Probability of a misfit this large if the model is right."""
        return float(chdtrc(self.dof, self.chi2))

    @cached_property
    def constancy(self) -> Constancy:
        """Whether its parameters are the same in all tests."""
        return parameter_constancy(self)

    @property
    def p_value(self) -> float:
        """The smaller of two p-values: that of the misfit, and that of the test for constant parameters.

        The latter takes simulations, and is left out where the misfit alone rules the explanation out.
        """
        return min(self.p, self.constancy.p) if self.p >= POSSIBLE else self.p

    @property
    def penalised(self) -> float:
        """Chi-squared plus the penalty for all parameters."""
        return self.chi2 + parameter_penalty(self.model.data) * self.model.size

    @property
    def implausible(self) -> tuple[str, ...]:
        """Effects whose uncertain parameters the fit has moved too far from stated, see IMPLAUSIBLE."""
        far = np.abs(self.evaluation.uncertain_prior) > IMPLAUSIBLE
        numbers = self.model.uncertain.numbers
        return tuple(dict.fromkeys(each.effect for each, is_far in zip(numbers, far, strict=True) if is_far))

    @property
    def values(self) -> Values:
        """Numbers of the hypothesis in key units."""
        return self.model.hypothesis.in_key_units(self.x[: self.model.size])


def unfitted(model: Model, evaluation: Evaluation) -> Fit:
    """An evaluation as a fit that has not begun."""
    return Fit(model, evaluation, np.zeros((evaluation.point.x.size,) * 2), False)
