"""Transients: free motions in time, from files to a verdict."""

import numpy as np
import pytest
from scipy.signal import lfilter

from tests.diagnose.answers import diagnosed, is_told
from tests.diagnose.rigs import HEAD, PLACE, TRANSIENT, oscillator, saved
from wedgesweep import api, excitation
from wedgesweep.config import parse
from wedgesweep.diagnose.least_squares import minimise
from wedgesweep.diagnose.search import Search, base_fit
from wedgesweep.diagnose.transient.from_measurement import MOST_WINDOWS, _spread, transient_data
from wedgesweep.effects import EFFECTS, merge
from wedgesweep.measured import MeasuredError, read
from wedgesweep.solvers import periodic
from wedgesweep.systems import state_count

OSCILLATOR = oscillator(
    sweep="beta = 1.0\namplitude_mm = 1.0\n",
    mass_kg=2.0,
    spring_N_per_mm=0.5,
    damping_N_s_per_m=1.0,
    normal_force_N=1.0,
)
WEDGE = '[sweep]\nfriction_law = "coulomb"\nbeta = [1.0]\namplitude_mm = [0.1]\n'
# Starts: displacement (m) and velocity (m/s). The zero of the sensor (m) is unknown.
STARTS = ((0.01, 0.0), (-0.006, 0.1), (0.02, 0.0))
ZERO = 1e-3


def free_motion(config, effects, start, rate, samples, rtol=1e-10):
    """Displacement (m) at even times, simulated four times as finely as it is sampled."""
    step, fine = 1.0 / rate, 4
    per_period = 16 * fine
    record = config.record_with(
        merge(config.effects, effects), config.case_list()[0].law, 1.0, 2.0 * np.pi / (16 * step)
    )
    excitation.set_no_motion(record, max(abs(start[0]), 1e-6))
    state = np.zeros((1, state_count()))
    state[0, :2] = np.array(start) * (1.0 if config.system == "oscillator" else -1.0)
    x = periodic.sampled(record, state, 0, -(-samples // 16), per_period, rtol).x[0]
    return -x[::fine][:samples]


def coloured(rng, size, pole):
    """Noise (size,) of unit variance, correlated by ``pole`` from one sample to the next."""
    return lfilter([(1.0 - pole**2) ** 0.5], [1.0, -pole], rng.standard_normal(size + 200))[200:]


def write(
    folder,
    model=OSCILLATOR,
    effects=None,
    starts=STARTS,
    noise=2e-5,
    rate=500.0,
    samples=600,
    seed=0,
    pole=0.0,
    repeats=1,
):
    """Files of releases from some starts; returns the path of measured.toml."""
    rng = np.random.default_rng(seed)
    tests = {}
    for i, start in enumerate(start for start in starts for _ in range(repeats)):
        varied = np.array(start) * (1.0 + 0.02 * (i % repeats))
        x = free_motion(parse(model, "model"), effects or {}, varied, rate, samples)
        x = x + ZERO * start[0] / starts[0][0] + noise * coloured(rng, x.size, pole)
        repeat = f'repeat_of = "drop{i - i % repeats}.csv"\n' if i % repeats else ""
        tests[f"drop{i}"] = (np.arange(samples) / rate, 1e3 * x), TRANSIENT + repeat
    return saved(folder, model, HEAD + PLACE, "t,x", tests)


def test_starts_and_zero_are_found_and_the_misfit_is_noise(tmp_path):
    data = transient_data(read(write(tmp_path)))
    fit = base_fit(Search.of(data, [])).base
    assert 0.75 < fit.chi2 / fit.dof < 1.05
    assert data.starts(fit.point) == pytest.approx(np.array(STARTS), abs=5e-4)
    assert data.zero(data.measured - fit.evaluation.response)[0] == pytest.approx(ZERO, abs=1e-5)


HIDDEN = {
    "friction_level": {"scale": 1.5},
    "viscous_damping": {"coefficient": 2.0},
    "stribeck": {"peak": 0.3, "velocity": 0.02},
    "cubic_stiffness": {"coefficient": 4e5},
    "presliding": {"length": 5e-4},
}


@pytest.mark.parametrize(
    ("effect", "candidates"),
    [
        ("friction_level", ["friction_level", "bolster_stiffness"]),
        pytest.param("presliding", [*HIDDEN], marks=pytest.mark.acceptance),
    ],
)
def test_a_hidden_effect_is_found(tmp_path, effect, candidates):
    found = diagnosed(write(tmp_path, effects={effect: HIDDEN[effect]}), candidates)
    assert found.gain["excess_removed"] > 0.95
    is_told(found, {effect: HIDDEN[effect]}, 0.02)


# Far enough from rest for wedges to lift off; the windows of a record of their own each.
LARGE = ((0.010, 0.0), (-0.008, 0.1), (0.012, -0.3))


@pytest.mark.acceptance
def test_a_side_frame_on_a_table_is_told_from_wedges_that_lift_off(tmp_path):
    fixture = {"frequency": 60.0, "damping_ratio": 0.05}
    path = write(tmp_path, WEDGE, {"fixture_resonance": fixture}, LARGE, noise=2e-5, rate=1000.0)
    found = diagnosed(path, ["lift_off", "fixture_resonance", "friction_level", "bolster_mass"])
    assert (found.verdict, [cause["effect"] for cause in found.causes]) == ("named", ["fixture_resonance"])
    for key, true in zip(("frequency_hz", "damping_ratio"), fixture.values(), strict=True):
        low, high = found.causes[0]["parameters"][key]["ci95"]
        assert low < true < high
        assert high - low < 0.05 * true


@pytest.mark.acceptance
@pytest.mark.parametrize(
    ("effect", "numbers", "places"),
    [
        ("fixture_resonance", {"frequency": 25.0, "damping_ratio": 0.01}, (2, 3)),
        ("column_compliance", {"stiffness": 5e3}, (0, 1)),
    ],
)
def test_the_start_of_a_body_that_moves_is_fitted(tmp_path, effect, numbers, places):
    """Each window begins while the side frame, or a column, moves."""
    path = write(tmp_path, WEDGE, {effect: numbers}, LARGE[:1], noise=1e-6, rate=1000.0, samples=1500)
    path.write_text(path.read_text() + "from_s = 0.1\n")
    data = transient_data(read(path))
    assert data.tests > 1
    model = Search.of(data, [effect]).model(effect)
    factors = {each.name: (each.key, each.factor) for each in EFFECTS[effect].quantities}
    known = {factors[name][0]: value / factors[name][1] for name, value in numbers.items()}
    fit = minimise(model, model.evaluate(model.start(None, model.hypothesis.at({effect: known}))))
    assert fit.dof == data.dof.sum() - 2 * data.tests - model.size
    assert fit.p > 1e-3
    moved = np.abs(fit.point.nuisance[:, -4:])
    assert (moved[:, places] > 1e-3).any(axis=1).all()
    assert not np.delete(moved, places, axis=1).any()


def test_a_motion_that_hardly_decays_is_a_free_motion(tmp_path):
    path = write(tmp_path)
    t = np.arange(5000) / 100.0
    for decay, refused in ((0.003, False), (0.0, True), (-0.003, True)):
        x = 10.0 * np.exp(-decay * t) * np.cos(10.0 * t) + 0.01 * np.random.default_rng(1).standard_normal(
            t.size
        )
        np.savetxt(tmp_path / "drop1.csv", np.column_stack([t, x]), "%.8g", ",", header="t,x", comments="")
        if refused:
            with pytest.raises(MeasuredError, match=r"drop1\.csv: the motion does not decay"):
                read(path)
        else:
            read(path)


def test_a_ring_down_that_is_taken_for_steady_is_told_what_it_is(tmp_path):
    path = write(tmp_path)
    path.write_text(path.read_text().replace('kind = "transient"', "frequency_hz = 2.5"))
    with pytest.raises(MeasuredError, match='write kind = "transient" if it is a ring-down'):
        read(path)


@pytest.mark.acceptance
def test_a_test_with_numbers_of_its_own_is_the_same_beside_others_and_alone(tmp_path):
    """A rig that is released empty and loaded."""
    loaded = parse(OSCILLATOR.replace("mass_kg = 2.0", "mass_kg = 8.0"), "model")
    rng, tests = np.random.default_rng(3), {}
    for name, config, more in (
        ("loaded", loaded, 'model = { "oscillator.mass_kg" = 8.0 }\n'),
        ("empty", parse(OSCILLATOR, "model"), ""),
    ):
        x = free_motion(config, {}, (0.02, 0.0), 500.0, 1500) + 2e-5 * rng.standard_normal(1500)
        tests[name] = (np.arange(1500) / 500.0, 1e3 * x), TRANSIENT + more
    measurement = read(saved(tmp_path, OSCILLATOR, HEAD + PLACE, "t,x", tests))
    data = transient_data(measurement)
    point = base_fit(Search.of(data, [])).base.point
    for test in range(data.tests):
        rows = np.array([test])
        alone = data.subset(rows).starts(point.subset(rows))
        np.testing.assert_allclose(alone, data.starts(point)[rows])
    found = api.diagnose_measurement(measurement, effects=["viscous_damping"])
    assert "mass_kg = 2.0" in found.extended_toml


def test_of_many_windows_forty_are_compared_but_of_each_record_one():
    for lengths in ([3], [30, 10], [300, 100, 1], [1] * 60):
        found = _spread([list(range(count)) for count in lengths])
        assert abs(len(found) - max(min(sum(lengths), MOST_WINDOWS), len(lengths))) <= 1  # shares are rounded
        assert found.count(0) == len(lengths)
