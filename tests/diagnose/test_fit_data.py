"""Another kind of record takes one class: free decays of an oscillator go through the whole search."""

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from types import MappingProxyType

import numpy as np
import pytest

from tests.diagnose.synthetic import MODEL as BENCH
from wedgesweep import config
from wedgesweep.diagnose import cross_validation, diagnosis, score_test, verdict
from wedgesweep.diagnose.evaluation import Comparison, NuisanceParameter
from wedgesweep.diagnose.fit_data import FitData
from wedgesweep.diagnose.least_squares import tight_refit
from wedgesweep.diagnose.profile_likelihood import profile_likelihood
from wedgesweep.diagnose.search import Search

MASS, STIFFNESS, DAMPING, STD = 5.0, 5000.0, 5.0, 0.02
TIME = np.arange(200) / 100.0
TRUE = 3.0


PACKAGE = Path(diagnosis.__file__).parent
GENERAL = sorted(set(PACKAGE.glob("*.py")) - {Path(diagnosis.__file__)})


@pytest.mark.parametrize("file", GENERAL, ids=lambda file: file.stem)
def test_only_the_workflow_knows_a_kind_of_record(file):
    """Fits, search and verdict see the tests through the interface."""
    assert "wedgesweep.diagnose.steady" not in file.read_text()


class NoWarmStart:
    """A closed form needs none."""

    def of(self, rows):
        return self

    def where(self, chosen, other):
        return self


def decay(values, amplitude):
    """Free decays (T, n) from rest at some displacements (T,)."""
    stiffness = STIFFNESS * values.get("bolster_stiffness", {"scale": 1.0})["scale"]
    rate = (DAMPING + values.get("viscous_damping", {"coefficient": 0.0})["coefficient"]) / (2.0 * MASS)
    turn = np.sqrt(stiffness / MASS - rate**2) * TIME
    return np.multiply.outer(amplitude, np.exp(-rate * TIME) * (np.cos(turn) + rate * np.sin(turn)))


@dataclass(frozen=True)
class Decays(FitData):
    """Displacements (T, n) with noise STD and an unknown offset; initial displacements are known to 5 %."""

    measured: np.ndarray
    stated: np.ndarray
    model_error: float = 0.0
    model = config.parse(BENCH)
    uncertain = MappingProxyType({})
    eliminated = 1

    @cached_property
    def std(self):
        return np.sqrt(STD**2 + self.model_error**2 * self.measured.var(axis=1, keepdims=True))

    @property
    def tests(self):
        return len(self.measured)

    @property
    def observations(self):
        return np.full(self.tests, TIME.size)

    @property
    def dof(self):
        return self.observations - 1

    @property
    def nuisance_std(self):
        return np.full((self.tests, 1), 0.05)

    @cached_property
    def power(self):
        return ((self.measured / self.std) ** 2).sum(axis=1)

    @property
    def model_misfit(self):
        return (TIME.size * (1.0 - STD**2 / self.std**2))[:, 0]

    @property
    def noise_floor(self):
        return np.sqrt(np.mean(STD**2 / self.measured.var(axis=1)))

    def nuisances(self, effects, point):
        return (NuisanceParameter(step=1e-3, max_step=0.1),)

    def start(self):
        return np.zeros((self.tests, 1)), NoWarmStart()

    def subset(self, rows):
        return replace(self, measured=self.measured[rows], stated=self.stated[rows])

    def simulate(self, scenario):
        return decay(scenario.values, self.stated * np.exp(scenario.point.nuisance[:, 0]))

    def compare(self, scenarios, tolerance):
        return [self.compared(self.simulate(each)) for each in scenarios]

    def compared(self, response):
        left = self.measured - response
        offset = left.mean(axis=1, keepdims=True)
        return Comparison(response, (left - offset) / self.std, np.full(self.tests, True), NoWarmStart())

    def with_model_error(self, size):
        return replace(self, model_error=size)

    def compared_again(self, here):
        return replace(here, residual=self.compared(here.response).residual)

    def changes(self, here, scenarios, tolerance):
        change = np.array([here.response - self.simulate(each) for each in scenarios]) / self.std
        return change, np.full((len(scenarios), self.tests), True)

    def eliminated_derivatives(self, here):
        return np.repeat(-1.0 / self.std, TIME.size, axis=1)[..., None]

    def response_change(self, here, there):
        return (there.response - here.response) / self.std

    def bootstrap_sample(self, truth, rng):
        return replace(self, measured=truth.response + self.std * rng.normal(size=truth.response.shape))

    def held_out_groups(self):
        return [("displacement", np.array([test])) for test in range(self.tests)]


@pytest.fixture(scope="module")
def explained():
    rng, stated = np.random.default_rng(0), np.linspace(0.5, 2.0, 8)
    true = stated * np.exp(0.05 * rng.normal(size=stated.size))
    exact = decay({"viscous_damping": {"coefficient": TRUE}}, true) + rng.normal(size=(stated.size, 1))
    data = Decays(exact + STD * rng.normal(size=exact.shape), stated)
    return diagnosis.explain(Search.of(data, ("bolster_stiffness", "viscous_damping")))


def test_the_cause_is_named(explained):
    finding = verdict.decide(explained.base, explained.explanations, verdict.DEFAULT)
    assert (finding.verdict, finding.best.effects) == ("named", ("viscous_damping",))
    fit = finding.best.fit
    fit = profile_likelihood(tight_refit(fit), explained.search.each)
    assert abs(fit.x[0] - TRUE) < 4.0 * np.sqrt(fit.covariance[0, 0])
    assert np.sqrt(fit.covariance[0, 0]) < 0.05


def test_the_gain_and_the_scores_tell_the_same(explained):
    best = explained.explanations[0].fit
    predict = cross_validation.Predictor(explained.search.each)
    gain = cross_validation.cross_validate(explained.base.fit, best, predict)
    assert gain.excess_removed > 0.95
    scores = score_test.scores(explained.search, explained.base.fit, explained.scans)
    assert all(each.testable for each in scores)
    assert max(scores, key=lambda each: each.t2).effect == "viscous_damping"
