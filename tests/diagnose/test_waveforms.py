"""The force that a model lacks, seen from measured motion, is the force that was taken out of it."""

from dataclasses import replace

import numpy as np
import pytest

from tests.diagnose.drawn import AMPLITUDES, drawn
from wedgesweep.diagnose import waveforms
from wedgesweep.diagnose.coordinates import Hypothesis
from wedgesweep.diagnose.model import Fit, Model
from wedgesweep.diagnose.search import Search

DAMPING, DRY = 8.0, 0.1
DAMPER = {"viscous_damping": {"coefficient": DAMPING}}
GUIDE = {"guide_friction": {"force": DRY}}


def seen(level, effects, *numbers):
    """Leftover force (N) of the base model and the deflection's rate (m/s); input and its phase are known."""
    problem = drawn(effects, level=level)
    model = Model(problem, Hypothesis(()), problem.amplitude)
    trial = model.trial(model.start(None, np.zeros(0)))
    true = Model(problem, Hypothesis(tuple(effects)), problem.amplitude)
    phase = true.trial(true.start(None, np.array(numbers))).phase
    fit = Fit(model, replace(trial, phase=phase), np.zeros((0, 0)), True)
    harmonics = waveforms.measured_from_phase_zero(fit)
    rate = waveforms.velocity(problem, harmonics)
    force = waveforms.leftover_force(fit, harmonics)
    return force, -waveforms.waveform(rate)


def left(force, law):
    """Share of a force that a law does not give, over all tests."""
    return np.sqrt(((force - law) ** 2).sum() / (law**2).sum())


@pytest.mark.parametrize("level", [1e-4, 0.04])
def test_a_damper_that_is_missing(level):
    force, v = seen(level, DAMPER, DAMPING)
    assert left(force, -DAMPING * v) < 0.3


@pytest.mark.parametrize("level", [1e-4, 0.04])
def test_a_guide_s_friction_that_is_missing(level):
    force, v = seen(level, GUIDE, DRY)
    assert left(force, -DRY * np.sign(v)) < 0.4


@pytest.mark.parametrize("level", [1e-4, 0.04])
def test_nothing_is_left_of_the_right_model(level):
    """What noise and the jumps of friction leave is small beside what such a damper would."""
    force, v = seen(level, {})
    assert left(force + DAMPING * v, DAMPING * v) < 0.3


def test_the_energy_of_measured_tests_is_that_of_the_true_system():
    """A heavier bolster on inputs that are not quite those stated: the base model takes both up elsewhere."""
    heavier, off = {"bolster_mass": {"scale": 1.1}}, 0.03
    problem = drawn(heavier, std=0.05, off=off)
    search = Search(problem, ("bolster_mass",))
    base = search.base().fit
    extended = search.single("bolster_mass", base).fit
    model = Model(problem, Hypothesis(("bolster_mass",)), (1.0 + off) * AMPLITUDES)
    true = Fit(model, model.trial(model.start(None, np.array([1.1]))), np.zeros((1, 1)), True)
    energy = waveforms.supplied(true, true.trial.harmonics[:, 0, 0])
    np.testing.assert_allclose(waveforms.measured_energy(extended), energy, rtol=0.03)
    assert np.abs(waveforms.measured_energy(base) / energy - 1.0).max() > 0.1
