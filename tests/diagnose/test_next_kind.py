"""The next test over all kinds: it separates explanations, and really does once it is made."""

import tomllib
from dataclasses import replace

import numpy as np
import pytest

from tests.diagnose import test_loops, test_transients
from tests.diagnose.answers import diagnosed
from tests.diagnose.synthetic import drawn, steady_test
from tests.diagnose.test_loops import CELLS, RATE
from wedgesweep import toml
from wedgesweep.config import parse
from wedgesweep.diagnose import verdict
from wedgesweep.diagnose.diagnosis import data_of
from wedgesweep.diagnose.fit_parameters import Hypothesis
from wedgesweep.diagnose.least_squares import minimise
from wedgesweep.diagnose.model import Fit, Model
from wedgesweep.diagnose.next_test.designs import offered
from wedgesweep.diagnose.next_test.recommend import SEPARATED, recommend
from wedgesweep.diagnose.next_test.transients import releases, sweeps
from wedgesweep.diagnose.search import Search
from wedgesweep.diagnose.stages import explain
from wedgesweep.effects import merge
from wedgesweep.measured import read
from wedgesweep.solvers import imposed_motion

# Free motion of a mass on a spring tells their ratio; how much dry friction takes is not known here.
SPRING_AND_MASS = test_transients.OSCILLATOR.replace("damping_N_s_per_m = 1.0\n", "")
FRICTION = {"friction_level": 0.3}
UNCERTAIN = "[measurement.uncertain]\nfriction_level = 0.3\n"
RIVALS = {"bolster_mass": {"scale": 1.2}, "bolster_stiffness": {"scale": 1.0 / 1.2}}
DAMPED = {"viscous_damping": {"coefficient_N_s_per_m": 2.0}}
RUBBED = {"friction_level": {"scale": 1.6}}


def explained(data, numbers, std=0.01):
    """A fit of some numbers (key units), each known to a relative standard deviation."""
    model = Model(data, Hypothesis(tuple(numbers)))
    x = model.hypothesis.at(numbers)
    evaluation = model.evaluate(model.start(None, x))
    return Fit(model, evaluation, np.diag((std * evaluation.point.x) ** 2), True)


def dropped(folder, model=test_transients.OSCILLATOR, starts=test_transients.STARTS, **more):
    return data_of(read(test_transients.write(folder, model, starts=starts, **more)))


def write_loop(folder, test, effects):
    """A loop as recommended, of a rig with some effects, with its noise and zero."""
    rng = np.random.default_rng(4)
    omega, size = 2.0 * np.pi * test["frequency_hz"], 1e-3 * test["amplitude_mm"]
    samples = round(test["duration_s"] * RATE)
    time = (np.arange(samples * CELLS) + 0.5) / RATE / CELLS
    motion = [size * omega**n * np.sin(omega * time + 0.5 * np.pi * n) for n in range(3)]
    config = parse((folder / "model.toml").read_text(), "model")
    record = config.record_with(merge(config.effects, effects), "coulomb", 0.0)
    force = imposed_motion.forces(record, *motion, 1.0 / RATE / CELLS)[0]
    mean = [each.reshape(samples, CELLS).mean(axis=1) for each in (motion[0], force)]
    noise = [1e-6 * rng.standard_normal(samples), 0.02 * rng.standard_normal(samples) + test_loops.ZERO]
    table = np.column_stack([np.arange(samples) / RATE, 1e3 * (mean[0] + noise[0]), mean[1] + noise[1]])
    np.savetxt(folder / "loop.csv", table, "%.10g", ",", header="t,x,F", comments="")


def released(folder, truth):
    """Releases of a rig; returns the path of measured.toml."""
    folder.mkdir()
    effects = {truth: RIVALS[truth]}
    path = test_transients.write(folder, SPRING_AND_MASS, effects)
    path.write_text(path.read_text().replace("[[measurement.test]]", UNCERTAIN + "[[measurement.test]]", 1))
    return path


@pytest.mark.acceptance
def test_a_loop_tells_mass_from_spring_where_no_free_motion_does(tmp_path):
    path = released(tmp_path / "first", "bolster_mass")
    found = diagnosed(path, list(RIVALS))
    test = found.document["next_test"]
    assert found.verdict == "tied"
    assert test["kind"] == "loop"
    assert test["distance"] >= SEPARATED
    for truth in RIVALS:
        path = released(tmp_path / truth, truth)
        write_loop(path.parent, test, {truth: RIVALS[truth]})
        force = '[measurement.columns]\nforce = { column = "F", unit = "N" }'
        text = path.read_text().replace("[measurement.columns]", force)
        path.write_text(text + '[[measurement.test]]\nfile = "loop.csv"\nkind = "loop"\n')
        found = explain(Search.of(data_of(read(path)), list(RIVALS)))
        finding = verdict.decide(found.base, found.explanations, verdict.DEFAULT)
        assert finding.cause.effects == (truth,)
        assert finding.rivals == ()


@pytest.mark.acceptance
def test_a_rig_that_drops_its_mass_is_asked_to_drop_it(tmp_path):
    """Near the place where it sticks friction and damping look alike, from farther up they do not."""
    data = dropped(tmp_path, starts=((2e-3, 0.0), (1.8e-3, 0.0)))
    test = recommend([explained(data, DAMPED), explained(data, RUBBED)])
    assert (test.kind, test.motion) == ("transient", "release")
    assert 0.3 <= test.numbers["start_mm"] / 2.0 <= 3.0
    assert test.closest.separated
    assert set(test.closest.names) == {*DAMPED, *RUBBED}


def test_a_distance_is_the_excess_that_a_fit_would_leave(tmp_path):
    """Of numbers that are known, where start and zero are not."""
    data, more = dropped(tmp_path), {"friction_level": {"scale": 1.605}}
    fits = [explained(data, each, std=1e-9) for each in (RUBBED, more)]
    for make in (releases, sweeps):
        design = make(fits[0], data.sensors())
        own = design.data.subset(np.array([3]))
        alone = design._replace(data=own, numbers=design.numbers[3:4], shape=(1, 1))
        distance = offered(alone, fits).distances.item()
        start = own.start()[0]
        truth = replace(fits[0].model, data=own).evaluate(replace(fits[0].point, nuisance=start))
        known = replace(fits[1].model, data=replace(own, resampled=truth.response)).holding(0, fits[1].x[0])
        fit = minimise(known, known.evaluate(replace(fits[1].point, nuisance=start)))
        assert distance > SEPARATED
        assert fit.chi2 == pytest.approx(distance, rel=0.05)


@pytest.mark.acceptance
def test_a_steady_measurement_may_be_told_another_kind():
    """Neither sines of the base nor free motions tell mass from spring; friction is uncertain here."""
    model = parse(SPRING_AND_MASS.replace("normal_force_N = 1.0", "normal_force_N = 0.05"), "model")
    data = replace(drawn(), model=model, law="coulomb", uncertain=FRICTION)
    fits = [explained(data, {name: each}, std=np.array([1e-3, 0.3])) for name, each in RIVALS.items()]
    steady = steady_test(fits)
    assert steady is None or not steady.closest.separated
    found = recommend(fits)
    assert found.kind == "loop"
    assert found.closest.separated
    easy = [explained(replace(data, uncertain={}), each) for each in (DAMPED, RUBBED)]
    assert recommend(easy).kind == "steady"


@pytest.mark.acceptance
def test_no_kind_tells_an_explanation_from_itself(tmp_path):
    data = dropped(tmp_path)
    assert recommend([explained(data, DAMPED)] * 2) is None
    assert recommend([explained(data, DAMPED)]) is None


@pytest.mark.acceptance
def test_a_heavier_rig_gets_the_same_advice(tmp_path):
    """Masses, springs and forces times 4,000 move alike."""
    found = []
    for factor in (1.0, 4000.0):
        folder = tmp_path / f"{factor:g}"
        folder.mkdir()
        document = tomllib.loads(test_loops.OSCILLATOR)
        document["oscillator"] = {key: value * factor for key, value in document["oscillator"].items()}
        data = data_of(read(test_loops.write(folder, toml.dumps(document), noise=(1e-6, 0.02 * factor))))
        numbers = {"viscous_damping": {"coefficient_N_s_per_m": 2.0 * factor}}
        found.append(recommend([explained(data, numbers), explained(data, RUBBED)]))
    light, heavy = found
    assert heavy.kind == light.kind == "loop"
    assert heavy.numbers == pytest.approx(light.numbers, rel=1e-6)
    assert heavy.closest.distance == pytest.approx(light.closest.distance, rel=0.02)


@pytest.mark.acceptance
@pytest.mark.parametrize("rival", ["preload", "fixture_resonance"])
def test_explanations_with_and_without_a_moving_side_frame_are_separated(tmp_path, rival):
    """The start of the side frame is fitted beside one of them only."""
    numbers = {
        "preload": {"force_N": 0.2},
        "fixture_resonance": {"frequency_hz": 60.0, "damping_ratio": 0.05},
    }
    starts = ((1e-3, 0.0), (-8e-4, 0.05))
    data = dropped(tmp_path, test_transients.WEDGE, starts, noise=1e-6, rate=1500.0, samples=600)
    fits = [explained(data, {"friction_level": {"scale": 1.1}}), explained(data, {rival: numbers[rival]})]
    found = recommend(fits)
    assert found is not None
    assert found.kind == "transient"
