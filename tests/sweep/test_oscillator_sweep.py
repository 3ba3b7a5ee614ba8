"""Sweeps of the oscillator: from its config to a dataset and figures."""

from math import pi
from pathlib import Path

import numpy as np
import pytest
from reproduce import published

from tests.small_sweep import faults
from wedgesweep import config, figures
from wedgesweep.config import ConfigError
from wedgesweep.sweep.run import Sweep

CONFIGS = Path(__file__).parents[2] / "configs"
SMALL = """
[oscillator]
mass_kg = 3.08
spring_N_per_mm = 1.191
damping_N_s_per_m = 0.669
normal_force_N = 2.45
contact = "CONTACT"
[sweep]
friction_law = ["coulomb", "static-dynamic"]
excitation = "EXCITATION"
frequency_hz = [2.0, 3.0, 4.5]
AMPLITUDE
[solver]
method = "event-driven"
settle = "steady"
"""
INPUTS = {"base": "amplitude_mm = [0.5, 2.0]", "force": "amplitude_N = [1.0, 2.0]"}


def parsed(contact="base", excitation="base", **changes):
    text = SMALL.replace("CONTACT", contact).replace("EXCITATION", excitation)
    text = text.replace("AMPLITUDE", INPUTS[excitation])
    for old, new in changes.items():
        text = text.replace(old, new)
    return config.parse(text)


def run(settings):
    return Sweep(settings, Path("unused.nc")).run_here()


@pytest.mark.acceptance
def test_published_numbers():
    checks = published.check(CONFIGS)
    assert len(checks) == 10
    assert [each for each in checks if not each.holds] == []


@pytest.mark.acceptance
def test_another_friction_is_not_the_published_one():
    settings = config.load(CONFIGS / "den-hartog.toml").document
    for friction, holds in ((1.0, True), (1.001, False)):
        settings["friction"] |= {"dynamic": friction, "static": friction}
        checks = published.den_hartog(run(config.from_document(settings)))
        assert [each.holds for each in checks] == [True, holds]


@pytest.mark.few(2)
@pytest.mark.parametrize("excitation", INPUTS)
@pytest.mark.parametrize("contact", ["base", "ground"])
def test_dataset_says_what_it_holds(contact, excitation):
    ds = run(parsed(contact, excitation))
    assert (ds["status"] == 0).all()
    assert ds["amplitude"].attrs["units"] == {"base": "m", "force": "N"}[excitation]
    symbol = "x - u" if (contact, excitation) == ("base", "base") else "x"
    assert ds["displacement"].attrs["long_name"] == f"displacement {symbol} of the mass"
    assert "normal_force_column" not in ds
    assert ds["supplied_energy"].values == pytest.approx(ds["dissipated_energy"].values, rel=1e-4, abs=1e-9)
    # Those take more cases, or joints that open.
    for kind in sorted(set(figures.FIGURES) - {"bifurcation", "stick-map", "lift-off-map"}):
        assert figures.draw(ds, kind).get_suptitle()


def test_frictionless_dataset_is_linear():
    settings = parsed("ground", "base", **{"normal_force_N = 2.45": "normal_force_N = 0.0"})
    ds = run(settings).sel(friction_law="coulomb")
    omega = 2.0 * pi * ds["frequency"].values
    support = 1191.0 + 0.669j * omega
    expected = np.abs(support / (support - 3.08 * omega**2))
    for amplitude in ds["amplitude"].values:
        assert ds["amplitude_ratio"].sel(amplitude=amplitude).values == pytest.approx(expected, rel=1e-5)


def test_no_spring():
    settings = parsed("base", "base", **{"spring_N_per_mm = 1.191": "spring_N_per_mm = 0.0"})
    ds = run(settings)
    assert ds["beta"].values == pytest.approx(ds["frequency"].values)
    assert "1 Hz" in ds["beta"].attrs["long_name"]
    assert (ds["status"] == 0).all()


@pytest.mark.parametrize(
    ("old", "new", "problem"),
    [
        ("[oscillator]", "[suspension]\n[oscillator]", "suspension and oscillator exclude each other"),
        ("mass_kg = 3.08", "", "oscillator.mass_kg: missing"),
        ('contact = "base"', 'contact = "belt"', "oscillator.belt_velocity_mm_per_s: missing"),
        ('contact = "base"', "belt_velocity_mm_per_s = 1.0", 'write contact = "belt"'),
        ("amplitude_mm = [0.5, 2.0]", "amplitude_N = 1.0", 'sweep.amplitude_N: excitation is "base"'),
        ('excitation = "base"', 'excitation = "force"', 'sweep.amplitude_mm: excitation is "force"'),
        ("[solver]", "[effects.column_compliance]\nstiffness_N_per_mm = 1.0\n[solver]", "no such part"),
        (
            "[solver]",
            "[effects.damper_play]\nclearance_mm = 0.1\n[effects.presliding]\nlength_mm = 0.1\n[solver]",
            "effects.damper_play: does not go with effects.presliding",
        ),
        (
            "spring_N_per_mm = 1.191",
            "spring_N_per_mm = 0.0",
            "sweep.beta: without a spring there is no omega_n; write frequency_hz",
        ),
    ],
)
def test_contradictions_are_told(old, new, problem):
    changes = {old: new}
    if "sweep.beta" in problem:
        changes["frequency_hz ="] = "beta ="
    with pytest.raises(ConfigError, match=problem):
        parsed(**changes)


def test_a_suspension_has_no_force_and_no_hyperbolic_law():
    text = '[sweep]\nfriction_law = "hyperbolic"\nbeta = 1.0\nexcitation = "force"\namplitude_N = 1.0\n'
    law, force = faults(text)
    assert "a law of [oscillator]" in law
    assert "driven by its side frame" in force
