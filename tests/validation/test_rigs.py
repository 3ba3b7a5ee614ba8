"""Rigs and errors that a validation campaign draws."""

import numpy as np
import pytest
from validation import imperfect, ranges, rigs

from wedgesweep.natural_units import FREQUENCY


def test_a_rig_of_any_size_is_in_the_ranges():
    for seed in range(50):
        rig = rigs.any_size(np.random.default_rng(seed))
        own = rig.sections["suspension"]
        frequency = np.sqrt(1e3 * own["bolster_spring_N_per_mm"] / own["bolster_mass_kg"]) / (2.0 * np.pi)
        assert rigs.MASS_KG[0] <= own["bolster_mass_kg"] <= rigs.MASS_KG[1]
        assert rigs.FREQUENCY_HZ[0] * 0.999 <= frequency <= rigs.FREQUENCY_HZ[1] * 1.001
        bench = rigs.bench(4.0).units.ratio(FREQUENCY)
        assert rigs.frequency_ratio(rig) / bench == pytest.approx(frequency / 13.585, rel=1e-4)


@pytest.mark.parametrize("index", range(4))
def test_an_oscillator_is_driven_about_breakaway(index):
    """The smallest input is held by friction where it rubs on what moves it, the largest is not."""
    rig = rigs.oscillator(index, np.random.default_rng(index))
    own, frequency = rig.sections["oscillator"], 0.7
    friction = 0.29 * own["normal_force_N"]
    through = {
        ("base", "base"): own["mass_kg"] * (2.0 * np.pi * frequency) ** 2 * 1e-3,
        ("ground", "base"): own["spring_N_per_mm"],
        ("base", "force"): 1.0,
        ("ground", "force"): 1.0,
    }[own["contact"], rig.excitation]
    force = through * rig.amplitudes(frequency)
    assert force[0] < friction < force[-1]
    assert rig.relative == (own["contact"] == rig.excitation == "base")
    assert {"amplitude_mm", "amplitude_N"} & {*rig.document("coulomb", {})["sweep"]} == {rig.amplitude_key}


def test_a_hidden_effect_is_of_the_size_of_its_rig():
    small, large = (
        rigs.Rig({"suspension": {"bolster_mass_kg": 0.7 * size, "bolster_spring_N_per_mm": 5.1 * size}})
        for size in (1.0, 4000.0)
    )
    forces = [
        ranges.path("guide_friction", np.random.default_rng(1), rig.units)(0.5)["force_N"]
        for rig in (small, large)
    ]
    assert forces[1] / forces[0] == pytest.approx(4000.0)


def test_errors_are_in_proportion_to_their_size_but_for_a_recorded_distortion():
    whole, half = (imperfect.draw(size, False, 4.0, np.random.default_rng(3)) for size in (1.0, 0.5))
    masses = [each.rig.sections["suspension"]["bolster_mass_kg"] - 0.70 for each in (whole, half)]
    assert masses[1] == pytest.approx(0.5 * masses[0], abs=2e-6)
    assert half.effects["input_distortion"]["second"] == 0.5 * whole.effects["input_distortion"]["second"]
    assert half.uncertain == {name: 0.5 * std for name, std in whole.uncertain.items()}
    recorded = [imperfect.draw(size, True, 4.0, np.random.default_rng(3)).effects for size in (1.0, 0.5)]
    assert recorded[0]["input_distortion"] == recorded[1]["input_distortion"]
