"""The phase of a tone relative to the input matters if the record is shorter than a beat."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from tests.diagnose.synthetic import MODEL, base_of
from wedgesweep import config
from wedgesweep.diagnose.least_squares import from_other_nuisances, minimise
from wedgesweep.diagnose.score_test import scores
from wedgesweep.diagnose.search import Search, base_fit, single_fit
from wedgesweep.diagnose.steady import simulation
from wedgesweep.diagnose.steady.harmonic_data import HarmonicData
from wedgesweep.diagnose.steady.spectra import spectrum
from wedgesweep.solvers import periodic

TONE, ACCELERATION, NOISE = 14.41, 7e-3, 0.01
# The tone hides behind the third harmonic of the first, and beside half the input's frequency of the second.
FREQUENCIES, AMPLITUDES = np.array([4.857, 28.3, 8.34]), 1e-3 * np.array([1.41, 0.062, 0.41])
PERIODS, PER_PERIOD = 8.4, 256


def recorded(phases, seed):
    """Data of three tests with some phases (rad) of the vibration; records start at phase 0 of the input."""
    rng = np.random.default_rng(seed)
    model = config.parse(MODEL)
    stray = {"stray_vibration": {"acceleration": ACCELERATION, "frequency": TONE}}
    rows = simulation.records(model, "static-dynamic", stray, 2.0 * pi * FREQUENCIES, AMPLITUDES)
    rows["stray_vibration"]["phase"] = phases
    x, velocity = periodic.sampled(rows, periodic.at_rest(3).state, 40, 9, PER_PERIOD, 1e-8)[:2]
    count = round(PERIODS * PER_PERIOD)
    signals = -np.stack([x, velocity], axis=1)[..., :count]
    signals += NOISE * signals.std(axis=2, keepdims=True) * rng.normal(size=signals.shape)
    spectra = tuple(
        spectrum(np.arange(count) / (frequency * PER_PERIOD), signal, frequency, TONE)
        for frequency, signal in zip(FREQUENCIES, signals, strict=True)
    )
    names = tuple(f"{frequency:g} Hz" for frequency in FREQUENCIES)
    exact = np.full(3, 1e-4)
    return HarmonicData(model, "static-dynamic", names, spectra, AMPLITUDES, exact, {}, TONE, 0.01)


@pytest.mark.acceptance
def test_the_phase_of_a_vibration_explains_what_an_unknown_phase_leaves():
    before = []
    for seed, phase in enumerate(np.arange(6) * pi / 3.0):
        data = recorded(np.full(3, phase), seed)
        assert [each.masked_harmonic for each in data.spectra] == [3, None, None]
        model = Search.of(data, ("stray_vibration",)).model("stray_vibration")
        anyhow = minimise(model, model.evaluate(model.start(None, np.array([ACCELERATION]))))
        fit = from_other_nuisances(anyhow)
        assert fit.p > 1e-3
        found = fit.values["stray_vibration"]["acceleration_m_per_s2"]
        assert found == pytest.approx(ACCELERATION, rel=0.05)
        before.append(anyhow.p)
    # Most phases do not matter; with others only the fitted phase is adequate.
    assert min(before) < 1e-6


@pytest.mark.acceptance
def test_the_base_model_may_contain_the_vibration():
    """Its phases are as unknown as those of one that is a cause."""
    table = f"[effects.stray_vibration]\nacceleration_m_per_s2 = {ACCELERATION}\nfrequency_hz = {TONE}\n"
    for seed, phase in enumerate(np.arange(6) * pi / 3.0):
        data = replace(recorded(np.full(3, phase), seed), model=config.parse(MODEL + table))
        search, base, *_ = base_fit(Search.of(data, ("viscous_damping",)))
        assert base.fit.p > 1e-3
    (damping,) = scores(search, base.fit, {})
    assert damping.testable
    assert single_fit(search, "viscous_damping", base.fit).explanation.penalised > base.penalised


def test_a_fit_without_a_tone_stays_as_it_is():
    data = recorded(np.zeros(3), 0)
    base = base_of(data)
    assert from_other_nuisances(base) is base
