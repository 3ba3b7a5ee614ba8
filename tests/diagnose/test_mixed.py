"""Tests of several kinds in one measurement: one model, one verdict."""

import numpy as np
import pytest

from tests.command import invoke
from tests.diagnose import test_loops, test_transients
from tests.diagnose.rigs import FORCE, HEAD, LOOP, PLACE, TEST, TRANSIENT
from wedgesweep import diagnosis_result
from wedgesweep.config import parse
from wedgesweep.diagnose.cross_validation import local_numbers
from wedgesweep.diagnose.diagnosis import data_of
from wedgesweep.diagnose.jacobian import jacobian
from wedgesweep.diagnose.search import Search, base_fit
from wedgesweep.diagnose.steady import simulation
from wedgesweep.measured import MeasuredError, read
from wedgesweep.solvers.periodic import at_rest

MODEL = test_transients.OSCILLATOR
HIDDEN = {"viscous_damping": {"coefficient": 2.0}}


def write(folder, effects=None):
    """Two releases and a loop of one rig; returns the path of measured.toml."""
    test_transients.write(folder, MODEL, effects, test_transients.STARTS[:2])
    test_loops.write(folder, MODEL, effects, motions=((0.01, 1.1, 8.0),))
    kinds = {"drop0": TRANSIENT, "loop0": LOOP, "drop1": TRANSIENT}
    tests = "".join(TEST.format(name) + kind for name, kind in kinds.items())
    (folder / "measured.toml").write_text(HEAD + PLACE + FORCE + tests)
    return folder / "measured.toml"


def test_each_kind_sees_its_own_channels(tmp_path):
    measurement = read(write(tmp_path))
    assert measurement.kind == "mixed"
    assert [test.force is None for test in measurement.tests] == [True, False, True]
    assert set(measurement.of_kind("transient").columns) == {"time", "displacement"}


def test_subsets_and_derivatives_are_those_of_each_kind(tmp_path):
    data = data_of(read(write(tmp_path)))
    fit = base_fit(Search.of(data, [])).base
    releases, loops = data.parts
    assert fit.chi2 == pytest.approx(sum(each.chi2 for each in data.fits(fit)))
    rows = np.array([1, data.tests - 1])
    part = data.subset(rows)
    assert part.names == (releases.names[1], loops.names[-1])
    again = fit.point.subset(rows)
    assert np.array_equal(again.nuisance, fit.point.nuisance[rows])
    # A kind of which no test is left does not shift the nuisance parameters of another.
    alone = data.subset(rows[1:])
    point = fit.point.subset(rows[1:])
    model = Search.of(alone, []).model()
    assert model.evaluate(point).chi2 == pytest.approx(fit.evaluation.chi2_by_test[-1], rel=1e-6)
    columns = jacobian(fit.model, fit.evaluation).by_nuisance
    # After the zero of each sensor: the start of a release, then the zero of a loop's displacement.
    assert (columns[: releases.tests, :, 1:3] != 0.0).any(axis=1).all()
    assert (columns[releases.tests :, :, 3] != 0.0).any(axis=1).all()
    assert not columns[: releases.tests, :, 3].any()
    assert not columns[releases.tests :, :, 1:3].any()


@pytest.mark.acceptance
def test_a_cause_is_named_over_all_kinds(tmp_path):
    path, out = write(tmp_path, HIDDEN), tmp_path / "out"
    invoke("diagnose", path, "-o", out, "--effects", "viscous_damping,friction_level")
    found = diagnosis_result.read(out)
    assert found.document["kind"] == "mixed"
    assert (found.verdict, [each["effect"] for each in found.causes]) == ("named", ["viscous_damping"])
    value = found.causes[0]["parameters"]["coefficient_N_s_per_m"]["value"]
    assert value == pytest.approx(2.0, rel=0.02)
    assert found.document["gain"]["scheme"] == "leave-one-record-out and leave-one-block-out"
    assert {each["kind"] for each in found.document["misfit"]["tests"]} == {"transient", "loop"}
    assert {"loops.png", "decays.png"} <= {each.name for each in out.iterdir()}
    assert "No figure" not in (out / "report.html").read_text()
    assert "natural" in invoke("check", path)


def test_gains_of_inputs_belong_to_the_tests_that_have_one(tmp_path):
    """Steady tests share a gain, each transient has its own, and a release has none."""
    write(tmp_path)
    config = parse(MODEL, "model")
    time = np.arange(4000) / 500.0
    base, turns = 4e-3, 2.0 * np.pi * 2.0 * time
    omega = np.array([2.0 * np.pi * 2.0])
    rows = simulation.records(config, "coulomb", {}, omega, np.array([base]))
    found = simulation.respond(rows, at_rest(1), 8).harmonics[0, 0]
    moved = (np.exp(1j * np.outer(turns, np.arange(1, 9))) @ found).real
    rng = np.random.default_rng(4)
    table = [time, 1e3 * moved + 0.02 * rng.standard_normal(time.size), 1e3 * base * np.sin(turns)]
    np.savetxt(tmp_path / "sine.csv", np.array(table).T, "%.12g", ",", header="t,x,u", comments="")
    text = (HEAD + PLACE + FORCE).replace("[measurement]\n", "[measurement]\ninput_gain_std = 0.02\n", 1)
    text += 'input = { column = "u", unit = "mm", quantity = "displacement" }\n'
    kinds = {"sine": "", "drop0": f"{TRANSIENT}undriven = true\n", "loop0": LOOP}
    text += "".join(TEST.format(name) + kind for name, kind in kinds.items())
    (tmp_path / "measured.toml").write_text(text)
    data = data_of(read(tmp_path / "measured.toml"))
    assert all("input_gain" in part.uncertain for part in data.parts)
    fit = base_fit(Search.of(data, [])).base
    for test in range(data.tests):
        alone = Search.of(data.subset(np.array([test])), []).model()
        found = alone.evaluate(fit.point.subset(np.array([test]))).chi2
        assert found - fit.evaluation.chi2_by_test[test] < 5.0
    assert data.input_gain_std == 0.02
    # Nothing is fitted to a steady test alone; a release and blocks of a loop have zeros of their sensors.
    local = dict(zip(data.names, local_numbers(fit), strict=True))
    assert local.pop("sine") == pytest.approx(0.0, abs=1e-3)
    assert min(local.values()) >= 1.0


@pytest.mark.acceptance
def test_the_start_of_a_frame_has_columns_of_its_own_beside_steady_tests(tmp_path):
    """Steady tests have a column for the phase of a tone, which none of them has here."""
    model = test_transients.WEDGE
    fixture = {"fixture_resonance": {"frequency": 25.0, "damping_ratio": 0.01}}
    test_transients.write(tmp_path, model, fixture, ((8e-3, 0.0),), noise=1e-6, rate=1000.0, samples=600)
    time = np.arange(1000) / 500.0
    table = np.column_stack([time, 0.5 * np.sin(2.0 * np.pi * 10.0 * time)])
    np.savetxt(tmp_path / "sine.csv", table, "%.12g", ",", header="t,x", comments="")
    text = HEAD + PLACE + '[[measurement.test]]\nfile = "sine.csv"\nfrequency_hz = 10.0\n'
    (tmp_path / "measured.toml").write_text(text + TEST.format("drop0") + TRANSIENT)
    data = data_of(read(tmp_path / "measured.toml"))
    model = Search.of(data, []).model("fixture_resonance")
    start = model.start(
        None, model.hypothesis.at({"fixture_resonance": {"frequency_hz": 25.0, "damping_ratio": 0.01}})
    )
    here = model.evaluate(start)
    columns = jacobian(model, here).by_nuisance[..., data.eliminated :]
    # Amplitude of the steady test, starts of the release, of column and frame.
    steady, *windows = (columns != 0.0).any(axis=1).tolist()
    assert steady == [True] + 6 * [False]
    assert windows == [[False, True, True, False, False, True, True]] * 3
    assert data.extra_nuisances(("fixture_resonance",)).tolist() == [0, 2, 2, 2]
    assert len(data.nuisances(())) == 3


def test_a_channel_that_one_of_the_kinds_needs_is_missing(tmp_path):
    path = write(tmp_path)
    path.write_text(path.read_text().replace('force = { column = "F", unit = "N" }\n', ""))
    with pytest.raises(MeasuredError, match="force: missing"):
        read(path)
