"""A sweep of millions of cases costs nothing until they are solved."""

import re
import tracemalloc
from itertools import islice

import numpy as np
import pytest

from tests.command import invoke, python_calls
from wedgesweep import config, formatting
from wedgesweep.config import Case, Config
from wedgesweep.outcome import lifted, unsettled
from wedgesweep.sweep import dataset, estimate, labels, outcomes, variables
from wedgesweep.sweep.chunks import CHUNK, Rows
from wedgesweep.sweep.run import Sweep

GRID = """\
[sweep]
friction_law = "coulomb"
beta = {{ start = 0.1, stop = 3.0, num = {betas} }}
amplitude_mm = {{ start = 0.005, stop = 4.75, num = {amplitudes} }}
[solver]
method = "event-driven"
settle_periods = 5
keep_waveforms = false
"""
MILLION, MOST = GRID.format(betas=1000, amplitudes=1000), GRID.format(betas=10_000, amplitudes=10_000)


@pytest.fixture(scope="module")
def most():
    return config.parse(MOST)


def test_a_case_is_made_from_its_index(most):
    few = config.parse(GRID.format(betas=3, amplitudes=2).replace('"coulomb"', '["coulomb", "exponential"]'))
    assert few.sweep.shape == (2, 3, 2)
    assert [few.sweep.case(index) for index in range(12)] == few.case_list()
    assert few.case_list()[7] == Case("exponential", few.sweep.beta[0], few.sweep.amplitude[1])
    assert few.records(np.array([7, 2])).tobytes() == few.records()[[7, 2]].tobytes()
    assert most.sweep.case(99_999_999) == Case("coulomb", 3.0, 0.00475)


def test_no_case_is_made_before_it_is_needed(most, tmp_path):
    sweep = Sweep(most, tmp_path / "most.nc")
    sweep.config.records(np.array([0]))
    tracemalloc.start()
    rows = sweep.rows.without(sweep.rows.complete(np.zeros(0, int)))
    first = list(islice(sweep.rows.chunks(rows, "event-driven"), 3))
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert len(rows) == 100_000_000
    assert [len(chunk) for chunk in first] == [CHUNK] * 3
    assert peak < 100_000


@pytest.mark.parametrize("text", [MILLION, MOST], ids=["a million", "a hundred million"])
def test_check_makes_the_cases_that_it_runs_and_no_more(tmp_path, monkeypatch, text):
    (tmp_path / "many.toml").write_text(text)
    made = []
    records_of = Config.records
    monkeypatch.setattr(Config, "records", lambda own, rows: made.extend(rows) or records_of(own, rows))
    told = invoke("check", tmp_path / "many.toml")
    assert 0 < len(made) < 2000
    assert f"{config.parse(text).sweep.count} = 1 friction law x" in told


@pytest.mark.parametrize(("solver", "factor"), [("settle_periods = 37", 4.0), ("settle_periods = 1", 1.0)])
def test_radau_is_timed_by_a_part_of_the_periods(tmp_path, monkeypatch, solver, factor):
    """Of 40 periods 10 are run, 3 of which are kept; few periods are run whole."""
    grid = GRID.format(betas=2, amplitudes=2).replace('"event-driven"', '"radau"')
    text = re.sub("settle_periods = .*", solver, grid)
    sweep, settled = Sweep(config.parse(text), tmp_path / "few.nc"), []

    def solved(records, indices, settings, limit, dtype):
        settled.append(settings.settle_periods)
        found = np.zeros(len(indices), dtype)
        found["index"], found["wall_time"] = indices, 2.0
        return found

    monkeypatch.setattr(estimate, "solve_cases", solved)
    monkeypatch.setattr(estimate, "compile_once", lambda *_: None)
    cost = estimate.estimate(sweep, n_jobs=2)
    assert settled == [1, *[7 if factor > 1.0 else 1] * 4]  # the first one loads the compiled code
    assert cost.seconds == 4 * 2.0 * factor / 2
    assert sorted(cost.sampled["index"]) == [0, 1, 2, 3]


@pytest.mark.parametrize(("each", "samples"), [(1e-7, [2, 2, 20, 200, 1000]), (1.0, [2, 2])])
def test_a_motion_is_timed_by_its_start(tmp_path, monkeypatch, each, samples):
    """A sample takes ``each`` (s): 1000 of them are run where that is soon done, else the first two."""
    release = '[input]\nkind = "release"\ndisplacement_mm = 3.0\nduration_s = 1.0\nsampling_hz = 1000.0\n'
    cases = '[sweep]\nfriction_law = "coulomb"\nscale = 1.0\n[solver]\nmethod = "event-driven"\n'
    sweep, run = Sweep(config.parse(release + cases), tmp_path / "one.nc"), []

    def solved(records, indices, settings, limit, dtype):
        motion = settings.transient
        assert motion.span == pytest.approx(motion.samples / 1000.0)
        run.append(motion.samples)
        found = np.zeros(1, dtype)
        found["wall_time"] = each * motion.samples
        return found

    monkeypatch.setattr(estimate, "solve_cases", solved)
    monkeypatch.setattr(estimate, "compile_once", lambda *_: None)
    assert estimate.estimate(sweep, n_jobs=1).seconds == pytest.approx(1000 * each)
    assert run == samples


def test_numbers_of_a_long_list_take_two_calls_each():
    calls = {}
    for number in (1000, 100_000):
        values = np.linspace(0.1, 3.0, number).tolist()
        sweep = {"friction_law": "coulomb", "beta": values, "amplitude_mm": 1.0}
        calls[number], read = python_calls(lambda: config.from_document({"sweep": sweep}))  # noqa: B023
        assert read.sweep.case(number - 1) == Case("coulomb", 3.0, 1e-3)
        assert read.sweep.beta.tolist() == values
    assert calls[100_000] - calls[1000] <= 2 * 99_000


@pytest.mark.few(5)
@pytest.mark.parametrize("shape", [(1,), (63,), (64,), (65,), (2, 30, 30), (3, 160, 210)])
@pytest.mark.parametrize("method", ["radau", "event-driven"])
def test_every_case_is_in_one_chunk(shape, method):
    rows = Rows(shape)
    sizes = _sizes(rows, rows.without(np.zeros(0, int)), method, np.arange(np.prod(shape)))
    assert max(sizes) <= (CHUNK if method == "event-driven" else 1)
    assert max(sizes) - min(sizes) <= 1


def test_rows_of_a_continuation_hold_all_frequencies():
    rows, cases = Rows((2, 5, 3), along=1), np.arange(30).reshape(2, 5, 3)
    assert rows.cases(np.arange(rows.count)).tolist() == cases.swapaxes(1, 2).reshape(-1, 5).tolist()
    assert [rows.of(row).tolist() for row in rows.cases(np.arange(6))] == [[row] * 5 for row in range(6)]
    begun = np.append(rows.cases(np.array([1, 4])).ravel(), [0, 3])
    assert rows.complete(begun).tolist() == [1, 4]
    left = rows.without(rows.complete(begun))
    _sizes(rows, left, "event-driven", rows.cases(np.array([0, 2, 3, 5])).ravel())


def _sizes(rows, left, method, expected):
    chunks = [rows.cases(chunk).ravel() for chunk in rows.chunks(left, method)]
    assert sorted(np.concatenate(chunks).tolist()) == sorted(expected.tolist())
    return [len(chunk) for chunk in chunks]


def test_a_dataset_of_many_cases_is_summed_up_in_columns(tmp_path):
    sweep = Sweep(config.parse(MILLION.replace("= 1000 }", "= 300 }")), tmp_path / "x.nc")
    records = variables.blank(sweep.dtype, np.arange(sweep.count))
    records["status"], records["periodicity"], records["lift_off_fraction"] = 0, 0.0, 0.0
    records["status"][[5, 70_000]], records["message"][70_000] = 1, b"locks"
    records["periodicity"][:7] = 1.0
    coords = dataset.coordinates(sweep.config.case_coordinates(), sweep.sizes)
    dims = dict(zip(sweep.config.sweep.dims, sweep.config.sweep.shape, strict=True))
    ds = dataset.assemble(records, coords, dims, {}, labels.long_names(sweep.config))
    assert {str(each): count for each, count in outcomes.counts(ds).items()} == {"ok": 89_998, "locked": 2}
    assert (int(unsettled(ds).sum()), int(lifted(ds).sum())) == (6, 0)
    assert outcomes.failures(ds).tolist() == [5, 70_000]
    case = sweep.config.sweep.case(70_000)
    assert outcomes.described(ds, 70_000) == f"{formatting.case(*case, unit='m')}: locked: locks"
