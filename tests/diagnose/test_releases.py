"""Long releases of a mass that rubs: fits find what the closed form was made of, from far off."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import stdtrit

from tests.diagnose.rigs import HEAD, PLACE, TRANSIENT, oscillator, saved
from wedgesweep.diagnose import verdict
from wedgesweep.diagnose.cross_validation import Predictor, widened
from wedgesweep.diagnose.explanation import ADEQUATE
from wedgesweep.diagnose.least_squares import minimise, of_beginnings
from wedgesweep.diagnose.noise_spectrum import FROM_RESIDUAL
from wedgesweep.diagnose.pairs import simpler
from wedgesweep.diagnose.result import estimates
from wedgesweep.diagnose.search import Search, base_fit, single_fits
from wedgesweep.diagnose.stages import explain
from wedgesweep.diagnose.transient.from_measurement import transient_data
from wedgesweep.measured import read


def released(time, mass, spring, damping, friction, start):
    """Displacement (m) at times (s) after a release at rest, each half swing in closed form."""
    found, begins, rate = np.full(time.size, np.nan), 0.0, damping / (2.0 * mass)
    omega = np.sqrt(spring / mass - rate**2)
    while abs(spring * start) > friction and begins <= time[-1]:
        centre = np.sign(start) * friction / spring
        here, since = time >= begins, time[time >= begins] - begins
        swing = np.cos(omega * since) + rate / omega * np.sin(omega * since)
        found[here] = centre + (start - centre) * np.exp(-rate * since) * swing
        begins += np.pi / omega
        start = centre - (start - centre) * np.exp(-rate * np.pi / omega)
    found[time >= begins] = start
    return found


def data_of(folder, seed, known_damping):
    """Four releases of a random rig, whose model has its damper or none, and no friction; its numbers."""
    rng = np.random.default_rng(seed)
    mass, frequency, size = 10 ** rng.uniform([-0.5, -0.3, -2.3], [1.5, 0.9, -1.0])
    spring = mass * (2.0 * np.pi * frequency) ** 2
    damping = 2.0 * rng.uniform(0.01, 0.05) * np.sqrt(spring * mass)
    friction = spring * size * rng.uniform(0.01, 0.05)
    records = []
    for _ in range(4):
        start = size * rng.uniform(0.4, 1.0) * rng.choice([-1, 1])
        time = np.arange(rng.uniform(400, 600)) / (40.0 * frequency)
        x = released(time, mass, spring, damping, friction, start)
        records.append((time, x + 0.004 * size * rng.standard_normal(time.size)))
    return data_from(folder, mass, spring, damping if known_damping else 0.0, records), friction, damping


def data_from(folder, mass, spring, damping, records):
    """Records of time (s) and displacement (m) of a mass on a spring with a damper, as data of a fit."""
    tests = {f"release{i}": ((time, 1e3 * x), TRANSIENT) for i, (time, x) in enumerate(records)}
    keys = {"mass_kg": mass, "spring_N_per_mm": 1e-3 * spring, "normal_force_N": 0.0, "contact": "base"}
    model = oscillator(**keys, damping_N_s_per_m=damping)
    head = HEAD + PLACE + "[measurement.uncertain]\nbolster_stiffness = 0.02\n"
    return transient_data(read(saved(folder, model, head, "t,x", tests)))


@pytest.mark.few(1)
@pytest.mark.parametrize("seed", range(8))
def test_dry_friction_is_found(tmp_path, seed):
    data, friction, _ = data_of(tmp_path, seed, known_damping=True)
    (fit,) = single_fits(base_fit(Search.of(data, ["guide_friction"]))).explanations
    assert fit.chi2 < 1.1 * fit.dof
    assert fit.values["guide_friction"]["force_N"] == pytest.approx(friction, rel=0.02)


@pytest.mark.acceptance
@pytest.mark.parametrize("seed", range(8))
def test_dry_friction_and_a_damper_are_found_together(tmp_path, seed):
    data, friction, damping = data_of(tmp_path, seed, known_damping=False)
    best = explain(Search.of(data, ["guide_friction", "viscous_damping"])).explanations[0]
    assert best.chi2 < 1.1 * best.dof
    assert best.values["guide_friction"]["force_N"] == pytest.approx(friction, rel=0.05)
    assert best.values["viscous_damping"]["coefficient_N_s_per_m"] == pytest.approx(damping, rel=0.1)


def test_a_special_case_takes_the_place_of_an_effect_that_does_nothing_beyond_it(tmp_path):
    data, friction, damping = data_of(tmp_path, 3, known_damping=False)
    search = Search.of(data, ["guide_friction", "viscous_damping", "directional_damping"])
    model = search.model("guide_friction", "directional_damping")
    rubs, damps = {"force_N": friction}, {"coefficient_N_s_per_m": damping}
    numbers = {"guide_friction": rubs, "directional_damping": {**damps, "asymmetry": 0.05}}
    start = model.start(None, model.hypothesis.at(numbers))
    pair = minimise(model, model.evaluate(start))
    found = {frozenset(each.effects): each for each in simpler(search, pair)}
    best = found[frozenset(("guide_friction", "viscous_damping"))]
    assert best.chi2 < 1.1 * best.dof
    assert best.values["viscous_damping"]["coefficient_N_s_per_m"] == pytest.approx(damping, rel=0.1)
    assert found[frozenset(("guide_friction",))].chi2 > 10.0 * best.chi2


def test_a_beginning_is_the_first_part_of_each_test(tmp_path):
    data, _, _ = data_of(tmp_path, 0, known_damping=False)
    model = base_fit(Search.of(data, [])).base.model
    begun, point = of_beginnings(model, 0.3), model.start(None, np.zeros(0))
    for whole, part in zip(data.windows, begun.data.windows, strict=True):
        size = part.channels.shape[1]
        assert size == pytest.approx(0.3 * whole.channels.shape[1], abs=1)
        np.testing.assert_array_equal(part.channels, whole.channels[:, :size])
    motions = [each.data.simulated([each.scenario(point)])[0] for each in (model, begun)]
    for t, (own, beginning) in enumerate(zip(data.windows, begun.data.windows, strict=True)):
        whole, part = (
            window.in_time(motion[t, None, : window.coefficients])[0]
            for window, motion in zip((own, beginning), motions, strict=True)
        )
        # A cut spectrum rings at the ends of what it is of.
        inside = slice(part.size // 10, -(part.size // 10))
        assert part[inside] == pytest.approx(whole[: part.size][inside], abs=0.02 * np.ptp(whole))


MASS, SPRING, SIZE = 2.0, 79.0, 0.02  # about 1 Hz


def rubbing(folder, seed, damping_ratio, known_damping, samples, noise):
    """Four releases of a mass that rubs, with white noise over the release; the data and its friction (N)."""
    rng, friction = np.random.default_rng(seed), 0.05 * SPRING * SIZE
    damping = 2.0 * damping_ratio * np.sqrt(SPRING * MASS)
    time, records = np.arange(12 * samples) / samples, []
    for start in SIZE * np.array([1.0, -0.85, 0.7, -0.55]):
        x = released(time, MASS, SPRING, damping, friction, start)
        records.append((time, x + noise * SIZE * rng.standard_normal(time.size)))
    return data_from(folder, MASS, SPRING, damping if known_damping else 0.0, records), friction


@pytest.mark.few(1)
@pytest.mark.parametrize(("seed", "samples"), [(0, 35), (6, 58), (11, 45)])
def test_skirts_of_a_motion_are_no_noise_once_it_is_explained(tmp_path, seed, samples):
    data, _ = rubbing(tmp_path, seed, 0.015, True, samples, 0.0012)
    fit = single_fits(base_fit(Search.of(data, ["guide_friction"]))).explanations[0]
    renewed = data.renewed(fit.model.scenario(fit.point))

    def told(windows):
        """Largest noise about the motion's first harmonics, over that which is there."""
        low = [each.noise[0][each.noise[0].size // 20 : each.noise[0].size // 3] for each in windows]
        return np.array([each.max() for each in low]) / (0.0012 * SIZE)

    assert told(data.windows).max() > 2.0
    assert told(renewed.windows) == pytest.approx(1.1, abs=0.25)
    assert {each.spectra[0].source for each in renewed.windows} == {FROM_RESIDUAL}


@pytest.mark.few(1)
@pytest.mark.parametrize("damping_ratio", [0.01, 0.0])
def test_a_second_effect_is_looked_for_beside_an_adequate_one(tmp_path, damping_ratio):
    """Friction that is too large makes up for a damper to within the noise; a score test sees it."""
    data, friction = rubbing(tmp_path, 1, damping_ratio, False, 40, 0.03)
    known = explain(Search.of(data, ["guide_friction", "viscous_damping", "cubic_stiffness"]))
    alone = next(each for each in known.explanations if each.effects == ("guide_friction",))
    best = verdict.ranked(known.explanations)[0]
    assert alone.p_value > ADEQUATE
    assert best.values["guide_friction"]["force_N"] == pytest.approx(friction, rel=0.06)
    assert set(best.effects) == {"guide_friction", *(["viscous_damping"] if damping_ratio else [])}


def test_intervals_are_as_wide_as_numbers_differ_between_tests(tmp_path):
    """The friction is another one in each release; that of all is known to about half of their scatter."""
    frictions, time = 0.05 * SPRING * SIZE * np.array([0.8, 0.95, 1.1, 1.15]), np.arange(400) / 40.0
    noise = np.random.default_rng(0).standard_normal((4, 400))
    records = [
        (time, released(time, MASS, SPRING, 0.1, each, SIZE) + 1e-3 * SIZE * own)
        for each, own in zip(frictions, noise, strict=True)
    ]
    data = data_from(tmp_path, MASS, SPRING, 0.1, records)
    fit = single_fits(base_fit(Search.of(data, ["guide_friction"]))).explanations[0]
    wide, known = (
        estimates.parameters(each)["guide_friction"]["force_N"]["ci95"]
        for each in (widened(fit, Predictor(lambda function, items: list(map(function, items)))), fit)
    )
    error = stdtrit(3, 0.975) * frictions.std(ddof=1) / 2.0
    assert 0.3 * error < 0.5 * np.ptp(wide) < 1.5 * error
    assert np.ptp(known) < 0.1 * np.ptp(wide)
    assert wide[0] < frictions.mean() < wide[1]


@pytest.mark.acceptance
def test_a_pair_is_fitted_from_either_of_its_effects(tmp_path):
    """Friction by itself takes the place of the damper, and leads to another number of swings."""
    mass, spring, size, friction = 11.063, 4476.9, 0.04187, 11.229
    rng, critical, records = np.random.default_rng(2), 2.0 * np.sqrt(spring * mass), []
    for start, count in ((0.76, 1006), (0.994, 1133), (-0.523, 793), (0.558, 796)):
        time = np.arange(count) / (76.0 * np.sqrt(spring / mass) / (2.0 * np.pi))
        x = released(time, mass, spring, 0.0445 * critical, friction, start * size)
        records.append((time, x + 0.0074 * size * rng.standard_normal(count)))
    data = data_from(tmp_path, mass, 1.0305 * spring, 0.02 * critical, records)
    search = Search.of(data, ["guide_friction", "viscous_damping"])
    without, best = (
        explain(replace(search, without=frozenset(left_out))).explanations[0]
        for left_out in (["either first"], [])
    )
    assert best.chi2 < 1.1 * best.dof < without.chi2
    assert best.values["guide_friction"]["force_N"] == pytest.approx(friction, rel=0.01)
