"""Delays and gains of channels, hidden in otherwise exact records: named, with their numbers."""

from pathlib import Path

import numpy as np
import pytest
from scipy.signal import lsim

from tests.diagnose.rigs import FORCE, FORCED, HEAD, oscillator, saved
from wedgesweep import api

MASS, STIFFNESS, DAMPING, FRICTION = 2.0, 8000.0, 8.0, 2.0
ABSOLUTE = 'displacement = { column = "x", unit = "mm", of = "absolute" }\n'
INPUT = 'input = { column = "F", unit = "N", quantity = "force" }\n'
RATE, DELAY = 1000.0, 0.004
CANDIDATES = ("channel_delay", "force_gain", "input_gain", "viscous_damping", "bolster_stiffness")


def save(folder: Path, kind: str, channels: str, normal: float, records: list[np.ndarray]) -> Path:
    """Files of records, columns time (s), displacement (m) and force (N), with 0.3 % of noise."""
    random, tests = np.random.default_rng(7), {}
    for i, record in enumerate(records):
        noisy = record.copy()
        noisy[:, 1:] += 0.003 * record[:, 1:].std(axis=0) * random.standard_normal((len(record), 2))
        noisy[:, 1] *= 1e3
        tests[i] = noisy.T, f'kind = "{kind}"\n'
    numbers = {"mass_kg": MASS, "spring_N_per_mm": 1e-3 * STIFFNESS, "damping_N_s_per_m": DAMPING}
    model = oscillator(1.0, FORCED, contact="ground", normal_force_N=normal, **numbers)
    return saved(folder, model, HEAD + ABSOLUTE + channels, "t,x,F", tests)


def loops(late: float = 0.0, gain: float = 1.0) -> list[np.ndarray]:
    """Loops at three frequencies whose force is late (s), or has a gain."""
    time, found = np.arange(4000) / RATE, []
    for frequency in (2.0, 4.0, 7.0):
        omega = 2.0 * np.pi * frequency
        x, there = 0.005 * np.sin(omega * time), omega * (time - late)
        rate = 0.005 * omega * np.cos(there)
        force = (STIFFNESS - MASS * omega**2) * 0.005 * np.sin(there) + DAMPING * rate
        force += FRICTION * np.sign(rate)
        found.append(np.column_stack([time, x, gain * force]))
    return found


def driven(late: float = 0.0, gain: float = 1.0) -> list[np.ndarray]:
    """Responses to swept forces; the displacement is late (s), or what acts is ``gain`` times the record."""
    time, found = np.arange(3000) / RATE, []
    for low, high in ((3.0, 20.0), (20.0, 5.0)):
        force = 20.0 * np.sin(2.0 * np.pi * (low * time + 0.5 * (high - low) / time[-1] * time**2))
        system = ([1.0], [MASS, DAMPING, STIFFNESS])
        x = lsim(system, gain * force, time)[1]
        found.append(np.column_stack([time, np.interp(time - late, time, x), force]))
    return found


@pytest.mark.acceptance
@pytest.mark.parametrize(
    ("kind", "fault", "effect", "key", "true"),
    [
        ("loop", {"late": DELAY}, "channel_delay", "time_s", DELAY),
        ("loop", {"gain": 1.08}, "force_gain", "scale", 1.08),
        ("transient", {"gain": 1.08}, "input_gain", "scale", 1.08),
        ("steady", {"late": DELAY}, "channel_delay", "time_s", DELAY),
    ],
)
def test_errors_of_channels_are_named(tmp_path, kind, fault, effect, key, true):
    if kind == "loop":
        path = save(tmp_path, kind, FORCE, FRICTION, loops(**fault))
    elif kind == "transient":
        path = save(tmp_path, kind, INPUT, 0.0, driven(**fault))
    else:
        path = save(
            tmp_path, kind, INPUT, 0.0, [steady(frequency, **fault) for frequency in (5.0, 8.0, 13.0)]
        )
    found = api.diagnose_measurement(api.read_measurement(path), effects=CANDIDATES, n_jobs=1)
    assert (found.verdict, [cause["effect"] for cause in found.causes]) == ("named", [effect])
    assert found.causes[0]["parameters"][key]["value"] == pytest.approx(true, rel=5e-3)


def steady(frequency: float, late: float) -> np.ndarray:
    """A steady response to a sine force, which is late (s)."""
    time, omega = np.arange(4000) / RATE, 2.0 * np.pi * frequency
    ratio = 1.0 / (STIFFNESS - MASS * omega**2 + 1j * DAMPING * omega)
    x = 20.0 * np.imag(ratio * np.exp(1j * omega * (time - late)))
    return np.column_stack([time, x, 20.0 * np.sin(omega * time)])


@pytest.mark.acceptance
def test_a_delay_that_is_known_to_so_much_is_fitted(tmp_path):
    """Within its standard deviation it is no cause, and is told with its error."""
    channels = FORCE.replace('unit = "N"', 'unit = "N", delay_ms = 1.0, delay_std_ms = 2.0')
    path = save(tmp_path, "loop", channels, FRICTION, loops(late=DELAY))
    measurement = api.read_measurement(path)
    assert measurement.delay_std == pytest.approx(2e-3)
    found = api.diagnose_measurement(measurement, effects=CANDIDATES, n_jobs=1)
    assert found.verdict == "nothing-missing"
    delay = found.document["uncertain"]["channel_delay"]
    assert delay["time_s"] == pytest.approx(DELAY - 1e-3, rel=0.01)
    assert delay["time_s_std"] < 1e-4
