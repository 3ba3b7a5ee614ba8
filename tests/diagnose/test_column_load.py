"""The load of a column as a channel: what it is, and that it tells preload from friction."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from tests.command import invoke
from tests.diagnose.synthetic import searched
from wedgesweep import config, diagnosis_result, figures, measured
from wedgesweep.diagnose.steady import column_load, simulation
from wedgesweep.diagnose.steady.from_measurement import harmonic_data
from wedgesweep.diagnose.steady.harmonic_data import stated
from wedgesweep.solvers.periodic import at_rest

UPRIGHT = """
[suspension]
column_angle_deg = 0.0
wedge_preload_N = 4.0
[sweep]
friction_law = "static-dynamic"
beta = 1.0
amplitude_mm = 1.0
"""


def test_friction_under_the_load_takes_the_energy_that_the_input_gives():
    model, omega, amplitude = config.parse(UPRIGHT), 2.0 * pi * 20.0, 3e-4
    rows = simulation.records(model, "static-dynamic", {}, np.array([omega]), np.array([amplitude]))
    found = simulation.respond(rows, at_rest(1), 127, 1e-9, load=True).harmonics[0]
    phase = 2.0 * pi * np.arange(2**14) / 2**14
    turn = np.exp(1j * np.outer(np.arange(1, 128), phase))
    load = (found[2, :-1] @ turn).real + found[2, -1].real
    slip = -(1j * omega * np.arange(1, 128) * found[0, :-1] @ turn).real  # of the upright column: z'
    suspension, friction = rows["suspension"][0], rows["friction"][0]
    small = np.abs(slip) < friction["v_t"]
    mu = np.where(small, friction["mu_s"] * slip / friction["v_t"], friction["mu_d"] * np.sign(slip))
    moved = suspension["bolster_mass"] + 2.0 * suspension["wedge_mass"]
    given = np.mean(moved * amplitude * omega**2 * np.sin(phase) * slip)
    assert np.mean(2.0 * mu * load * slip) == pytest.approx(given, rel=2e-3)
    assert load.min() > 0.0


@pytest.mark.parametrize("place", np.linspace(0.1, 1.9, 7) / 1024)
def test_a_jump_has_the_harmonics_of_a_step_wherever_it_falls_between_samples(place):
    count, order = column_load.SAMPLES_PER_PERIOD, np.arange(1, 17)
    share = np.arange(count) / count
    up = (share - place) % 1.0 < 0.5
    velocity = np.zeros((1, 2, 127), complex)
    velocity[0, 0, 0] = -np.exp(-2j * pi * place)  # its rate goes through zero upward at the place
    rows = np.zeros(1, [("friction", [("set_valued", "i8")])])
    rows["friction"]["set_valued"] = 1
    found = column_load.joined(rows, velocity, np.where(up, 3.0, 1.0)[None])[0, 2]
    step = 4.0 / (1j * pi * order) * (order % 2) * np.exp(-2j * pi * order * place)
    np.testing.assert_allclose(found[:16], step, atol=2e-4)
    assert found[-1] == pytest.approx(2.0, abs=1e-12)


PRELOADED = """
[effects.preload]
force_N = 0.05
[sweep]
friction_law = "coulomb"
beta = 1.0
amplitude_mm = 1.0
"""
TESTS = "".join(
    f"[[test]]\nfrequency_hz = {frequency}\namplitude_mm = {amplitude}\n"
    for frequency, amplitude in ((20.3, 0.068), (22.9, 0.056), (28.9, 0.051), (32.3, 0.038))
)


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    """A measurement of a bench with a preload that its model lacks, and with the load of its column."""
    folder = tmp_path_factory.mktemp("loaded")
    (folder / "true.toml").write_text(PRELOADED)
    (folder / "tests.toml").write_text(TESTS)
    options = ("--tests", folder / "tests.toml", "--normal-force", 0.005, "--n-jobs", 1)
    invoke("synthesize", "--n-jobs", 1, folder / "true.toml", *options, "-o", folder / "made")
    return folder / "made" / "measured.toml"


def test_the_zero_of_the_load_cell_only_counts_as_far_as_it_is_known(place):
    data = harmonic_data(measured.read(place))
    here = data.compare([stated(data)], 1e-6)[0].residual
    off = [each._replace(mean=np.append(each.mean[:-1], each.mean[-1] + 0.05)) for each in data.loads]
    there = replace(data, loads=tuple(off)).compare([stated(data)], 1e-6)[0].residual
    change = (there - here)[np.abs(there - here) > 1e-6]
    assert change == pytest.approx(np.full(4, 0.05 / 0.005), rel=0.1)


def test_a_load_of_the_other_sign_and_channels_that_do_not_go_with_it_are_refused(place):
    text = place.read_text()
    other = place.with_name("other.toml")
    other.write_text(text.replace('unit = "N"', 'unit = "N"\nsign = -1'))
    assert "write sign = -1 in measurement.columns" in invoke("check", other, code=2)
    other.write_text(text.replace("zero_std = 0.005\n", ""))
    assert "measurement.columns.normal_force.zero_std: missing" in invoke("check", other, code=2)
    recorded = '[measurement.columns.input]\ncolumn = "d"\nunit = "mm"\nquantity = "displacement"\n'
    other.write_text(text + recorded)
    assert "normal_force: it is not compared beside a recorded input" in invoke("check", other, code=2)
    assert " N (" in invoke("check", place)


def test_a_test_in_which_the_base_model_sticks_has_no_load_to_compare(place):
    measurement = measured.read(place)
    first = measurement.tests[0]
    quiet = replace(first, amplitude=0.7 * first.amplitude)
    data = harmonic_data(replace(measurement, tests=(quiet, *measurement.tests[1:])))
    assert [each is None for each in data.loads] == [True, False, False, False]
    assert data.observations.tolist() == [64, 97, 97, 97]
    assert np.isfinite(data.compare([stated(data)], 1e-6)[0].residual).all()


# Preload (N) and friction levels that motion alone confuses: they change friction by a few per cent.
HIDDEN = [("static-dynamic", "friction_level", "scale", 1.04), ("exponential", "preload", "force_N", -0.04)]


@pytest.mark.acceptance
@pytest.mark.parametrize(("law", "effect", "key", "size"), HIDDEN)
def test_the_load_tells_what_the_motion_leaves_tied(tmp_path, law, effect, key, size):
    true = f"[effects.{effect}]\n{key} = {size}\n" + PRELOADED.partition("force_N = 0.05\n")[2]
    (tmp_path / "true.toml").write_text(true.replace("coulomb", law))
    (tmp_path / "tests.toml").write_text(TESTS)
    options = ("--tests", tmp_path / "tests.toml", "--normal-force", 0.005, "--n-jobs", 1)
    invoke("synthesize", tmp_path / "true.toml", *options, "-o", tmp_path / "made")
    data = harmonic_data(measured.read(tmp_path / "made" / "measured.toml"))
    # A rival is within GAP = 10 of the best explanation.
    assert _ahead(data, effect) > 10.0
    assert abs(_ahead(replace(data, loads=()), effect)) < 10.0


def _ahead(data, effect):
    """By how much chi-squared of the other one of preload and friction level is larger than of an effect."""
    _, _, (preload, friction) = searched(data, "preload", "friction_level")
    ahead = friction.chi2 - preload.chi2
    return ahead if effect == "preload" else -ahead


@pytest.mark.acceptance
def test_a_diagnosis_names_the_preload_and_draws_the_load(place):
    candidates = ("--effects", "preload,friction_level,guide_friction,bolster_mass")
    told = invoke("diagnose", place, "-o", place.parent / "found", "--n-jobs", 1, *candidates)
    assert "(preload; force 0.05" in told
    result = diagnosis_result.read(place.parent / "found")
    test = result.document["misfit"]["tests"][0]
    assert test["mean_normal_force_fitted_N"] == pytest.approx(test["mean_normal_force_N"], abs=0.02)
    figures.draw(result, "column-load").draw_without_rendering()
    page = (place.parent / "found" / "report.html").read_text()
    assert "Normal force of a wedge on its column" in page
    assert "fitted mean load [N]" in page
