"""Both solvers on random cases of ``scripts/agreement.py``, strict steps of Radau, and siconos."""

import json
import subprocess
from pathlib import Path

import agreement
import numpy as np
import pytest

from tests.physics.cases import OMEGA_N
from wedgesweep.simulate import Settings, respond
from wedgesweep.solvers.radau import SmallRadau, StrictRadau
from wedgesweep.systems.suspension import parameters

# Both leans, preload; 100 locks, 196 has a force that is negative for a fortieth of a period.
NUMBERS = (3, 100, 196)
LOCKED = {100}


@pytest.mark.acceptance
@pytest.mark.parametrize("number", NUMBERS)
def test_radau_and_event_driven_agree(number):
    result = agreement.compared(agreement.sine, number)
    assert result.moved < agreement.MOVED or number in LOCKED
    assert result.agrees, result
    assert (result.statuses[0] == "locked") == (number in LOCKED)


@pytest.mark.acceptance
@pytest.mark.parametrize("number", [0, 17])
def test_both_solvers_agree_on_random_transients(number):
    result = agreement.compared(agreement.transient, number)
    assert result.moved < agreement.MOVED
    assert result.agrees, result


METHODS = pytest.mark.parametrize("method", [StrictRadau, SmallRadau])
MATRIX = np.array([[-3.0, 1.0], [0.5, -2.0]])


def begun(method, rate=lambda t, y: MATRIX @ y):
    return method(rate, 0.0, np.array([1.0, 0.0]), 1.0, jac=lambda t, y: MATRIX, rtol=1e-8, atol=1e-10)


@METHODS
def test_finite_numbers_are_solved_and_others_are_errors_without_end(method):
    solver = begun(method)
    for shift in (2.0, 2.0 + 1.0j):
        matrix, right = shift * np.eye(2) - MATRIX, np.array([0.3, -0.7]) * shift
        assert np.allclose(matrix @ solver.solve_lu(solver.lu(matrix.copy()), right.copy()), right)
        for undetermined in (np.nan, np.inf):
            right[1] = undetermined
            assert np.isinf(solver.solve_lu(solver.lu(matrix.copy()), right)).all()


@METHODS
def test_a_step_is_rejected_where_its_second_estimate_has_no_rate(method):
    """After a rejection only this estimate takes the rate where the step begins."""
    seen = []

    def rate(t, y):
        seen.append(t)
        undetermined = t == 0.0 and len(seen) > 1
        return np.full(2, np.nan) if undetermined else MATRIX @ y + 1e3 * np.cos(200.0 * t)

    solver = begun(method, rate)
    solver.h_abs = 0.5
    solver.step()
    assert seen.count(0.0) > 1
    assert 0.0 < solver.t < 0.05
    assert np.isfinite(solver.y).all()


PYTHON, MODEL = Path("/usr/bin/python3"), Path(__file__).parents[2] / "scripts" / "siconos_model.py"
# Frequency ratio, amplitude (m) and, under constant damping, the force of the wedge's spring (N).
CASES = ((0.9, 1e-3, 0.0), (1.0, 4.75e-3, 0.0), (0.6, 2e-3, 4.0))
SETTLE, STEPS = 8, 750


def siconos_is_there():
    command = [PYTHON, "-c", "import siconos.kernel"]
    return PYTHON.exists() and subprocess.run(command, capture_output=True, check=False).returncode == 0


@pytest.mark.acceptance
def test_time_stepping_of_free_bodies_finds_the_same_motion(tmp_path):
    """At one step length; ``scripts/compare_siconos.py`` lets it go to zero."""
    if not siconos_is_there():
        pytest.skip("needs Debian's python3-siconos")
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
