"""Noise of transients at the frequencies of the motion, where a record does not show it alone."""

import numpy as np
import pytest
from scipy.signal import lfilter

from tests.diagnose.answers import diagnosed
from tests.diagnose.test_transients import HIDDEN, coloured, write
from wedgesweep.diagnose.noise_spectrum import periodogram
from wedgesweep.diagnose.transient.channel_differences import differences
from wedgesweep.diagnose.transient.noise import noise_of_channels

# Samples in a natural period of 1 s, and natural circular frequency in rad a sample.
RATE = 60.0
NATURAL = 2.0 * np.pi / RATE
AT = NATURAL * np.array([0.5, 1.0, 2.0, 5.0])
LEVEL = 0.005
POLES = (0.0, 0.5, 0.9)


def decay(friction, samples=480, start=1.0):
    """Displacement and velocity of a mass on a spring of period 1, which rubs; exact (Coulomb)."""
    omega, time = 2.0 * np.pi, np.arange(samples) / RATE
    x, v = np.zeros(samples), np.zeros(samples)
    turn = start
    for swing in range(2 * samples):
        own = (time >= 0.5 * swing) & (time < 0.5 * (swing + 1))
        if abs(turn) <= friction:
            x[time >= 0.5 * swing] = turn
            break
        rest = np.sign(turn) * friction
        angle = omega * (time[own] - 0.5 * swing)
        x[own] = rest + (turn - rest) * np.cos(angle)
        v[own] = -omega * (turn - rest) * np.sin(angle)
        turn = 2.0 * rest - turn
    return x, v


def acceleration(friction, samples=480, start=1.0):
    """Acceleration of the same mass, which jumps where friction changes its sign."""
    x, v = decay(friction, samples, start)
    swinging = np.arange(samples) / RATE < 0.5 * np.ceil((abs(start) / friction - 1.0) / 2.0)
    return np.where(swinging, -((2.0 * np.pi) ** 2) * (x + friction * np.sign(v)), 0.0)


def power(std, pole, frequency):
    """Power of noise whose samples are correlated by ``pole``."""
    return std**2 * (1.0 - pole**2) / (1.0 + pole**2 - 2.0 * pole * np.cos(frequency))


def noisy(clean, pole, rng, level=LEVEL):
    return clean + level * clean.std() * coloured(rng, clean.size, pole)


def ratios(pole, seed, orders):
    """Noise that was found over the true one, (tests, channels, frequencies)."""
    rng = np.random.default_rng(seed)
    clean = [decay(0.04), decay(0.06, start=-0.7), decay(0.03, start=0.5), decay(0.01, samples=1440)]
    tests = [{order: noisy(each[order], pole, rng) for order in orders} for each in clean]
    found = noise_of_channels(tests, dict.fromkeys(orders, "relative"), [RATE] * len(tests))
    return np.array(
        [
            [found[t, order](AT) / power(LEVEL * each[order].std(), pole, AT) for order in orders]
            for t, each in enumerate(clean)
        ]
    )


def test_two_channels_of_a_motion_leave_nothing_between_them():
    x, v = decay(0.05)
    left = differences([(x, v)], 1, RATE)[0].power
    # Kinks have frequencies beyond half the sampling rate.
    assert left.max() < 1e-6 * periodogram(v)[1].max()


def test_a_gain_and_a_lag_of_a_sensor_are_no_noise():
    pairs, lag = [], 0.01
    for friction in (0.03, 0.05):
        fine = 40
        x, v = decay(friction)
        many = np.interp(np.arange(x.size * fine) / fine, np.arange(x.size), v)
        kept = np.exp(-1.0 / (RATE * fine * lag))
        pairs.append((1.2 * x, lfilter([1.0 - kept], [1.0, -kept], many)[::fine]))
    for (_, v), each in zip(pairs, differences(pairs, 1, RATE), strict=True):
        assert each.power.max() < 1e-5 * periodogram(v)[1].max()


def test_an_accelerometer_is_compared_with_the_displacement():
    time = np.arange(600) / RATE
    x = np.exp(-0.2 * time) * np.cos(2.0 * np.pi * time)
    second = (-0.2 + 2j * np.pi) ** 2
    a = (second * np.exp((-0.2 + 2j * np.pi) * time)).real + 9.81
    left = differences([(x + 0.3, a)], 2, RATE)[0].power
    assert left.max() < 1e-7 * periodogram(a)[1].max()


@pytest.mark.few(1)
@pytest.mark.parametrize("pole", POLES)
def test_the_difference_of_two_channels_is_noise_of_both(pole):
    measured = []
    for seed in range(8):
        rng = np.random.default_rng(seed)
        x, v = decay(0.04)
        each = differences([(noisy(x, pole, rng), noisy(v, pole, rng))], 1, RATE)[0]
        own, other = (power(LEVEL * clean.std(), pole, each.frequency) for clean in (v, x))
        measured.append(each.power / (own + each.share * other))
    motion = each.frequency < 12.0 * NATURAL
    assert np.mean(measured, axis=0)[motion].mean() == pytest.approx(1.0, abs=0.12)
    assert np.mean(measured, axis=0)[each.frequency < 2.0 * NATURAL].mean() == pytest.approx(1.0, abs=0.35)


@pytest.mark.acceptance
@pytest.mark.parametrize(("pole", "orders"), [(0.5, (0, 1)), (0.5, (0,)), (0.9, (0, 1)), (0.9, (1,))])
def test_noise_is_told_at_the_frequencies_of_the_motion(pole, orders):
    found = np.array([ratios(pole, seed, orders) for seed in range(2)])
    # Too low an estimate would look like a misfit, so that it errs to the other side.
    assert found.min() > 0.3
    assert np.quantile(found, 0.1) > 0.6
    assert np.median(found[..., 1:]) < 2.5
    if len(orders) == 2:  # up to 9.3, if the channels were not compared with each other
        assert found[..., 1:].max() < 4.0


@pytest.mark.parametrize("level", [0.01, 0.05])
def test_jumps_of_an_acceleration_are_no_noise_beside_the_displacement(level):
    """The displacement has them, too: its second derivative says what is noise."""
    rng, frictions = np.random.default_rng(8), (0.04, 0.06)
    clean = [(decay(each)[0], acceleration(each)) for each in frictions]
    tests = [{0: noisy(x, 0.0, rng), 2: noisy(a, 0.0, rng, level)} for x, a in clean]
    found = noise_of_channels(tests, dict.fromkeys((0, 2), "relative"), [RATE] * 2)
    for t, (_, a) in enumerate(clean):
        ratio = found[t, 2](AT) / (level * a.std()) ** 2
        assert ratio.min() > 0.5
        assert ratio.max() < 20.0  # up to 1,600 if jumps were taken out of the acceleration alone


def test_a_level_may_differ_from_test_to_test():
    rng, clean = np.random.default_rng(3), [decay(0.04), decay(0.05)]
    levels = (0.002, 0.02)
    tests = [{0: noisy(x, 0.9, rng, own)} for (x, _), own in zip(clean, levels, strict=True)]
    found = noise_of_channels(tests, {0: "relative"}, [RATE] * 2)
    for t, ((x, _), own) in enumerate(zip(clean, levels, strict=True)):
        assert found[t, 0](AT[2:]) == pytest.approx(power(own * x.std(), 0.9, AT[2:]), rel=0.8)


def test_records_of_other_sampling_rates_have_noise_of_their_own():
    rng, (_, v) = np.random.default_rng(4), decay(0.04)
    coloured_one, white_one = {1: noisy(v, 0.9, rng)}, {1: noisy(v[::2], 0.0, rng)}
    found = noise_of_channels([coloured_one, white_one], {1: "relative"}, [RATE, RATE / 2])
    assert found[0, 1].correlation > 0.7
    assert found[1, 1].correlation < 0.3


@pytest.mark.parametrize("samples", [48, 100, 200])
def test_a_short_record_has_noise_of_some_size(samples):
    rng, (x, v) = np.random.default_rng(6), decay(0.08, samples)
    tests = [{0: noisy(x, 0.0, rng), 1: noisy(v, 0.0, rng)}, {0: noisy(x, 0.0, rng)}]
    found = noise_of_channels(tests, dict.fromkeys((0, 1), "relative"), [RATE] * 2)
    assert sorted(found) == [(0, 0), (0, 1), (1, 0)]
    assert all(np.isfinite(each.std) and each.std > 0.0 for each in found.values())


@pytest.mark.few(1)
@pytest.mark.parametrize("seed", range(2))
def test_white_noise_far_above_the_motion_may_be_red_at_it(seed):
    rng, clean = np.random.default_rng(seed), [acceleration(0.04, 240), acceleration(0.03, 240, 0.5)]
    tests = [{2: noisy(each, 0.9, rng)} for each in clean]
    found = noise_of_channels(tests, {2: "relative"}, [RATE] * 2)
    for t, each in enumerate(clean):
        assert found[t, 2](AT[1]) > 0.2 * power(LEVEL * each.std(), 0.9, AT[1])


@pytest.mark.acceptance
def test_noise_does_not_hide_that_physics_is_missing(tmp_path):
    path = write(tmp_path, effects={"cubic_stiffness": HIDDEN["cubic_stiffness"]}, pole=0.9)
    # The last is an effect on a sine as the input: it is no candidate here.
    found = diagnosed(path, ["friction_level", "viscous_damping", "stribeck", "cross_slip"])
    assert all("cross_slip" not in each["effects"] for each in found.document["candidates"])
    assert (found.verdict, found.causes) == ("none-of-mine", [])
