"""Claims of the paper: verdicts follow the numbers, and the numbers those of the model."""

from collections import Counter

import numpy as np
import pytest
from reproduce import claims, laws, sticking, suspension
from reproduce.findings import (
    CONTRADICTED,
    HOLDS,
    NOT_TESTABLE,
    PARTLY,
    VERDICTS,
    Finding,
    above,
    below,
    near,
    untested,
)
from reproduce.runs import mirrored_columns, single

from tests import fixture_reproduction
from tests.fixture_reproduction import AMPLITUDES

BY_NUMBER = {claim.number: claim for claim in claims.CLAIMS}


@pytest.fixture
def runs(monkeypatch):
    return fixture_reproduction.build(monkeypatch)


def verdict(number, runs):
    return BY_NUMBER[number].find(runs).verdict


def test_the_claims_are_the_seventeen_and_each_has_a_recorded_verdict():
    assert [claim.number for claim in claims.CLAIMS] == list(range(1, 18))
    recorded = Counter(claim.recorded for claim in claims.CLAIMS)
    assert recorded == {HOLDS: 2, PARTLY: 9, CONTRADICTED: 6}
    large = [claim for claim in claims.CLAIMS if claim.unilateral]
    assert [claim.number for claim in large] == [3, 4, 5, 9, 10]
    assert all(claim.unilateral == claim.recorded for claim in large)


def test_the_verdict_follows_from_the_checks():
    for checks, expected in (
        ((True, True), HOLDS),
        ((True, False), PARTLY),
        ((False, False), CONTRADICTED),
        ((None, None), NOT_TESTABLE),
        ((None, True), HOLDS),
        ((None, False), CONTRADICTED),
    ):
        made = [untested("x", "y") if holds is None else above("x", holds, 0.5) for holds in checks]
        assert Finding("", "", tuple(made)).verdict == expected
    # Criteria hold up to their limits, and never for nan.
    assert near("x", -2.0, -2.1, 0.05).holds
    assert not near("x", -1.9, -2.1, 0.05).holds
    assert below("x", 1.0, 1.0).holds
    assert not above("x", 1.0, 1.0).holds
    assert not any(check.holds for check in (near("x", np.nan, 1.0, 1.0), below("x", np.nan, 1.0)))


@pytest.mark.few(3)
@pytest.mark.parametrize("number", BY_NUMBER)
def test_every_claim_says_what_it_found(runs, number):
    found = BY_NUMBER[number].find(runs)
    assert found.verdict in VERDICTS
    assert found.here
    assert "{" not in found.here + found.reason
    assert all(check.criterion for check in found.checks)


def test_rest_position_and_resonance_decide_their_claims(runs):
    assert [verdict(number, runs) for number in (2, 3)] == [CONTRADICTED, CONTRADICTED]
    ds = runs.paper.ds
    ds.attrs |= {"rest_position": -2.1941e-3, "frictionless_resonance": 0.8 * runs.paper.omega_n}
    assert verdict(2, runs) == HOLDS
    assert verdict(3, runs) == PARTLY  # the largest ratios still lie at 1.1
    ds["amplitude_ratio"].loc[{"beta": 0.8}] = 50.0
    assert verdict(3, runs) == HOLDS


def test_laws_that_part_where_they_have_settled_contradict_the_claims_that_they_are_alike(runs):
    ratio, periodicity = runs.paper.ds["amplitude_ratio"], runs.paper.ds["periodicity"]
    ratio[:] = 1.0
    assert [verdict(number, runs) for number in (5, 9)] == [HOLDS, HOLDS]
    last = {"friction_law": "exponential", "beta": 3.0}
    ratio.loc[last] = 9.0
    assert verdict(9, runs) == PARTLY
    periodicity.loc[last] = 0.5
    assert verdict(9, runs) == HOLDS
    ratio.loc[{"friction_law": "exponential"}] = 2.0
    periodicity[:] = 0.0
    assert [verdict(number, runs) for number in (5, 9)] == [CONTRADICTED, CONTRADICTED]


def test_stick_slip_above_the_last_beta_contradicts(runs):
    for run in (runs.paper, runs.breakaway):
        run.ds["stick_fraction"][:] = 0.0
    assert verdict(6, runs) == HOLDS
    runs.paper.ds["stick_fraction"].loc[{"friction_law": "coulomb", "beta": 0.4}] = 0.5
    assert verdict(6, runs) == HOLDS
    runs.paper.ds["stick_fraction"].loc[{"friction_law": "coulomb", "beta": 0.6}] = 0.5
    assert verdict(6, runs) == PARTLY
    runs.breakaway.ds["stick_fraction"].loc[{"friction_law": "coulomb"}] = 0.5
    assert verdict(6, runs) == CONTRADICTED


def test_an_onset_at_one_input_holds_and_one_at_one_acceleration_does_not(runs):
    assert verdict(7, runs) == CONTRADICTED
    assert sticking.slope(*sticking.slip_onsets(runs.paper)) == pytest.approx(-2.0, abs=0.15)
    moves = runs.paper.ds["amplitude"] > 2e-4
    ds = runs.paper.ds
    ds["stick_fraction"] = (ds["stick_fraction"] * 0.0 + 1.0).where(~moves, 0.0)
    ds["amplitude_ratio"] = (ds["amplitude_ratio"] * 0.0 + 1.0).where(moves, 0.0)
    assert verdict(7, runs) == HOLDS


def test_lift_off_is_counted_on_the_grid_and_evenly(runs):
    lifted = runs.paper.ds["lift_off_fraction"]
    lifted[:] = 0.0
    assert verdict(15, runs) == HOLDS
    lifted[{"amplitude": -1}] = 0.4
    found = BY_NUMBER[15].find(runs)
    assert found.verdict == CONTRADICTED
    assert found.checks[0].here == pytest.approx(1 / len(AMPLITUDES))
    assert suspension.evenly(lifted > 0.0) > 0.5


def test_a_failed_case_makes_no_number(runs):
    for name, variable in runs.paper.ds.data_vars.items():
        if variable.dtype.kind == "f":
            runs.paper.ds[name][{"friction_law": 1, "beta": 3, "amplitude": 2}] = np.nan
    for outcome in claims.check(runs):
        assert outcome.finding.verdict in VERDICTS
    assert int(laws.spread(runs.paper).notnull().sum()) == 79


def test_frictionless_ratios_and_those_of_mirrored_columns_are_those_of_table_1(runs):
    run = runs.paper
    found = [suspension.frictionless_ratio(run, beta) for beta in (run.beta_of(20.0), 3.0)]
    assert found == pytest.approx([2.58, 1.20], abs=0.005)
    assert suspension.mirrored_rest(run) == pytest.approx(-0.9342939466)


def test_a_single_case_that_locks_is_nan(runs):
    locking = {**mirrored_columns(runs.paper.config), "friction": {"dynamic": 0.5}}
    assert np.isnan(single(runs.paper, "coulomb", 1.1, 2.0, locking)["amplitude_ratio"])
