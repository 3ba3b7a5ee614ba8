"""Records that are not steady are refused, and what is odd in usable ones is told, with its number."""

import re

import numpy as np
import pytest

from tests import fixture_measured
from tests.command import invoke
from tests.fixture_measured import FREQUENCY, MEASURED, csv_lines, vibration
from wedgesweep import measured
from wedgesweep.measured.quality import warnings
from wedgesweep.measured.stationarity import stationarity

BOTH = (1.0, 2.0 * np.pi * FREQUENCY)  # the same disturbance of displacement (mm) and velocity (mm/s)


def written(directory, change, keys="", periods=20.3):
    """A measurement of the made-up vibration after ``change(t, d, v)``, with more keys of its test."""
    t, d, v = vibration(periods=periods)
    changed = change(t, d, v)
    return fixture_measured.write(directory, MEASURED + keys, csv=csv_lines(t, *changed))


def only_fault(path):
    with pytest.raises(measured.MeasuredError) as caught:
        measured.read(path)
    (found,) = caught.value.problems
    return found


def told(path):
    (test,) = measured.read(path).tests
    return warnings(test)


def scaled(factor):
    return lambda t, d, v: (5.0 + factor(t) * (d - 5.0), factor(t) * v)


def swept(t, d, v):
    phase = 2.0 * np.pi * FREQUENCY * (0.5 * t + 0.5 * t**2 / t[-1])
    return np.cos(phase) + 1e-3 * d, 2.0 * np.pi * FREQUENCY * (-np.sin(phase) + 1e-3 * v)


UNSTEADY = {
    "ring-down": (scaled(lambda t: np.exp(-3.0 * t)), "% of its largest in the four quarters"),
    "ramp-up": (scaled(lambda t: t / t[-1]), "% of its largest in the four quarters"),
    "slow ring-down": (
        scaled(lambda t: np.exp(-0.5 * t)),
        "the amplitude of displacement changes by -5",
    ),
    "lost samples": (
        lambda t, d, v: (np.where(t == t[500], 999.0, d), v),
        "of its power lies in 2 of 1015 samples: correct these",
    ),
    "late start": (scaled(lambda t: (t > 0.3 * t[-1]) + 0.0), "% of its largest in the four quarters"),
    "swept sine": (swept, "moves to other frequencies (median 1"),
}


@pytest.mark.parametrize("kind", UNSTEADY)
def test_what_is_not_steady_is_refused(tmp_path, kind):
    change, words = UNSTEADY[kind]
    found = only_fault(written(tmp_path, change))
    assert words in found
    assert "from_s, to_s" in found or kind == "lost samples"


def test_noise_alone_is_refused_with_and_without_a_frequency(tmp_path):
    random = np.random.default_rng(4)

    def noise(t, d, v):
        return random.normal(size=(2, t.size)) * np.array([BOTH]).T

    assert "no test has a vibration at its frequency (20 Hz)" in only_fault(written(tmp_path, noise))
    text = MEASURED.replace("frequency_hz = 20.0\n", "")
    for _ in range(20):
        csv = csv_lines(t := vibration()[0], *noise(t, t, t))
        found = only_fault(fixture_measured.write(tmp_path, text, csv=csv))
        assert "stands out of the noise" in found or "at least 4 are needed" in found


def spiked(t, d, v):
    d[100] += 1.0
    return d, v


def torn(t, d, v):
    """Two outliers of which each alone makes all other periods seem far off."""
    d[[100, 731]] += 4.0, -9.0
    return d, v


ODD = {
    "trend": (scaled(lambda t: 1.0 + 0.05 * t / t[-1]), "displacement: its amplitude changes by +4"),
    "drift": (lambda t, d, v: (d + 0.5 * t / t[-1], v), "displacement: its mean drifts by +6"),
    "spike": (spiked, "displacement: 1 sample is far from the other periods, the worst at 0.1 s by 5"),
    "large spikes": (
        torn,
        "displacement: 2 samples are far from the other periods, the worst at 0.731 s",
    ),
    "clipping": (lambda t, d, v: (np.clip(d, None, 5.8), v), "% of its samples are exactly at its extreme"),
}


@pytest.mark.parametrize("kind", ODD)
def test_what_is_odd_is_told_with_its_number(tmp_path, kind):
    change, words = ODD[kind]
    found = told(written(tmp_path, change))
    assert any(words in each for each in found), found
    assert told(written(tmp_path, lambda t, d, v: (d, v))) == []


def test_check_warns_of_noise_by_the_share_in_its_table(tmp_path):
    rng = np.random.default_rng(1)
    said = invoke("check", written(tmp_path, lambda t, d, v: (d + 0.3 * rng.normal(size=t.size), v)))
    (share,) = re.findall(r"noise is (\d+) % of the displacement; average it down, or excite more", said)
    assert f" mm ({share} %)" in said


def test_keys_of_a_test_mend_its_record(tmp_path):
    late = UNSTEADY["late start"][0]
    path = written(tmp_path, late, "from_s = 0.4\nto_s = 0.9\n")
    (test,) = measured.read(path).tests
    assert (test.time[0], test.time[-1]) == pytest.approx((0.4, 0.9))
    assert warnings(test) == ["0.501 s of 1.014 s are used (from_s, to_s)"]
    assert told(written(tmp_path, ODD["drift"][0], "detrend = true\n")) == []


def test_detrend_removes_a_drift_and_nothing_of_a_vibration(tmp_path):
    """A straight line through periods that are not whole is a part of the vibration itself."""
    for drift in (0.0, 2.0):
        for periods in (6.8, 7.5, 20.3):

            def drifting(t, d, v, drift=drift):
                return d + drift * t / t[-1], v

            path = written(tmp_path, drifting, "detrend = true\n", periods=periods)
            (found,) = measured.read(path).tests
            clean = 1e-3 * vibration(periods=periods)[1]
            left = found.displacement - clean
            assert np.ptp(left) < 0.03 * clean.std()
            assert warnings(found) == []


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ("from_s = 0.9\nto_s = 0.4\n", "test[0].to_s: 0.4 is not after from_s = 0.9"),
        ("from_s = 3.0\n", "test[0].from_s: 3, but"),
        ("to_s = -3.0\n", "goes from 0 to 1.014 s; choose a time within"),
        ("from_s = 0.9\n", "one.csv: covers 2.3 periods of 20 Hz; at least 4 are needed"),
    ],
)
def test_faults_of_these_keys(tmp_path, keys, words):
    assert words in only_fault(written(tmp_path, lambda t, d, v: (d, v), keys))


@pytest.mark.parametrize("sweep", [0.1, 0.3, 1.0])
def test_any_sweep_is_refused_by_its_spectrum_or_by_its_phases(tmp_path, sweep):
    def chirp(t, d, v):
        turns = FREQUENCY * (t + 0.5 * sweep * t * (t / t[-1] - 1.0))
        phase = 2.0 * np.pi * turns
        return np.cos(phase) + 1e-3 * d, 2.0 * np.pi * FREQUENCY * (-np.sin(phase) + 1e-3 * v)

    assert "frequenc" in only_fault(written(tmp_path, chirp, periods=30.0))


def test_two_tones_are_stationary_and_a_beat_shorter_than_the_record_too():
    t = np.arange(4000) / 1000.0
    found = stationarity(np.cos(2.0 * np.pi * 10.0 * t) + np.cos(2.0 * np.pi * 13.3 * t), 1000.0)
    assert found.moved < 0.02
    assert found.level_ratio < 1.2


def test_a_half_without_any_motion():
    """Its spectrum is not known; its level tells that the record is not steady."""
    t = np.arange(1000) / 1000.0
    found = stationarity(np.where(t < 0.5, np.cos(2.0 * np.pi * 20.0 * t), 0.0), 1000.0)
    assert np.isnan(found.moved)
    assert found.level_ratio > 100.0


def test_where_there_is_no_noise_rounding_makes_no_outliers(tmp_path):
    t = np.arange(1015) / 1000.0
    phase = 2.0 * np.pi * FREQUENCY * t
    d = np.round(np.cos(phase), 5)
    d[500] += 1e-4
    rows = csv_lines(t, d, -2.0 * np.pi * FREQUENCY * np.sin(phase))
    assert told(fixture_measured.write(tmp_path, csv=rows)) == []


def test_check_prints_the_warnings(tmp_path):
    printed = invoke("check", written(tmp_path, spiked))
    assert "warning: one.csv: displacement: 1 sample is far" in printed
