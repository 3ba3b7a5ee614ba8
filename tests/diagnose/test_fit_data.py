"""Another kind of record takes one class: free decays of an oscillator are diagnosed, and reported."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

import numpy as np
import pytest

from tests.diagnose.synthetic import MODEL as BENCH
from wedgesweep import config
from wedgesweep.diagnose import diagnosis
from wedgesweep.diagnose.concatenation import joined
from wedgesweep.diagnose.evaluation import Comparison, NoStart, NuisanceParameter
from wedgesweep.diagnose.fit_data import BY_TEST, Arrays, FitData
from wedgesweep.diagnose.result import result_of
from wedgesweep.diagnose.search import Search, base_fit
from wedgesweep.measured import Measurement, TestRecord

MASS, STIFFNESS, DAMPING, STD = 5.0, 5000.0, 5.0, 0.02
TIME = np.arange(200) / 100.0
TRUE = 3.0


PACKAGE = Path(diagnosis.__file__).parent
GENERAL = sorted({*PACKAGE.glob("*.py"), *PACKAGE.glob("result/*.py")} - {Path(diagnosis.__file__)})
CANDIDATES = ("bolster_stiffness", "viscous_damping")


@pytest.mark.parametrize("file", GENERAL, ids=lambda file: file.stem)
def test_only_the_workflow_knows_a_kind_of_record(file):
    """Fits, search, verdict and result see the tests through the interface."""
    folders = ("steady", "transient", "loop")
    assert [each for each in folders if f"wedgesweep.diagnose.{each}" in file.read_text()] == []


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
    kind, law = "decay", "static-dynamic"
    uncertain: Mapping[str, float] = field(default_factory=dict)
    model = config.parse(BENCH)
    eliminated = 1

    @property
    def names(self):
        return tuple(f"{each:g} m" for each in self.stated)

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
    def nuisance_std(self):
        return np.full((self.tests, 1), 0.05)

    @cached_property
    def power(self):
        return self.power_of(self.measured)

    def power_of(self, response):
        return ((response / self.std) ** 2).sum(axis=1)

    @property
    def model_misfit(self):
        return (TIME.size * (1.0 - STD**2 / self.std**2))[:, 0]

    @property
    def noise_floor(self):
        return np.sqrt(np.mean(STD**2 / self.measured.var(axis=1)))

    def nuisances(self, effects):
        return (NuisanceParameter(step=1e-3, max_step=0.1),)

    def start(self):
        return np.zeros((self.tests, 1)), NoStart()

    def subset(self, rows):
        return replace(self, measured=self.measured[rows], stated=self.stated[rows])

    def simulate(self, scenario):
        return decay(scenario.values, self.stated * np.exp(scenario.point.nuisance[:, 0]))

    def compare(self, scenarios, tolerance):
        return [self.compared(self.simulate(each)) for each in scenarios]

    def compared(self, response):
        left = self.measured - response
        offset = left.mean(axis=1, keepdims=True)
        return Comparison(response, (left - offset) / self.std, np.full(self.tests, True), NoStart())

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

    def rows(self, base, extended):
        return [{"released_m": each} for each in self.stated]

    def arrays(self, base, extended):
        return Arrays({"released": (BY_TEST, self.stated, "m", "initial displacement")}, {})


@pytest.fixture(scope="module")
def decays():
    rng, stated = np.random.default_rng(0), np.linspace(0.5, 2.0, 8)
    true = stated * np.exp(0.05 * rng.normal(size=stated.size))
    exact = decay({"viscous_damping": {"coefficient": TRUE}}, true) + rng.normal(size=(stated.size, 1))
    return Decays(exact + STD * rng.normal(size=exact.shape), stated)


def test_the_cause_is_named_and_reported(decays, monkeypatch):
    monkeypatch.setitem(diagnosis.DATA, "decay", lambda measurement: decays)
    tests = tuple(
        TestRecord(name, name, None, None, 0.0, TIME, None, None, kind="decay") for name in decays.names
    )
    measurement = Measurement(Path(), "decays", decays.model, decays.law, {}, tests, False, {})
    found = diagnosis.diagnose(measurement, (*CANDIDATES, "empirical_force"))
    assert found.unfinished == {}
    assert found.empirical is None  # decays record no motion
    (cause,), tested = found.finding.cause.effects, {each.effect: each for each in found.scores}
    assert (found.finding.verdict, cause) == ("named", "viscous_damping")
    fit = found.finding.cause
    assert abs(fit.x[0] - TRUE) < 4.0 * np.sqrt(fit.covariance[0, 0]) < 0.2
    assert found.gain.excess_removed > 0.95
    assert all(each.testable for each in tested.values())
    assert max(tested, key=lambda name: tested[name].t2) == cause
    result = result_of(found)
    rows = result.document["misfit"]["tests"]
    assert [each["released_m"] for each in rows] == decays.stated.tolist()
    assert sum(each["q_extended"] for each in rows) == pytest.approx(fit.evaluation.chi2_by_test.sum())
    assert result.data["released"].values.tolist() == decays.stated.tolist()
    assert result.document["next_test"] is None


def test_tests_behind_one_another_are_tests_together(decays):
    """Parts keep their own nuisance parameters; the fit does not depend on how tests are divided."""
    rows = np.arange(decays.tests)
    parts = joined([decays.subset(rows[:3]), decays.subset(rows[3:])])
    one, several = (base_fit(Search.of(data, ())).base for data in (decays, parts))
    assert several.chi2 == pytest.approx(one.chi2, rel=1e-9)
    assert several.dof == one.dof
    assert (parts.names, joined([decays])) == (decays.names, decays)
