"""A diagnosis that fails on the way, is interrupted or out of time ends with everything that it had found."""

import itertools
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import pytest

from tests.command import invoke
from wedgesweep import api, diagnosis_result, measured, report
from wedgesweep.diagnose import diagnosis, search, stages, work
from wedgesweep.diagnose.result import result_of
from wedgesweep.report.page import render

BENCH = Path(__file__).parents[2] / "examples" / "bench" / "measured.toml"
# Neither explains the bench, nor do both.
CANDIDATES = ("viscous_damping", "stribeck")
STEPS = [step for step in diagnosis.STEPS if step != "calibration"]
LATER = ("refit_cause", "cross_validate", "ladder", "recommend")


@pytest.fixture(scope="module")
def bench():
    whole = measured.read(BENCH)
    return replace(whole, tests=whole.tests[::3])


def steps_of(found, reason):
    return [each["step"] for each in found.document["unfinished"] if reason in each["reason"]]


def singles(found):
    return [each["effects"] for each in found.document["candidates"] if len(each["effects"]) == 1]


def raising(error):
    def step(*given):
        raise error

    return step


@pytest.fixture(scope="module")
def failed(bench):
    """A diagnosis all of whose steps after the single effects fail, and how often its result was told."""
    seen = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(stages, "fit_pairs", raising(ZeroDivisionError("by nothing")))
        for name in LATER:
            patch.setattr(diagnosis, name, raising(ZeroDivisionError("by nothing")))
        patch.setattr(diagnosis.score_test, "scores", raising(ValueError("no matrix")))
        found = diagnosis.diagnose(bench, CANDIDATES, reached=seen.append)
    return result_of(found), seen


def test_steps_that_fail_leave_their_place_empty(failed):
    found, seen = failed
    assert steps_of(found, "ZeroDivisionError: by nothing") == [
        *("pairs", "intervals", "held-out tests", "accuracy", "next test")
    ]
    assert steps_of(found, "ValueError: no matrix") == ["scores"]
    assert found.document["ended"] is None
    assert (found.document["next_test"], found.document["gain"]["scheme"]) == (None, None)
    # The ladder of single effects is told before later steps begin.
    assert [len(each.ladder) for each in seen] == [1] + [2] * (len(seen) - 1)
    assert sorted(found.document["ladder"][1]["effects"]) in [[one] for one in CANDIDATES]
    assert all(each["accuracy"] > 0.0 for each in found.document["ladder"])
    # Without pairs it is not said that none explains.
    assert (found.verdict, found.causes) == ("data-insufficient", [])
    told = report.sentence_of(found)
    assert "pairs, intervals, held-out tests, accuracy and next test (ZeroDivisionError: by nothing)" in told
    assert "none of the" not in told
    assert "ZeroDivisionError: by nothing" in render(found)


def test_an_effect_whose_fit_fails_is_no_candidate(bench, monkeypatch):
    fit = search.single_fits.__globals__["single_fit"]

    def single_fit(search, effect, base):
        return raising(ArithmeticError("odd"))() if effect == "stribeck" else fit(search, effect, base)

    monkeypatch.setitem(search.single_fits.__globals__, "single_fit", single_fit)
    monkeypatch.setattr(diagnosis, "taken", raising(KeyboardInterrupt))
    found = result_of(diagnosis.diagnose(bench, CANDIDATES))
    assert found.document["failed"] == [{"effect": "stribeck", "reason": "ArithmeticError: odd"}]
    assert singles(found) == [["viscous_damping"]]
    assert "fit of stribeck (ArithmeticError: odd)" in report.sentence_of(found)


@pytest.mark.few(1)
@pytest.mark.parametrize("threads", [1, 2])
def test_an_interrupt_ends_in_what_was_found(bench, monkeypatch, threads):
    fit, begun = search.single_fits.__globals__["single_fit"], itertools.count()

    def single_fit(*given):
        return raising(KeyboardInterrupt)() if next(begun) else fit(*given)

    monkeypatch.setitem(search.single_fits.__globals__, "single_fit", single_fit)
    found = result_of(diagnosis.diagnose(bench, CANDIDATES, threads))
    assert found.document["ended"] == {"by": "interrupt", "signal": signal.SIGINT}
    assert steps_of(found, "interrupted") == STEPS
    assert found.verdict == "data-insufficient"
    # Of two threads the other one may have been stopped before its fit ended.
    assert len(singles(found)) == 1 or threads == 2


def test_before_the_base_model_is_fitted_there_is_nothing_to_report(bench, monkeypatch):
    monkeypatch.setattr(diagnosis, "base_fit", raising(KeyboardInterrupt))
    with pytest.raises(KeyboardInterrupt):
        diagnosis.diagnose(bench, CANDIDATES)


def test_the_time_limit_is_looked_at_in_every_simulation(bench):
    """The share used up rises with each look; a diagnosis has some 1,600, single effects 120 to 180."""
    done = []
    for looks in (3, 300):
        count = itertools.count()
        found = diagnosis.diagnose(
            bench, CANDIDATES, time_used=lambda count=count, looks=looks: next(count) / looks
        )
        assert isinstance(found.ended, work.OutOfTime)
        done.append(len(STEPS) - len(found.unfinished))
    assert 0 == done[0] < done[1] < len(STEPS)


@pytest.mark.acceptance
def test_pairs_end_when_half_of_the_time_is_used_and_the_rest_is_done(bench, monkeypatch):
    """Steps that are done stay as they are when a later one is interrupted."""
    monkeypatch.setattr(diagnosis, "recommend", raising(KeyboardInterrupt))
    found = diagnosis.diagnose(bench, CANDIDATES, time_used=lambda: 0.6)
    assert found.unfinished == {"next test": "interrupted", "pairs": "time limit"}
    assert set(map(frozenset, found.never_tried)) == {frozenset(CANDIDATES)}
    assert all(level.best.held_out is not None for level in found.ladder)
    assert found.gain is not None


def test_out_of_time_the_command_ends_with_an_exit_code_of_its_own(tmp_path):
    options = ("--effects", ",".join(CANDIDATES), "--no-report", "-o", tmp_path / "found")
    told = invoke("diagnose", BENCH, *options, "--time-limit", "0.001s", code=3)
    assert "test-09.csv: noise" in told
    assert "base model: error 17.1 times the noise\n" in told.replace("\u00a0", " ")
    assert "(time limit)" in told
    assert diagnosis_result.read(tmp_path / "found").document["ended"]["by"] == "time limit"
    for given in ("60", "-1s", "0s", "1 day", "nans", "infs", "s"):
        assert "is not a time such as 60s" in invoke("diagnose", BENCH, "--time-limit", given, code=2)


def test_a_report_that_fails_does_not_take_the_result_with_it(failed, tmp_path, monkeypatch):
    monkeypatch.setattr(api, "diagnose_measurement", lambda *given, **more: failed[0])
    monkeypatch.setattr(report, "write", raising(ZeroDivisionError("by nothing")))
    told = invoke("diagnose", BENCH, "-o", tmp_path / "found")
    assert "no report (ZeroDivisionError: by nothing)" in told
    assert told.endswith(f"wrote {tmp_path / 'found'}\n")
    assert diagnosis_result.read(tmp_path / "found").document == failed[0].document


@pytest.mark.acceptance
def test_a_killed_diagnosis_leaves_a_ladder(tmp_path):
    """Killed as soon as there is a result, which is after the single effects."""
    found = tmp_path / "found"
    options = ("--effects", ",".join(CANDIDATES), "-o", found, "--n-jobs", "1")
    command = [sys.executable, "-m", "wedgesweep", "diagnose", BENCH, *options]
    with subprocess.Popen(command, stderr=subprocess.DEVNULL) as process:
        while process.poll() is None and not (found / "diagnosis.json").exists():
            time.sleep(0.01)
        process.kill()
    assert process.returncode == -signal.SIGKILL
    result = diagnosis_result.read(found)
    assert [len(each["effects"]) for each in result.document["ladder"]][:2] == [0, 1]
    assert {each["reason"] for each in result.document["unfinished"]} == {"not reached"}
