"""Forces locked in at rest, hidden in tests near breakaway and found."""

import numpy as np
import pytest

from tests.diagnose.synthetic import MODEL, drawn
from wedgesweep.diagnose import verdict
from wedgesweep.diagnose.result.estimates import parameters
from wedgesweep.diagnose.search import Search
from wedgesweep.diagnose.stages import explain

# Frequencies (Hz), and amplitudes (m) of base accelerations of 0.9 to 2.4 m/s2: all break away.
FREQUENCIES = np.array([8.0, 12.0, 16.0, 20.0, 24.0, 30.0])
AMPLITUDES = np.array([0.9, 1.1, 1.3, 1.6, 2.0, 2.4]) / (2.0 * np.pi * FREQUENCIES) ** 2


@pytest.mark.acceptance
@pytest.mark.parametrize("locked_in", [0.5])
def test_it_is_named_with_its_share(locked_in):
    hidden = {"jamming": {"locked_in": locked_in}}
    model = MODEL.replace("static-dynamic", "coulomb")
    data = drawn(hidden, bench=(FREQUENCIES, AMPLITUDES), law="coulomb", model=model, std=0.005)
    candidates = ("jamming", "friction_level", "guide_friction", "stribeck")
    _, base, explanations, _ = explain(Search.of(data, candidates))
    finding = verdict.decide(base, explanations, verdict.thresholds_for(data))
    assert finding.verdict == verdict.NAMED
    assert finding.best.effects == ("jamming",)
    low, high = parameters(finding.best.fit)["jamming"]["locked_in"]["ci95"]
    assert low <= locked_in <= high
