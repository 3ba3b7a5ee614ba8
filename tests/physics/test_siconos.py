"""Lift-off against siconos, a second formulation of the same model; skipped where it is not installed."""

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest

from tests.physics.cases import OMEGA_N
from wedgesweep.simulate import Settings, respond
from wedgesweep.systems.suspension import parameters

PYTHON, MODEL = Path("/usr/bin/python3"), Path(__file__).parents[2] / "scripts" / "siconos_model.py"
# Frequency ratio, amplitude (m) and, under constant damping, the force of the wedge's spring (N).
CASES = ((0.9, 1e-3, 0.0), (1.0, 4.75e-3, 0.0), (0.6, 2e-3, 4.0))
SETTLE, STEPS = 8, 750


def siconos_is_there():
    command = [PYTHON, "-c", "import siconos.kernel"]
    return PYTHON.exists() and subprocess.run(command, capture_output=True, check=False).returncode == 0


@pytest.mark.skipif(not siconos_is_there(), reason="needs Debian's python3-siconos")
def test_time_stepping_of_free_bodies_finds_the_same_motion(tmp_path):
    """At one step length; ``scripts/compare_siconos.py`` lets it go to zero."""
    window = {"restitution": 0.0, "settle": SETTLE, "keep": 2, "steps": STEPS}
    given = json.dumps(
        [{"beta": beta, "amplitude": size, "preload": preload, **window} for beta, size, preload in CASES]
    )
    command = [PYTHON, MODEL, tmp_path / "results.json"]
    subprocess.run(command, input=given, text=True, stdout=subprocess.DEVNULL, check=True)
    settings = Settings(method="event-driven", duration=None, settle_periods=SETTLE, kept_periods=2)
    its = np.array(json.loads((tmp_path / "results.json").read_text())["results"])
    for (beta, amplitude, preload), (ratio, column, bolster) in zip(CASES, its, strict=True):
        damping = {"damping": "constant", "wedge_preload": preload} if preload else {}
        case = parameters.record("coulomb", amplitude, beta * OMEGA_N, {"joints": "unilateral", **damping})
        own = respond(case, settings, 3)[0].numbers
        assert own["amplitude_ratio"] == pytest.approx(ratio, rel=8e-3)
        assert own["column_open_fraction"] == pytest.approx(column, abs=0.01)
        assert own["bolster_open_fraction"] == pytest.approx(bolster, abs=0.01)
