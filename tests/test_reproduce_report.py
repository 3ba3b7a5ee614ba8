"""Reproduction as a whole: what is run, what is written, and when it disagrees with the record."""

import json
from dataclasses import replace

import pytest
from reproduce import __main__ as reproduction
from reproduce import claims, report
from reproduce import runs as running
from reproduce.findings import HOLDS, VERDICTS, below

from tests import fixture_reproduction


@pytest.mark.acceptance
def test_recorded_verdicts_decide_the_outcome(runs, monkeypatch, tmp_path):
    monkeypatch.setattr(reproduction, "FIGURES", {})
    told = []
    recorded = [
        replace(
            each.claim,
            recorded=each.finding.verdict,
            unilateral=each.unilateral and each.unilateral.verdict,
        )
        for each in claims.check(runs)
    ]

    def agrees(number=None, **verdict):
        told.clear()
        changed = [replace(each, **verdict) if each.number == number else each for each in recorded]
        monkeypatch.setattr(claims, "CLAIMS", changed)
        return reproduction.reproduce(tmp_path, 1, told.append, lambda records, total: None, "claims")

    assert agrees() is True
    assert agrees(2, recorded=HOLDS) is False
    assert "on record: holds" in told[1]
    text = (tmp_path / "reproduction.md").read_text()
    assert "**Claim 2 is recorded as holds, these runs say contradicted.**" in text
    assert agrees(3, unilateral=HOLDS) is False
    text = (tmp_path / "reproduction.md").read_text()
    assert "**Claim 3 with unilateral joints is recorded as holds, these runs say contradicted.**" in text


def test_the_exit_code_says_whether_all_verdicts_are_as_recorded(monkeypatch):
    for as_recorded, code in ((True, 0), (False, 1)):
        monkeypatch.setattr(reproduction, "reproduce", lambda *given, agrees=as_recorded, **more: agrees)
        assert reproduction.main(["--n-jobs", "1"]) == code


@pytest.fixture
def runs(monkeypatch):
    made = fixture_reproduction.build(monkeypatch)
    monkeypatch.setattr(reproduction, "obtain", lambda *arguments: made)
    monkeypatch.setattr(reproduction.published, "check", lambda configs: (below("an oscillator", 1.0, 2.0),))
    return made


def test_the_report_has_every_claim_with_what_was_found_and_the_figures(runs, tmp_path):
    reproduction.reproduce(tmp_path, 1, lambda line: None, lambda records, total: None, "claims")
    content = json.loads((tmp_path / "reproduction.json").read_text(), parse_constant=pytest.fail)  # no nan
    assert sum(content["verdicts"].values()) == 17
    assert {*content["runs"]} == {"paper", "paper-y0", "breakaway", "paper-unilateral"}
    text = (tmp_path / "reproduction.md").read_text()
    for claim in content["claims"]:
        assert f"| {claim['number']} | {claim['claim']} | {claim['paper']} |" in text
        assert f"### {claim['number']}. {claim['claim']}: {claim['verdict']}" in text
        for found in (claim, claim.get("unilateral", claim)):
            assert {found["verdict"], found["recorded"]} <= {*VERDICTS}
            assert found["here"]
            assert all({*each} == {"statement", "here", "criterion", "holds"} for each in found["checks"])
    for kind in report.FIGURES:
        assert (tmp_path / f"paper-{kind}.png").stat().st_size > 10_000
        assert f"](paper-{kind}.png)" in text


TINY = """
title = "tiny"
[sweep]
friction_law = "coulomb"
beta = 1.0
amplitude_mm = 0.5
[solver]
settle_periods = 1
kept_periods = 2
"""


@pytest.fixture
def configs(tmp_path):
    folder = tmp_path / "configs"
    folder.mkdir()
    for name in running.CONFIG_NAMES:
        (folder / f"{name}.toml").write_text(TINY)
    return folder


def obtain(tmp_path, configs):
    told = []
    runs = running.obtain(tmp_path / "out", configs, 1, told.append, lambda records, total: None)
    return runs, told


@pytest.mark.acceptance
def test_finished_runs_are_kept_and_others_made_again(tmp_path, configs):
    first, told = obtain(tmp_path, configs)
    assert ["tiny" in line for line in told] == [True] * 4
    again, told = obtain(tmp_path, configs)
    assert ["kept" in line for line in told] == [True] * 4
    assert again.scaled.ds["amplitude_ratio"].equals(first.scaled.ds["amplitude_ratio"])
    assert [run.config.opens for run in (first.paper, first.unilateral)] == [False, True]
    (configs / "breakaway.toml").write_text(TINY.replace("0.5", "0.6"))
    changed, told = obtain(tmp_path, configs)
    assert ["kept" in line for line in told[:2]] == [True] * 2
    assert "amplitude" in told[2]
    assert "again" in told[2]
    assert changed.breakaway.ds["amplitude"].values.tolist() == [6e-4]
