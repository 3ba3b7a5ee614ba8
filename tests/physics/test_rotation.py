"""An oscillator that turns: the equations of a translation, and the sine of a pendulum."""

from math import inf

import numpy as np
import pytest
from scipy.special import ellipk

import wedgesweep
from tests.physics.test_oscillator import SOLVERS
from wedgesweep import config, rotation
from wedgesweep.solvers.trajectory import Window

# A pendulum of 20 g m^2 and 0.4 N m/rad: 1.405 s of small swings.
INERTIA, STIFFNESS = 0.02, 0.4
METHODS = ("event-driven", pytest.param("radau", marks=pytest.mark.acceptance))


def released(start_deg: float, method: str, **more: float | str) -> dict:
    """Config of a release from an angle."""
    return {
        "oscillator": {
            **{"motion": "rotation", "inertia_kg_m2": INERTIA, "spring_N_m_per_rad": STIFFNESS},
            **{"restoring_force": "pendulum", "contact": "ground", **more},
        },
        "input": {"kind": "release", "displacement_deg": start_deg, "duration_s": 4.0, "sampling_hz": 500.0},
        "sweep": {"friction_law": "coulomb"},
        "solver": {"method": method, "rtol": 1e-9},
    }


def swing(start_deg: float, method: str, **more: float | str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times (s), angles (rad) and their rates (rad/s) from an angle on, by a solver itself.

    The input is a sine of next to nothing: that of a release would need other compiled code.
    """
    document = released(start_deg, method, **more)
    del document["input"]
    document["sweep"] |= {"frequency_hz": 0.5, "amplitude_rad": 1e-12}
    record = wedgesweep.load_config(document).records()
    window = Window(float(record["input"]["omega"][0]), 0, 2, 1000)
    found = SOLVERS[method].solve(record, window, 1e-9, inf, start=(np.radians(start_deg), 0.0)).samples
    return found.t, found.x, found.velocity


def period(time: np.ndarray, angle: np.ndarray) -> float:
    """Time (s) from the first to the third passage through zero, cubic between the samples."""
    rows = np.flatnonzero(angle[:-1] * angle[1:] < 0.0)[[0, 2]]
    crossings = []
    for row in rows:
        near = slice(row - 1, row + 3)
        roots = np.roots(np.polyfit(time[near] - time[row], angle[near], 3))
        real = roots[np.abs(roots.imag) < 1e-9].real
        crossings.append(time[row] + real[np.argmin(np.abs(real - 0.5 * (time[1] - time[0])))])
    return float(crossings[1] - crossings[0])


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("start_deg", [0.5, 60.0, 150.0])
def test_the_period_of_a_pendulum_is_that_of_the_elliptic_integral(start_deg: float, method: str) -> None:
    time, angle, rate = swing(start_deg, method)
    exact = 4.0 * np.sqrt(INERTIA / STIFFNESS) * ellipk(np.sin(0.5 * np.radians(start_deg)) ** 2)
    assert period(time, angle) == pytest.approx(exact, rel=1e-6)
    energy = 0.5 * INERTIA * rate**2 + STIFFNESS * (1.0 - np.cos(angle))
    assert energy == pytest.approx(np.full(energy.size, energy[0]), rel=1e-6)


def test_a_pendulum_of_small_swings_is_a_spring() -> None:
    sine, line = (swing(0.1, "event-driven", restoring_force=force)[1] for force in ("pendulum", "linear"))
    assert sine == pytest.approx(line, abs=1e-5 * np.abs(line).max())


def test_friction_takes_its_torque_times_the_angle_from_a_pendulum() -> None:
    torque = 0.01
    _, angle, rate = swing(60.0, "event-driven", friction_N_m=torque)
    turn = int(np.flatnonzero(rate[1:-1] * rate[2:] < 0.0)[0]) + 1
    lost = STIFFNESS * (np.cos(angle[turn]) - np.cos(angle[0])) - 0.5 * INERTIA * rate[turn] ** 2
    assert lost == pytest.approx(torque * abs(angle[turn] - angle[0]), rel=1e-4)


def test_a_rotation_is_a_translation_in_other_units() -> None:
    turning = released(10.0, "event-driven", restoring_force="linear", friction_N_m=0.01)
    moving = {
        **turning,
        "oscillator": {"mass_kg": INERTIA, "spring_N_per_mm": 1e-3 * STIFFNESS, "normal_force_N": 0.01},
        "friction": {"dynamic": 1.0, "static": 1.0},
        "input": turning["input"] | {"displacement_mm": 1e3 * float(np.radians(10.0))},
    }
    del moving["input"]["displacement_deg"]
    moving["oscillator"]["contact"] = "ground"
    turned, moved = (
        wedgesweep.run_sweep(wedgesweep.load_config(each), n_jobs=1)["displacement"]
        for each in (turning, moving)
    )
    assert (turned.attrs["units"], moved.attrs["units"]) == ("rad", "m")
    assert turned.values == pytest.approx(moved.values, rel=1e-12, abs=1e-15)


def test_a_written_config_is_read_as_it_was() -> None:
    document = released(60.0, "radau", friction_N_m=0.01)
    document["effects"] = {"end_stop": {"clearance_deg": 70.0, "stiffness_N_m_per_rad": 10.0}}
    first = config.from_document(document)
    again = config.parse(first.to_toml())
    assert again.document == first.document
    assert first.effects["end_stop"]["clearance"] == pytest.approx(np.radians(70.0), rel=1e-12)
    assert "clearance_rad" in first.to_toml()


@pytest.mark.parametrize(
    ("change", "fault"),
    [
        ({"mass_kg": 1.0}, "oscillator.mass_kg: unknown key"),
        ({"motion": "translation"}, "oscillator.mass_kg: missing"),
        ({"input_coupling": 0.5, "contact": "base"}, "oscillator.input_coupling"),
    ],
)
def test_keys_of_the_other_motion_are_refused(change: dict, fault: str) -> None:
    with pytest.raises(config.ConfigError, match=fault):
        config.from_document(released(60.0, "radau", **change))


def test_documents_keep_their_numbers_there_and_back() -> None:
    document = {"causes": [{"parameters": {"force_N": {"value": 0.3, "ci95": [0.2, 0.4]}}}], "start_mm": 5.0}
    turned = rotation.written(document)
    assert turned["causes"][0]["parameters"] == {"force_N_m": {"value": 0.3, "ci95": [0.2, 0.4]}}
    assert turned["start_rad"] == 0.005


def test_an_input_acts_by_its_coupling() -> None:
    driven = released(0.0, "event-driven", restoring_force="linear", damping_N_m_s_per_rad=0.02)
    driven["sweep"] = {"friction_law": "coulomb", "frequency_hz": 0.5, "amplitude_rad": 0.1}
    driven["solver"] = {"method": "event-driven", "settle": "steady"}
    del driven["input"]
    whole = wedgesweep.run_sweep(wedgesweep.load_config(driven), n_jobs=1)
    driven["oscillator"]["input_coupling"] = 0.465
    part = wedgesweep.run_sweep(wedgesweep.load_config(driven), n_jobs=1)
    ratio = part["amplitude_ratio"].item() / whole["amplitude_ratio"].item()
    assert ratio == pytest.approx(0.465, rel=1e-6)
