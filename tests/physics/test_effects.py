"""Effects: neutral values, limits, energy, symmetry; over all of them where possible."""

from math import inf, pi

import numpy as np
import pytest
from hypothesis import given, settings, strategies
from numpy.lib.recfunctions import structured_to_unstructured

from tests.physics.cases import OMEGA_N
from tests.physics.effect_cases import EXTENDING, NOT_PERIODIC, OF_SUSPENSION, REPEATING, mild, typical
from wedgesweep import config, response, systems
from wedgesweep.effects import EFFECTS, FAMILIES, acting, go_together, merge
from wedgesweep.friction import LAW_NAMES
from wedgesweep.solvers import event_driven, periodic, radau
from wedgesweep.solvers.trajectory import CaseError, Window
from wedgesweep.systems.suspension import parameters
from wedgesweep.systems.suspension.rest import breakaway_accelerations

LAWS = ("coulomb", "static-dynamic", "exponential")
# A number whose default follows from the model.
FOLLOWS = 2.0
SELF_LOCKING = {
    "suspension": {"column_angle": np.radians(-4.0)},
    "friction": {"dynamic": 0.9, "static": 0.9},
}


def numbers(record, settle_periods=60, rtol=1e-8, periods=2):
    window = Window(float(record["input"]["omega"][0]), settle_periods, periods, 256)
    run = event_driven.solve(record, window, rtol, inf)
    return response.evaluate(run, record, 9).numbers


def with_effect(law, name, values=None, amplitude=0.8e-3, beta=0.6, **more):
    values = mild(name) if values is None else values
    return parameters.record(law, amplitude, beta * OMEGA_N, effects={name: values}, **more)


def test_the_declared_order_is_that_of_the_families():
    families = [effect.family for effect in EFFECTS.values()]
    assert families == sorted(families, key=FAMILIES.index)
    assert FAMILIES == (
        "parameters",
        "friction-law",
        "two-dimensional",
        "contact",
        "missing-force",
        "excitation",
        "sensor",
    )
    assert len(EFFECTS) == 38


@pytest.mark.parametrize("name", [name for name in OF_SUSPENSION if EFFECTS[name].searched])
def test_a_config_switches_it_on_and_its_range_is_allowed(name):
    values = {
        quantity.key: (quantity.search or (quantity.default or FOLLOWS,))[-1]
        for quantity in EFFECTS[name].quantities
    }
    lines = "\n".join(f"{key} = {value}" for key, value in values.items())
    text = f'[effects.{name}]\n{lines}\n[sweep]\nfriction_law = "coulomb"\nbeta = 1\namplitude_mm = 1\n'
    read = config.parse(text)
    record = read.record(read.case_list()[0])
    numbers = {each.name: values[each.key] * each.factor for each in EFFECTS[name].quantities}
    expected = parameters.record("coulomb", 1e-3, read.sweep.omega_n, effects={name: numbers})
    np.testing.assert_allclose(structured_to_unstructured(record), structured_to_unstructured(expected))
    for quantity in EFFECTS[name].quantities:
        if name in record.dtype.names:
            assert record[name][quantity.name][0] == pytest.approx(numbers[quantity.name])
        if quantity.search:
            assert quantity.fault(quantity.search[0]) is None
    assert read.sweep.omega_n == pytest.approx(OMEGA_N)
    assert record["input"]["omega"][0] == pytest.approx(OMEGA_N)
    assert systems.has_own_mechanics(record)[0] == bool(EFFECTS[name].extends)


@pytest.mark.parametrize("name", OF_SUSPENSION)
@pytest.mark.parametrize("law", LAWS)
def test_neutral_is_the_base_model_bit_for_bit(law, name):
    effect = EFFECTS[name]
    values = typical(name)
    for quantity in effect.quantities:
        if quantity.name in effect.extends or not effect.extends:
            values[quantity.name] = quantity.neutral * quantity.factor
    if name == "stribeck":
        values["peak"] = 0.0
    base = numbers(parameters.record(law, 1e-4, 1.472 * OMEGA_N), 3)
    assert numbers(with_effect(law, name, values, 1e-4, 1.472), 3) == pytest.approx(base, abs=0.0, rel=0.0)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize(("beta", "amplitude"), [(0.4, 1e-3), (1.472, 5e-5), (0.9, 3e-3)])
def test_steps_agree_with_the_closed_forms_of_the_base_model(law, beta, amplitude):
    base = parameters.record(law, amplitude, beta * OMEGA_N)
    record = base.copy()
    record["geometry"]["kit"] = parameters.ALL
    expected, found = numbers(base, 10), numbers(record, 10)
    for name in (
        "amplitude_ratio",
        "stick_fraction",
        "dissipated_energy",
        "supplied_energy",
        "lift_off_fraction",
    ):
        assert found[name] == pytest.approx(expected[name], rel=1e-5, abs=1e-9), name


# Against the end stops this response repeats after two periods, both of which are kept.
DOUBLED = ("exponential", "end_stop")


@pytest.mark.parametrize("name", REPEATING)
@pytest.mark.parametrize("law", LAWS)
def test_energy_balance_with_every_effect(law, name):
    found = numbers(with_effect(law, name), 80)
    if (law, name) != DOUBLED:
        assert found["periodicity"] < 1e-6
    assert found["dissipated_energy"] > 0.0
    assert found["supplied_energy"] == pytest.approx(found["dissipated_energy"], rel=2e-6)


@pytest.mark.parametrize("name", EXTENDING)
def test_it_changes_the_response(name):
    law, amplitude = "static-dynamic", 0.8e-3
    if name == "jamming":
        # Regularised laws have no rest, and at 0.8 mm the bolster rests only below its equilibrium and leaves
        # upward: there the band of rest ends at the least sticking, and nothing can be locked in.
        law, amplitude = "coulomb", 0.4e-3
    base = numbers(parameters.record(law, amplitude, 0.6 * OMEGA_N), 20)
    found = numbers(with_effect(law, name, amplitude=amplitude), 20)
    assert abs(found["amplitude_ratio"] / base["amplitude_ratio"] - 1.0) > 1e-4


def distance(law, name, values, beta=0.6, amplitude=0.8e-3):
    """Relative change of the ratio that an effect makes."""
    record = with_effect(law, name, values, amplitude, beta)
    base = parameters.record(law, amplitude, beta * OMEGA_N)
    return abs(numbers(record, 30)["amplitude_ratio"] / numbers(base, 30)["amplitude_ratio"] - 1.0)


@pytest.mark.parametrize(
    ("name", "field", "far", "near", "order"),
    [
        ("column_compliance", "stiffness", 2e5, 2e6, 10.0),
        ("fixture_resonance", "frequency", 100.0, 400.0, 16.0),
        ("stribeck", "velocity", 1e-4, 1e-5, 10.0),
        ("cross_slip", "velocity", 1e-4, 1e-5, 100.0),
        ("viscous_damping", "coefficient", 1.0, 0.1, 10.0),
        ("directional_damping", "coefficient", 1.0, 0.1, 10.0),
        ("quadratic_drag", "coefficient", 10.0, 1.0, 10.0),
        ("cubic_stiffness", "coefficient", 1e8, 1e7, 10.0),
        ("directional_friction", "asymmetry", 0.02, 0.002, 10.0),
        ("load_dependent_friction", "exponent", 0.02, 0.002, 10.0),
        ("ageing", "rate", 1e-2, 1e-3, 10.0),
    ],
)
def test_towards_its_neutral_limit_an_effect_vanishes_in_proportion(name, field, far, near, order):
    values = mild(name) | ({"peak": 0.0} if name == "stribeck" else {})
    changes = [distance("static-dynamic", name, values | {field: value}) for value in (far, near)]
    assert changes[0] > 1e-6
    assert changes[1] == pytest.approx(changes[0] / order, rel=0.5)


def test_an_end_stop_that_is_never_touched_is_none():
    assert distance("static-dynamic", "end_stop", {"clearance": 5e-3, "stiffness": 1e5}) < 1e-6


@pytest.mark.parametrize("law", LAWS)
def test_directional_friction_mirrors(law):
    """Without gravity the mirror image of a motion is one, with forces and asymmetry reversed."""

    def extremes(asymmetry):
        record = parameters.record(
            law,
            0.5e-3,
            0.6 * OMEGA_N,
            suspension={"gravity": 0.0},
            friction={"dynamic": 0.2, "static": 0.25},
            effects={"directional_friction": {"asymmetry": asymmetry}},
        )
        cold = periodic.at_rest(1)
        found = periodic.respond(record, cold, periodic.Accuracy(1e-8, 400, 1e-9), 256, 7)
        assert found.outcome[0] == periodic.OK
        return found.extremes[0]

    low, high = extremes(0.3)
    mirrored = extremes(-0.3)
    assert low != pytest.approx(-high, rel=1e-3)
    assert (-high, -low) == pytest.approx(tuple(mirrored), rel=1e-5)


def test_parameters_change_what_their_names_say():
    suspension = {
        "bolster_spring": 5100 * 1.1,
        "wedge_spring": 2550 * 0.9,
        "bolster_mass": 0.7 * 1.2,
        "wedge_preload": 2.0,
    }
    friction = {"dynamic": 0.29 * 0.8, "static": 0.32 * 0.8}
    expected = parameters.record("exponential", 1e-3, 50.0, suspension, friction)
    found = parameters.record(
        "exponential",
        1e-3,
        50.0,
        effects={
            "bolster_stiffness": {"scale": 1.1},
            "wedge_stiffness": {"scale": 0.9},
            "bolster_mass": {"scale": 1.2},
            "preload": {"force": 2.0},
            "friction_level": {"scale": 0.8},
        },
    )
    assert numbers(found, 5)["amplitude_ratio"] == pytest.approx(numbers(expected, 5)["amplitude_ratio"])


def test_what_scales_a_number_scales_it_once_more_and_other_effects_take_one_anothers_place():
    own = {
        "friction_level": {"scale": 0.8},
        "preload": {"force": 5.0},
        "viscous_damping": {"coefficient": 2.0},
    }
    added = {"friction_level": {"scale": 1.1}, "preload": {"force": 3.0}, "bolster_mass": {"scale": 0.9}}
    found = merge(own, added)
    assert found.pop("friction_level") == {"scale": pytest.approx(0.88)}
    assert found == {
        "preload": {"force": 3.0},
        "viscous_damping": {"coefficient": 2.0},
        "bolster_mass": {"scale": 0.9},
    }


@pytest.mark.parametrize("name", EXTENDING)
def test_a_locked_wedge_is_told(name):
    # Under the Coulomb law a compliant column's faces are on a steep ramp, and creep: see below.
    law = "static-dynamic" if name == "column_compliance" else "coulomb"
    with pytest.raises(CaseError, match="locks"):
        numbers(with_effect(law, name, **SELF_LOCKING), 5)


@pytest.mark.acceptance
def test_on_a_steep_ramp_a_self_locking_wedge_creeps_in_both_solvers():
    record = with_effect("coulomb", "column_compliance", **SELF_LOCKING)
    window = Window(float(record["input"]["omega"][0]), 3, 2, 256)
    fast, slow = (
        response.evaluate(solver.solve(record, window, 1e-8, inf), record, 9).numbers
        for solver in (event_driven, radau)
    )
    assert fast["stick_fraction"] == slow["stick_fraction"] == 1.0
    assert fast["amplitude_ratio"] == pytest.approx(slow["amplitude_ratio"], rel=1e-6)
    assert fast["minimum_normal_force"] == pytest.approx(slow["minimum_normal_force"], rel=1e-4)


def test_springs_without_a_place_to_rest_are_told():
    record = with_effect("static-dynamic", "cubic_stiffness", {"coefficient": -1e12})
    with pytest.raises(CaseError):
        numbers(record, 2)


def test_a_foreign_tone_shows_at_its_frequency_and_has_a_phase_of_its_own():
    beta, omega = 0.6, 0.6 * OMEGA_N
    tone = 5.5 * omega / (2 * pi)
    cold = periodic.at_rest(1).state
    spectra = []
    for phase in (0.0, pi / 2):
        record = with_effect(
            "static-dynamic", NOT_PERIODIC, {"acceleration": 1.0, "frequency": tone}, 1e-4, beta
        )
        record["stray_vibration"]["phase"] = phase
        x = periodic.sampled(record, cold, 20, 20, 64, 1e-8).x
        spectra.append(np.fft.rfft(x[0]) / x.size * 2)
    at_tone = [spectrum[110] for spectrum in spectra]
    assert abs(at_tone[0]) > 1e-6
    assert abs(at_tone[0]) == pytest.approx(abs(at_tone[1]), rel=0.05)
    assert np.angle(at_tone[1] / at_tone[0]) == pytest.approx(pi / 2, abs=0.1)


def pairs():
    names = strategies.sampled_from(OF_SUSPENSION)
    return strategies.lists(names, min_size=1, max_size=2, unique=True).filter(go_together)


@pytest.mark.acceptance
@settings(max_examples=40, deadline=None)
@given(
    law=strategies.sampled_from(LAW_NAMES),
    names=pairs(),
    place=strategies.floats(0.02, 0.98),
    beta=strategies.floats(0.2, 3.0),
    exponent=strategies.floats(-5.0, -2.7),
    lean=strategies.sampled_from([4.0, -4.0]),
    dynamic=strategies.sampled_from([0.1, 0.29, 0.6]),
)
def test_any_effects_end_with_a_finite_answer_or_a_reason(law, names, place, beta, exponent, lean, dynamic):
    if law == "coulomb" and "column_compliance" in names:
        law = "exponential"
    record = parameters.record(
        law,
        10**exponent,
        beta * OMEGA_N,
        suspension={"column_angle": np.radians(lean)},
        friction={"dynamic": dynamic},
        effects={name: typical(name, place) for name in names},
    )
    cold = periodic.at_rest(1)
    found = periodic.respond(record, cold, periodic.Accuracy(1e-6, 30, 1e-6), 128, 5)
    assert np.isfinite(found.spectra[0]).all() == (found.outcome[0] == periodic.OK)
    # The proof that a wedge never locks is not needed to find that it does.
    record["geometry"]["always_well_posed"] = 0
    again = periodic.respond(record, cold, periodic.Accuracy(1e-6, 30, 1e-6), 128, 5)
    assert (again.outcome[0] == periodic.OK) == (found.outcome[0] == periodic.OK)


@pytest.mark.acceptance
@pytest.mark.parametrize(("name", "law"), [(name, LAWS[i % 3]) for i, name in enumerate(EXTENDING)])
def test_both_solvers_agree_from_the_same_start(name, law):
    record = with_effect(law, name)
    window = Window(float(record["input"]["omega"][0]), 3, 2, 64)
    runs = [solve(record, window, 1e-8, inf) for solve in (event_driven.solve, radau.solve)]
    ours, radaus = (response.evaluate(run, record, 5) for run in runs)
    size = np.ptp(radaus.waveforms["displacement"])
    for channel in ("displacement", "velocity"):
        scale = size * (1.0 if channel == "displacement" else window.omega)
        np.testing.assert_allclose(ours.waveforms[channel], radaus.waveforms[channel], atol=1e-4 * scale)
    for number in ("dissipated_energy", "supplied_energy", "amplitude_ratio"):
        assert ours.numbers[number] == pytest.approx(radaus.numbers[number], rel=1e-4), number
    slipping = ~ours.waveforms["stuck"]
    np.testing.assert_array_equal(np.isnan(ours.waveforms["normal_force_column"][slipping]), False)


@pytest.mark.acceptance
@pytest.mark.parametrize(("times", "more"), [(1, 2e-4), (5, 5e-3), (15, 2e-4)])
def test_a_release_that_lasts_a_moment_is_not_missed(times, more):
    """The bolster is released by a bit more than holds it; a tone makes that a short moment."""
    held = breakaway_accelerations(parameters.record("coulomb", 1e-4, OMEGA_N))[0][0]
    tone = {"acceleration": 0.5 * (1.0 + more) * held, "frequency": times * OMEGA_N / (2.0 * pi)}
    record = parameters.record(
        "coulomb", 0.5 * (1.0 + more) * held / OMEGA_N**2, OMEGA_N, effects={NOT_PERIODIC: tone}
    )
    # Both are largest at the same moment, three quarters of an input period from its start.
    record["stray_vibration"]["phase"] = 0.5 * pi * (1.0 - 3.0 * times)
    window = Window(OMEGA_N, 1, 2, 64)
    fast, slow = (
        response.evaluate(solver.solve(record, window, 1e-8, inf), record, 9).numbers
        for solver in (event_driven, radau)
    )
    assert 0.8 < fast["stick_fraction"] < 0.9999
    assert slow["stick_fraction"] == pytest.approx(fast["stick_fraction"], abs=1e-5)
    assert fast["amplitude_ratio"] > 0.0
    assert slow["amplitude_ratio"] == pytest.approx(fast["amplitude_ratio"], rel=1e-3, abs=1e-9)


@pytest.mark.parametrize("law", ["static-dynamic", "exponential"])
def test_bristles_stick_where_the_face_all_but_rests(law):
    """Far shorter than the motion they change little, least of all the share of time below the threshold."""
    bristles = parameters.record(law, 3e-4, OMEGA_N, effects={"presliding": {"length": 1e-7}})
    window = Window(OMEGA_N, 5, 2, 64)
    expected = response.evaluate(
        event_driven.solve(parameters.record(law, 3e-4, OMEGA_N), window, 1e-8, inf), bristles, 5
    )
    found = response.evaluate(event_driven.solve(bristles, window, 1e-6, inf), bristles, 5)
    share = found.numbers["stick_fraction"]
    assert share == pytest.approx(expected.numbers["stick_fraction"], abs=0.02)
    assert found.waveforms["stuck"].mean() == pytest.approx(share, abs=0.03)


def test_a_bolster_that_sticks_may_do_so_for_long():
    record = with_effect("coulomb", "viscous_damping", {"coefficient": 5.0}, 1e-5)
    assert numbers(record, 2500)["stick_fraction"] == 1.0


@pytest.mark.parametrize("name", EFFECTS)
def test_a_table_with_neutral_values_acts_no_more_than_none(name):
    off = {quantity.name: quantity.neutral * quantity.factor for quantity in EFFECTS[name].quantities}
    assert acting({name: off}) == {}
    assert acting({name: mild(name)}) == {name: mild(name)}


def test_friction_of_one_temperature_is_another_level_of_friction():
    """Coefficients are linear in temperature, nominal at the reference, and never negative."""
    share, reference = -0.004, 45.0
    for temperature, scale in ((45.0, 1.0), (60.0, 0.94), (20.0, 1.1), (400.0, 0.0)):
        drift = {"share": share, "temperature": temperature, "reference": reference}
        drifted, level = with_effect("exponential", "thermal_drift", drift), {"scale": scale}
        expected = with_effect("exponential", "friction_level", level)
        np.testing.assert_allclose(
            structured_to_unstructured(drifted), structured_to_unstructured(expected), rtol=1e-12
        )
    nominal = with_effect("exponential", "thermal_drift", {**drift, "share": 0.0})
    assert nominal.tobytes() == parameters.record("exponential", 0.8e-3, 0.6 * OMEGA_N).tobytes()
