"""Spread between repeats of a test, beside noise and errors of the model."""

from dataclasses import replace

import numpy as np
import pytest

from tests.diagnose.rigs import FORCE, HEAD, LOOP, PLACE, oscillator, saved
from wedgesweep import api, report
from wedgesweep.diagnose.repeats import spread_of

MODEL = oscillator(mass_kg=1.0, spring_N_per_mm=0.2, normal_force_N=10.0)
SPREAD, NOISE, FRICTION, OMEGA = 0.03, 0.01, 3.0, 2.0 * np.pi
AMPLITUDES, RUNS = (0.01, 0.02), 5
CANDIDATES = ("friction_level", "viscous_damping", "cubic_stiffness", "stribeck", "directional_friction")


def force_of(amplitude, time, gain=1.0, damper=0.0):
    x, v = amplitude * np.sin(OMEGA * time), amplitude * OMEGA * np.cos(OMEGA * time)
    return (200.0 - OMEGA**2) * x + gain * FRICTION * np.sign(v) + damper * v


def loops(folder, spread=SPREAD, damper=0.0, more="", seed=1):
    """Loops at 1 Hz, RUNS of each amplitude (m), each run with friction of its own gain; and these gains."""
    random, time, tests, gains = np.random.default_rng(seed), np.arange(2000) / 500.0, {}, []
    for amplitude in AMPLITUDES:
        for run in range(RUNS):
            gains.append(1.0 + spread * random.standard_normal())
            force = force_of(amplitude, time, gains[-1], damper)
            force = force + NOISE * force.std() * random.standard_normal(time.size)
            columns = time, 1e3 * amplitude * np.sin(OMEGA * time), force
            tests[f"{1e3 * amplitude:g}-{run}"] = columns, LOOP + more
    return saved(folder, MODEL, HEAD + PLACE + FORCE, "t,x,F", tests), np.reshape(gains, (2, RUNS))


def test_the_spread_that_was_hidden_is_recovered(tmp_path):
    """A gain of friction moves the response by friction's share of it; it does so by chance in few runs."""
    time = np.arange(500) / 500.0
    sizes = [force_of(amplitude, time).std() for amplitude in AMPLITUDES]
    shares = [SPREAD * FRICTION / size for size in sizes]
    inside = 0
    for seed in range(4):
        path, gains = loops(tmp_path, seed=seed)
        found = spread_of(api.read_measurement(path))
        drawn = np.sqrt(
            np.mean(
                [(FRICTION * own.std(ddof=1) / size) ** 2 for own, size in zip(gains, sizes, strict=True)]
            )
        )
        assert found.share == pytest.approx(drawn, rel=0.1)
        low, high = found.interval
        inside += low <= np.sqrt(np.mean(np.square(shares))) <= high
    assert inside >= 3
    assert [len(names) for names in found.repeats] == [RUNS, RUNS]


def test_noise_alone_is_no_spread(tmp_path):
    found = [spread_of(api.read_measurement(loops(tmp_path, 0.0, seed=seed)[0])) for seed in range(2)]
    assert not any(each.counts for each in found)
    assert all(each.share < 0.3 * NOISE for each in found)


def steady(folder, keys, thirds=(0.1, 0.12, 0.08), amplitudes=(1.0, 1.0, 1.0)):
    """Steady records with any phase, whose third harmonic differs, and whose size goes with the input."""
    random, tests = np.random.default_rng(2), {}
    for run, (third, size) in enumerate(zip(thirds, amplitudes, strict=True)):
        time = np.arange(2000) / 400.0
        phase = OMEGA * 2.0 * time + 2.0 * np.pi * random.random()
        x = size * (np.sin(phase) + third * np.sin(3.0 * phase)) + 1e-3 * random.standard_normal(time.size)
        u = 2.0 * size * np.sin(phase + 0.3)
        tests[f"run-{run}"] = (time, x, u), f"frequency_hz = 2.0\n{keys}"
    recorded = 'input = { column = "u", unit = "mm", quantity = "displacement" }\n'
    head = HEAD + PLACE + ("" if "amplitude_mm" in keys else recorded)
    return api.read_measurement(saved(folder, MODEL, head, "t,x,u", tests))


def test_steady_tests_repeat_one_another_where_the_input_is_known(tmp_path):
    """Whatever their phase; what the recorded input explains is no spread, nor are inputs that may differ."""
    expected = pytest.approx(0.02 / np.sqrt(1.0 + 0.1**2), rel=0.03)
    assert spread_of(steady(tmp_path, "amplitude_mm = 2.0\n")).share == expected
    assert spread_of(steady(tmp_path, "", amplitudes=(1.0, 1.005, 0.995))).share == expected
    assert spread_of(steady(tmp_path, "amplitude_mm = 2.0\namplitude_std = 0.05\n")) is None
    assert spread_of(steady(tmp_path, "", amplitudes=(1.0, 1.1, 1.2))) is None


def test_where_nothing_repeats_there_is_no_spread(tmp_path):
    path, _ = loops(tmp_path)
    first = api.read_measurement(path)
    path.write_text(path.read_text().replace('10-1.csv"\n', '10-1.csv"\nrepeat_of = "10-0.csv"\n'))
    # Of tests with repeat_of all that differs is in the noise already.
    assert sorted(map(len, spread_of(api.read_measurement(path)).repeats)) == [3, RUNS]
    different = [dict(test.model, **{"oscillator.mass_kg": 1.0 + i}) for i, test in enumerate(first.tests)]
    tests = tuple(replace(test, model=own) for test, own in zip(first.tests, different, strict=True))
    assert spread_of(replace(first, tests=tests)) is None


def test_tests_that_differ_by_more_than_runs_do_are_told_to_state_why(tmp_path):
    """As under another pressure in each."""
    measurement = api.read_measurement(loops(tmp_path, 0.4)[0])
    found = spread_of(measurement)
    assert found.interval[0] > 0.1
    assert found.allowed_in(measurement) is measurement


@pytest.mark.acceptance
@pytest.mark.parametrize(("damper", "verdict"), [(0.0, "nothing-missing"), (12.0, "named")])
def test_a_spread_is_no_cause_and_hides_none(tmp_path, damper, verdict):
    path, _ = loops(tmp_path, damper=damper)
    found = api.diagnose_measurement(api.read_measurement(path), effects=CANDIDATES, n_jobs=1)
    assert found.verdict == verdict
    assert [cause["effect"] for cause in found.causes] == ([] if not damper else ["viscous_damping"])
    base, *_, best = found.document["ladder"]
    assert best["model_share"] < found.document["repeats"]["share"]
    assert (base["model_share"] > found.document["repeats"]["share"]) == bool(damper)
    found.write(tmp_path / "found")
    assert "what differs between repeats of a test" in report.sentence(tmp_path / "found")
