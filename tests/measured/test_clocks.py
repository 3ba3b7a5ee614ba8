"""Records of every clock are brought to an even one; what was done is told, and what is wrong refused."""

import re

import numpy as np
import pytest
from scipy.signal import lfilter, lsim

from tests import fixture_measured
from tests.diagnose import test_loops
from tests.fixture_measured import MEASURED, csv_lines, vibration
from wedgesweep import measured
from wedgesweep.diagnose.noise_bins import noise_of_record
from wedgesweep.diagnose.noise_spectrum import periodogram
from wedgesweep.measured import consistency
from wedgesweep.measured.clock import fit_clock, resolution
from wedgesweep.measured.even import evened
from wedgesweep.measured.signals import Signal, stuck_samples

RANDOM = np.random.default_rng(5)


def read(directory, rows, keys="", old="", new=""):
    text = MEASURED.replace(old, new, 1) + keys if old else MEASURED + keys
    return measured.read(fixture_measured.write(directory, text, csv=rows)).tests[0]


def rows_of(t, d, v, decimals=7):
    return ["t,d,v", *(f"{a:.{decimals}f},{b},{c}" for a, b, c in zip(t, d, v, strict=True))]


def true_signal(time):
    """Displacement (m) of the made-up vibration without noise."""
    phase = 2.0 * np.pi * 20.0 * time + 0.7
    return 1e-3 * (5.0 + np.cos(phase) + 0.3 * np.sin(3.0 * phase))


def at(time):
    """Displacement (mm) and velocity (mm/s) at times (s), without noise."""
    phase = 2.0 * np.pi * 20.0 * time + 0.7
    return 1e3 * true_signal(time), 40.0 * np.pi * (-np.sin(phase) + 0.9 * np.cos(3.0 * phase))


EVEN = np.arange(1000) / 1000.0


@pytest.mark.parametrize(
    ("stamps", "sampled", "words"),
    [
        (EVEN + 2e-4 * RANDOM.uniform(-1, 1, 1000), None, "interpolated evenly"),
        (EVEN + 2e-4 * RANDOM.uniform(-1, 1, 1000), EVEN, "they are taken to be even"),
        (np.cumsum(RANDOM.uniform(0.6e-3, 1.4e-3, 1000)), None, "interpolated evenly"),
        (np.delete(EVEN, [300, 301, 700]), None, "3 samples lost, the first after 0.299 s"),
        (EVEN * (1.0 + 0.004 * EVEN), None, "interpolated evenly"),
        (np.round(EVEN * 0.3, 3), EVEN * 0.3, "time stamps are rounded to 3.3 of a step: a rate of 3333.3"),
    ],
    ids=["jitter of the sampling", "jitter of the stamps", "uneven", "lost", "drift", "rounded"],
)
def test_samples_are_where_they_were_taken(tmp_path, stamps, sampled, words):
    test = read(tmp_path, rows_of(stamps, *at(stamps if sampled is None else sampled)))
    assert np.ptp(np.diff(test.time)) < 1e-9
    assert np.abs(test.displacement - true_signal(test.time)).max() < 2e-5
    assert any(words in remark for remark in test.remarks), test.remarks


def test_a_rate_that_drifts_slowly_is_followed_whatever_the_noise(tmp_path):
    """Neighbours are as smooth over one clock as over the other; the motion as a whole is not."""
    stamps = EVEN + 6e-4 * EVEN * (1.0 - EVEN)
    for seed in range(4):
        noise = np.random.default_rng(seed).normal(0.0, [[0.05], [5.0]], (2, 1000))
        test = read(tmp_path, rows_of(stamps, *(np.array(at(stamps)) + noise)))
        assert any("interpolated evenly" in remark for remark in test.remarks)
        left = test.displacement - true_signal(test.time)
        assert left.std() < 1.1 * 0.05e-3


def test_frames_that_a_noisy_video_lost_are_made_up():
    """Five of them, a tenth of a swing: what they add to the noise of the record is next to nothing."""
    t, random = np.arange(360) / 30.0, np.random.default_rng(3)
    angle = 25.0 * (1.0 - t / 13.0) * np.cos(3.13 * t) + 0.12 * random.normal(size=t.size)
    for lost, size in (5, 360), (40, 220):
        kept = np.r_[0:100, 100 + lost : 360]
        signal = Signal(t[kept], angle[kept], np.full(kept.size, 1e-6), str)
        assert evened({"displacement": signal}).time.size == size


@pytest.mark.parametrize("jitter", [0.0, 0.1, 0.3])
@pytest.mark.parametrize("lost", [0, 2, 4])
def test_the_error_of_interpolation_is_what_is_told(jitter, lost):
    stamps = EVEN + 1e-3 * jitter * np.random.default_rng(2).uniform(-1, 1, 1000)
    kept = np.r_[0:400, 400 + lost : 1000]
    signal = Signal(stamps[kept], true_signal(stamps[kept]), np.full(kept.size, 1e-9), str)
    found = evened({"displacement": signal})
    left = (found.columns["displacement"] - true_signal(found.time))[5:-5]
    error = np.abs(left).max() / true_signal(EVEN).std()
    told = re.findall("an error of about (.*) % of displacement", "; ".join(found.remarks))
    assert told or error < 1e-9
    if told:
        assert 0.25 < 100.0 * error / float(told[0]) < 4.0


@pytest.mark.few(2)
@pytest.mark.parametrize("per_swing", [15, 30, 60])
@pytest.mark.parametrize("jitter", [0.1, 0.3])
def test_the_noise_of_a_record_holds_the_error_of_interpolation(per_swing, jitter):
    """The noise is read from the interpolated record, so that fits know this error; no other noise here."""

    def swings(time):
        """Free motion with dry friction: each half swing is a cosine about a centre on the side it leaves."""
        half = np.floor(2.0 * time)
        return (1.0 - 0.05 * (2.0 * half + 1.0)) * np.cos(2.0 * np.pi * time) + 0.05 * (-1.0) ** half

    powers = []
    for seed in range(8):
        stamps = np.arange(7.5 * per_swing) / per_swing
        stamps += jitter / per_swing * np.random.default_rng(seed).uniform(-1, 1, stamps.size)
        signal = Signal(stamps, swings(stamps), np.full(stamps.size, 1e-9), str)
        found = evened({"displacement": signal})
        frequency, error = periodogram(found.columns["displacement"] - swings(found.time))
        noise = noise_of_record(found.columns["displacement"])(frequency)
        of_motion = frequency < 2.0 * np.pi * 5.0 / per_swing
        powers.append((error[of_motion].mean(), noise[of_motion].mean()))
    error, noise = np.mean(powers, axis=0)
    assert 0.0 < error < 2.0 * noise


def test_a_pause_ends_the_part_that_is_used(tmp_path):
    kept = (EVEN < 0.3) | (EVEN > 0.36)
    test = read(tmp_path, rows_of(EVEN[kept], *at(EVEN[kept])))
    assert test.time[[0, -1]] == pytest.approx([0.361, 0.999])
    assert "1 pause, the longest of 0.062 s after 0.299 s" in "; ".join(test.remarks)


def test_doubled_stamps_are_averaged(tmp_path):
    place = np.sort(np.append(np.arange(1000), [20, 500]))
    test = read(tmp_path, rows_of(EVEN[place], *at(EVEN[place])))
    assert test.time.size == 1000
    assert test.remarks == ("2 doubled time stamps: their samples are averaged",)


@pytest.mark.parametrize("cell", ["", "NA", "NaN", "#N/A", "-9999"])
def test_missing_samples_are_interpolated(tmp_path, cell):
    rows = rows_of(EVEN, *at(EVEN))
    t, _, v = rows[400].split(",")
    rows[400] = f"{t},{cell},{v}"
    keys = 'displacement = { column = "d", unit = "mm", missing = ["-9999"] }'
    test = read(tmp_path, rows, "", 'displacement = { column = "d", unit = "mm" }', keys)
    assert np.abs(test.displacement - true_signal(test.time)).max() < 1e-6
    assert any("1 sample lost" in remark for remark in test.remarks)


def test_a_number_that_stands_for_missing_samples_is_told(tmp_path):
    d, v = at(EVEN)
    d[100:900:80] = -9999.0
    with pytest.raises(
        measured.MeasuredError, match=r'-9999 occurs 10 times, .* write missing = \["-9999"\]'
    ):
        read(tmp_path, rows_of(EVEN, d, v))


def test_channels_of_other_rates_meet_on_the_clock_of_the_response(tmp_path):
    fast = np.arange(5000) / 5000.0
    rows = [(t, f"{d:.9g}", "") for t, d in zip(EVEN, at(EVEN)[0], strict=True)]
    rows += [
        (t, "", f"{v + 30.0 * np.sin(2.0 * np.pi * 1980.0 * t):.9g}")
        for t, v in zip(fast, at(fast)[1], strict=True)
    ]
    lines = ["t,d,v", *(f"{t:.4f},{d},{v}" for t, d, v in sorted(rows))]
    test = read(tmp_path, lines)
    assert test.time.size == pytest.approx(1000, abs=2)
    inner = slice(20, -20)
    assert np.abs(test.velocity - 1e-3 * at(test.time)[1])[inner].max() < 2e-3  # 1,980 Hz would fold to 20 Hz
    assert "of velocity (recorded at 5000 Hz)" in "; ".join(test.remarks)


UNITS = {
    "ISO 8601": ("datetime", lambda t: f"2024-10-27T{int(t * 1e-9):02d}:59:{1.5 + t:09.6f}+02:00"),
    "ISO 8601, unstated": ("s", lambda t: f"2024-10-27 01:00:{1.5 + t:09.6f}"),
    "days of Excel": ("excel", lambda t: f"{45592.0832 + t / 86400.0:.12f}"),
    "since 1970": ("epoch", lambda t: f"{1729987200.0 + t:.4f}"),
    "milliseconds since 1970": ("ms", lambda t: f"{1729987200000.0 + 1e3 * t:.1f}"),
    "minutes": ("min", lambda t: f"{t / 60.0:.10f}"),
    "microseconds": ("us", lambda t: f"{1e6 * t:.0f}"),
}


@pytest.mark.parametrize("form", UNITS)
def test_units_of_time(tmp_path, form):
    unit, written = UNITS[form]
    rows = ["t,d,v", *(f"{written(t)},{d},{v}" for t, d, v in zip(EVEN, *at(EVEN), strict=True))]
    test = read(tmp_path, rows, "", '"s"', f'"{unit}"')
    np.testing.assert_allclose(test.time - test.time[0], EVEN, atol=1e-5)
    assert abs(test.time[0]) < 1e-5


def test_intervals_and_rates(tmp_path):
    rows = ["t,d,v", *(f"0.001,{d},{v}" for d, v in zip(*at(EVEN), strict=True))]
    test = read(tmp_path, rows, "", 'unit = "s"', 'unit = "s", interval = true')
    np.testing.assert_allclose(test.time, EVEN, atol=1e-9)
    text = MEASURED.replace('time = { column = "t", unit = "s" }\n', "")
    path = fixture_measured.write(
        tmp_path, text.replace("[measurement]\n", "[measurement]\nrate_hz = 1000\n", 1), csv=rows
    )
    np.testing.assert_allclose(measured.read(path).tests[0].time, EVEN, atol=1e-9)


def test_scale_sign_delay_and_another_file(tmp_path):
    (tmp_path / "other.csv").write_text("\n".join(f"{-0.5 * v}" for v in at(EVEN)[1]))
    new = 'velocity = { column = 1, unit = "mm/s", file = "other.csv", rate_hz = 1000, scale = 2, sign = -1 }'
    late = at(EVEN - 0.005)[0]
    rows = rows_of(EVEN, late, late)
    test = read(
        tmp_path,
        rows,
        "",
        'velocity = { column = "v", unit = "mm/s" }',
        new.replace("= 2,", "= 2, delay_ms = -5,"),
    )
    np.testing.assert_allclose(test.velocity, 1e-3 * at(test.time - 0.005)[1], atol=1e-4)


def test_keys_of_one_test_override_those_of_the_channel(tmp_path):
    rows = ["t,d,v", *(f"{t},{d},{-v}" for t, d, v in zip(EVEN, *at(EVEN), strict=True))]
    test = read(tmp_path, rows, "columns.velocity.sign = -1\n")
    np.testing.assert_allclose(test.velocity, 1e-3 * at(test.time)[1], atol=1e-9)


def test_runs_side_by_side_in_one_file_are_tests_of_their_own(tmp_path):
    d, v = at(EVEN)
    short = 800  # the second run ends early
    first = [f"{t},{a},{b}" for t, a, b in zip(EVEN, d, v, strict=True)]
    second = [
        f"{t},{-a},{-b}" if i < short else ",," for i, (t, a, b) in enumerate(zip(EVEN, d, v, strict=True))
    ]
    rows = [f"{left},{right}" for left, right in zip(first, second, strict=True)]
    path = fixture_measured.write(tmp_path, csv=["t,d,v,t,d,v", *rows])
    text = MEASURED
    for name in "tdv":
        text = text.replace(f'"{name}"', f'"{name}#1"')
    channels = zip(("time", "displacement", "velocity"), "tdv", strict=True)
    keys = "".join(f'columns.{channel}.column = "{name}#2"\n' for channel, name in channels)
    path.write_text(f'{text}[[measurement.test]]\nfile = "one.csv"\n{keys}')
    one, two = measured.read(path).tests
    assert (one.file, two.file) == ("one.csv", "one.csv#2")
    assert (one.time.size, two.time.size) == (1000, short)
    np.testing.assert_allclose(two.displacement, -one.displacement[:short], atol=1e-12)


def test_an_override_of_a_channel_that_is_not_there_is_told(tmp_path):
    with pytest.raises(measured.MeasuredError, match=r"test\[0\].columns.force: no such channel"):
        read(tmp_path, rows_of(EVEN, *at(EVEN)), "columns.force.sign = -1\n")


KEYS = {
    "sign": ("sign = 0.5", "velocity.sign: 0.5 is out of range; it must be 1 or -1"),
    "scale": ("scale = 0", "velocity.scale: 0 is out of range; it must be another number than 0"),
    "missing": ('missing = "NA"', 'velocity.missing: "NA" is no list of strings'),
    "delay_std_ms": (
        "delay_std_ms = 0",
        "velocity.delay_std_ms: 0 is out of range; it must be greater than 0",
    ),
    "delay_std_ms of a response": (
        "delay_std_ms = 1",
        "velocity.delay_std_ms: only a delay of force, input or their only response is fitted",
    ),
}


@pytest.mark.parametrize("key", KEYS)
def test_faults_of_keys(tmp_path, key):
    keys, words = KEYS[key]
    with pytest.raises(measured.MeasuredError) as caught:
        read(tmp_path, csv_lines(*vibration()), "", 'unit = "mm/s"', f'unit = "mm/s", {keys}')
    assert words in str(caught.value)


def test_faulty_cells_count_where_they_are_used(tmp_path):
    rows = [*rows_of(EVEN, *at(EVEN))[:-3], *("0.999,x,y" for _ in range(3))]
    assert read(tmp_path, rows, "to_s = 0.9\n").time[-1] == pytest.approx(0.9)
    with pytest.raises(measured.MeasuredError, match='"x" is not a finite number'):
        read(tmp_path, rows)


def test_a_step_of_phase_is_told_as_one(tmp_path):
    kept = np.delete(np.arange(1000), 400)
    values = [each[kept] + 0.002 * RANDOM.standard_normal(999) for each in at(EVEN)]
    with pytest.raises(
        measured.MeasuredError, match=r"a step of phase of 7.2 degrees near 0\.[34]\d* s, as 1 lost"
    ):
        read(tmp_path, rows_of(EVEN[:-1], *values))


@pytest.mark.parametrize(("rate", "decimals"), [(1000.0, 3), (3000.0, 4), (2038.8, 4), (1 / 0.0015, 3)])
def test_rounded_stamps_are_an_even_grid(rate, decimals):
    times = 2.0 + np.arange(3000) / rate
    rounded = np.round(times, decimals)
    clock = fit_clock(rounded, resolution(rounded))
    assert clock.exact
    assert not clock.gaps.any()
    assert np.abs(clock.places - times).max() < 0.6 * 10.0**-decimals
    # One sample missing shows all the same.
    rounded = np.delete(rounded, 1700)
    assert np.flatnonzero(fit_clock(rounded, resolution(rounded)).gaps).tolist() == [1699]


def test_stamps_of_limited_digits():
    stamps = np.array([float(f"{t:.5g}") for t in np.arange(4000) / 700.0])
    assert resolution(stamps)[[10, 100, -1]] == pytest.approx([1e-6, 1e-5, 1e-4])
    assert fit_clock(stamps, resolution(stamps)).exact


DRIVEN = """\
[measurement]
model = "model.toml"
[measurement.columns]
time = { column = "t", unit = "s" }
displacement = { column = "d", unit = "mm", of = "absolute" }
input = { column = "v", unit = "N", quantity = "force" }
[[measurement.test]]
file = "one.csv"
kind = "transient"
"""
MASS, SPRING, DAMPING = 2.0, 800.0, 6.0


@pytest.mark.parametrize(("late", "used"), [(0.0, 20.0), (0.015, 20.0), (-0.01, 20.0), (0.015, 1.1)])
def test_a_delay_of_the_force_of_a_transient_is_told(tmp_path, late, used):
    """The force is random, the mass on a spring and a damper: no period, and no loop."""
    time, random = np.arange(4000) / 200.0, np.random.default_rng(7)
    force = lfilter([0.1], [1.0, -0.9], random.standard_normal(time.size)) * 10.0
    displacement = 1e3 * lsim(([1.0], [MASS, DAMPING, SPRING]), force, time)[1]
    displacement += 0.005 * displacement.std() * random.standard_normal(time.size)
    own = f"mass_kg = {MASS}\nspring_N_per_mm = {1e-3 * SPRING}\ndamping_N_s_per_m = {DAMPING}"
    sweep = 'friction_law = "coulomb"\nexcitation = "force"\nfrequency_hz = 1.0\namplitude_N = 1.0'
    model = f"[oscillator]\n{own}\nnormal_force_N = 0.0\n[sweep]\n{sweep}\n"
    rows = csv_lines(time, displacement, np.interp(time - late, time, force))
    path = fixture_measured.write(tmp_path, f"{DRIVEN}to_s = {used}\n", model, rows)
    warnings = consistency.warnings(measured.read(path))
    if late == 0.0 or used < 4.0 * 2.0 * np.pi * np.sqrt(MASS / SPRING):  # few periods, which anything fits
        assert warnings == []
        return
    (warning,) = warnings
    assert f"input seems to be {'late' if late > 0.0 else 'early'} by" in warning
    told = float(re.search(r"delay_ms = (\S+) at input", warning)[1])
    assert told == pytest.approx(1e3 * late, rel=0.1)


@pytest.mark.parametrize("model", [test_loops.OSCILLATOR, test_loops.WEDGE], ids=["oscillator", "wedge"])
def test_a_force_that_gives_out_energy_has_the_wrong_sign(tmp_path, model):
    amplitude = 0.01 if model == test_loops.OSCILLATOR else 2e-4
    path = test_loops.write(tmp_path, model, motions=((amplitude, 1.5, 10.0),), noise=(1e-8, 0.01))
    assert consistency.warnings(measured.read(path)) == []
    path.write_text(path.read_text().replace('unit = "N"', 'unit = "N", sign = -1'))
    (told,) = consistency.warnings(measured.read(path))
    assert "loop0.csv: force gives out energy" in told
    assert "write sign = -1 at force in [measurement.columns]" in told


def test_a_sensor_that_hangs_lacks_samples_and_one_that_rests_does_not():
    t = np.arange(2000) / 200.0
    x = np.sin(3.0 * t) + 1e-3 * np.random.default_rng(0).normal(size=t.size)
    hung = np.where((t > 4.0) & (t < 4.2), x[800], x)
    assert np.flatnonzero(stuck_samples(hung)).tolist() == list(range(801, 840))
    assert not stuck_samples(x).any()
    assert not stuck_samples(np.clip(x, -0.9, 0.9)).any()
    resting = np.clip(np.abs(t - 5.0), 1.0, None) + np.where(np.abs(t - 5.0) > 1.0, 1e-4 * x, 0.0)
    assert not stuck_samples(resting).any()
    assert not stuck_samples(np.round(x, 1)).any()
