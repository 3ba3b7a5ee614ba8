"""Measured oscillators: signs of channels and inputs, and hidden effects under a force."""

from dataclasses import replace

import numpy as np
import pytest

from tests.command import invoke
from tests.diagnose.synthetic import measurement, record
from wedgesweep import config, measured
from wedgesweep.diagnose.diagnosis import diagnose
from wedgesweep.diagnose.steady.from_measurement import harmonic_data
from wedgesweep.diagnose.steady.harmonic_data import stated

M, C, K = 2.0, 6.0, 800.0
MODEL = """
[oscillator]
mass_kg = 2.0
damping_N_s_per_m = 6.0
spring_N_per_mm = 0.8
normal_force_N = 1.0
contact = "{contact}"
[friction]
dynamic = {friction}
static = {friction}
[sweep]
friction_law = "coulomb"
excitation = "{excitation}"
frequency_hz = 1.0
{amplitude} = 1.0
"""
FREQUENCY, NOISE = 2.3, 1e-4
# Of the input, from phase 0 of the first sample: an odd shape, so that a wrong sign is no other phase.
SHAPE = np.array([-1j, 0.2 + 0.1j, 0.05])
ORDERS = np.arange(1, SHAPE.size + 1)
OMEGA = 2.0 * np.pi * FREQUENCY * ORDERS
ORDER = {"displacement": 0, "velocity": 1, "acceleration": 2, "force": 0}


def model(contact, excitation, friction=0.0):
    amplitude = "amplitude_N" if excitation == "force" else "amplitude_mm"
    text = MODEL.format(contact=contact, excitation=excitation, friction=friction, amplitude=amplitude)
    return config.parse(text)


def frictionless(contact, quantity, channel, of):
    """A record of the oscillator without friction, from its transfer function."""
    forced = quantity == "force"
    given = SHAPE if forced else 1e-3 * SHAPE
    spring = K + 1j * C * OMEGA
    absolute = given * (1.0 if forced else spring) / (spring - M * OMEGA**2)
    motion = absolute if of == "absolute" or forced else absolute - given
    time = np.arange(4000) * 12.0 / FREQUENCY / 4000
    turns = np.exp(1j * np.outer(time, OMEGA))
    rng = np.random.default_rng(3)

    def sampled(harmonics, name):
        exact = (turns @ (harmonics * (1j * OMEGA) ** ORDER[name])).real
        return exact + NOISE * exact.std() * rng.normal(size=time.size)

    fed = sampled(given, quantity)
    test = record("0", FREQUENCY, time, input=fed, **{channel: sampled(motion, channel)})
    columns = {
        channel: {"column": "y", "unit": "m", "of": of},
        "input": {"column": "u", "unit": "m", "quantity": quantity},
    }
    return measurement(model(contact, "force" if forced else "base"), "coulomb", [test], columns)


@pytest.mark.few(4)
@pytest.mark.parametrize("of", ["relative", "absolute"])
@pytest.mark.parametrize(
    ("contact", "quantity", "channel"),
    [
        ("base", "displacement", "velocity"),
        ("base", "acceleration", "displacement"),
        ("ground", "displacement", "displacement"),
        ("ground", "acceleration", "acceleration"),
        ("base", "force", "displacement"),
        ("ground", "force", "acceleration"),
    ],
)
def test_signs_of_channel_and_input(contact, quantity, channel, of):
    """Without friction all contacts are alike; a wrong sign leaves errors of the response's size."""
    data = harmonic_data(frictionless(contact, quantity, channel, of))
    compared = data.compare([stated(data)], 1e-8)[0]
    assert (compared.residual**2).sum() < 2.0 * data.dof.sum()
    turned = replace(data, spectra=tuple(replace(each, mean=-each.mean) for each in data.spectra))
    wrong = turned.compare([stated(turned)], 1e-8)[0]
    assert (wrong.residual**2).sum() > 1e4 * data.dof.sum()


# Frequency (Hz) and amplitude (N) of tests; of others, friction nearly holds all but the first.
TESTS = [(2.0, 1.5), (3.0, 0.9), (4.5, 2.5)]
MOSTLY_SLIGHT = [(2.0, 6.0), (8.0, 0.6), (10.0, 0.6), (12.0, 0.8)]


def toml_of(tests):
    return "".join(f"[[test]]\nfrequency_hz = {hertz}\namplitude_N = {force}\n" for hertz, force in tests)


@pytest.mark.acceptance
@pytest.mark.parametrize(
    ("effect", "hidden", "recorded", "tests"),
    [
        ("directional_damping", {"coefficient_N_s_per_m": 6.0, "asymmetry": -0.7}, True, TESTS),
        ("damper_play", {"clearance_mm": 0.0002}, False, MOSTLY_SLIGHT),
        ("series_compliance", {"stiffness_N_per_mm": 3.0, "coefficient_N_s_per_m": 4.0}, True, TESTS),
    ],
)
def test_what_is_hidden_under_a_force_is_found(tmp_path, monkeypatch, effect, hidden, recorded, tests):
    """From the true oscillator through files to the cause."""
    monkeypatch.chdir(tmp_path)
    true = model("ground", "force", friction=0.4).document
    true["effects"] = {effect: hidden}
    (tmp_path / "true.toml").write_text(config.from_document(true).to_toml())
    (tmp_path / "tests.toml").write_text(toml_of(tests))
    options = ["--record-input", "force"] if recorded else []
    invoke("synthesize", "true.toml", "--tests", "tests.toml", "--n-jobs", 1, "-o", "made", *options)
    assert ("recorded" if recorded else f"{tests[0][1]:g} +- 0.1 %") in invoke("check", "made/measured.toml")
    candidates = (
        *("friction_level", "viscous_damping", "directional_damping", "quadratic_drag"),
        *("cubic_stiffness", "backlash", "presliding", "damper_play", "series_compliance"),
    )
    found = diagnose(measured.read(tmp_path / "made" / "measured.toml"), candidates)
    assert (found.finding.verdict, found.finding.best.effects) == ("named", (effect,))
    assert found.finding.best.values[effect] == pytest.approx(hidden, rel=0.05)
    # In the range that is searched, not beyond it.
    assert found.finding.best.model.hypothesis.wider == ()
