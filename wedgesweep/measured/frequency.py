"""Frequency of a steady vibration and its drift, from the phases of its cycles.

If the frequency is wrong by delta and changes at rate beta, the harmonics of the cycle at time t rotate:

    D_k(t) = A_k exp(i k (delta t + beta t^2 / 2))

A linear and a quadratic term fitted to the phases of each harmonic give delta and beta. Harmonics are
weighted by their noise, estimated from the scatter between cycles, so that coloured noise and spurious tones
count too.
"""

from dataclasses import dataclass
from math import inf, pi

import numpy as np

from wedgesweep.measured.cycles import FIRST_HARMONICS, SEEN, Cycles, cut, estimate_noise
from wedgesweep.periodogram import power_of

# Fewer cycles give no estimate of the scatter.
FEWEST_CYCLES = 4
# Range of the first search around a given frequency, relative to it, and around the highest peak of a
# spectrum, times one over the length of the record.
RANGE, LOBE = 0.15, 1.5
# Weak fundamentals below a strong harmonic are sought at its frequency divided by these.
DIVISORS = (2, 3, 5, 7)
# A fundamental is at least this share of its second harmonic: a weaker line at half the frequency of the
# strongest one is a period-two response or a spurious tone.
LEAST_FUNDAMENTAL = 0.3
# False-alarm probability of a line in noise.
CHANCE = 1e-5
# Significance level of a difference: that of 5 std of a normal variable.
IMPROBABLE = 2.9e-7
PADDING = 8
# Relative differences of frequency below NEGLIGIBLE are ignored; in a record of fewer than FEW cycles also
# those that amount to less than SLIP cycles over the record.
NEGLIGIBLE, SLIP, FEW = 2e-3, 0.02, 20.0


@dataclass(frozen=True)
class FrequencyEstimate:
    """Frequency (Hz, in the middle of the record), its relative change over the record, standard errors.

    ``freedom`` is the number of degrees of freedom that the standard errors rest on.
    """

    frequency: float
    std: float
    drift: float
    drift_std: float
    freedom: int

    def differs(self, frequency: float) -> bool:
        """Whether another frequency (Hz) is excluded."""
        return abs(self.frequency - frequency) > _bound(self.freedom) * self.std

    @property
    def drifts(self) -> bool:
        """Whether a constant frequency is excluded."""
        return abs(self.drift) > _bound(self.freedom) * self.drift_std


def estimate_frequency(time: np.ndarray, displacement: np.ndarray) -> float:
    """Frequency (Hz) of the slowest periodic vibration in a record, shape (n,); NaN if none is detected."""
    frequency = _strongest(time, displacement)
    if _cycle_count(time, frequency) < FEWEST_CYCLES:
        return frequency
    reach = min(RANGE, LOBE / _cycle_count(time, frequency))
    frequency = estimate_near(time, displacement, frequency, reach).frequency
    # The peak is the highest of as many lines as there are samples.
    if not _repeats(cut(time, displacement, frequency), FIRST_HARMONICS[:1], CHANCE / time.size):
        return float("nan")
    while divisor := _divisor(time, displacement, frequency):
        frequency = estimate_near(time, displacement, frequency / divisor, reach).frequency
    return frequency


def refined_frequency(time: np.ndarray, displacement: np.ndarray, stated: float | None) -> float:
    """Frequency (Hz) of a record: the stated one, unless none is stated or the record excludes it.

    A small clock error turns the phases of harmonics far in a long record.
    """
    if stated is None:
        return estimate_frequency(time, displacement)
    cycles = _cycle_count(time, stated)
    estimate = estimate_near(time, displacement, stated, LOBE / cycles)
    off = abs(estimate.frequency / stated - 1.0)
    harmless = SLIP / cycles if cycles < FEW else 0.0
    return estimate.frequency if harmless < off < NEGLIGIBLE and estimate.differs(stated) else stated


def estimate_near(
    time: np.ndarray, displacement: np.ndarray, frequency: float, reach: float = RANGE
) -> FrequencyEstimate:
    """Estimate the frequency of at least 4 cycles from a guess (Hz) that is right within a share ``reach``.

    In noise alone the standard error is infinite.
    """
    frequency += _search(cut(time, displacement, frequency), reach * frequency)
    frequency += _search(cut(time, displacement, frequency), 0.5 / (time[-1] - time[0]))
    for _ in range(3):
        estimate = _fit(cut(time, displacement, frequency))
        if abs(estimate.frequency - frequency) * (time[-1] - time[0]) > 1.0:
            return FrequencyEstimate(frequency, inf, 0.0, inf, estimate.freedom)
        frequency = estimate.frequency
    return estimate


def amplitude(time: np.ndarray, signal: np.ndarray, frequency: float) -> float:
    """Amplitude of the fundamental at a frequency (Hz)."""
    return float(abs(cut(time, signal, frequency).harmonics[:, 0].mean()))


def stands_out(time: np.ndarray, displacement: np.ndarray, frequency: float) -> bool:
    """Whether a fundamental of this frequency (Hz) repeats from cycle to cycle beyond chance."""
    return _repeats(cut(time, displacement, frequency), FIRST_HARMONICS[:1])


def _search(cycles: Cycles, reach: float) -> float:
    """Change of frequency (Hz) within ``reach`` that aligns the cycles best."""
    span = cycles.times[-1] - cycles.times[0]
    fine = 1.0 / (8.0 * span * cycles.orders[-1])
    changes = np.arange(-reach, reach + fine, fine)
    turns = np.exp(-2j * pi * np.outer(changes, cycles.times))
    power, turned = np.zeros(changes.size), np.ones_like(turns)
    for harmonic in cycles.harmonics.T:  # of the orders 1, 2, ...
        turned *= turns
        power += np.abs(turned @ harmonic) ** 2
    return float(changes[power.argmax()])


def _fit(cycles: Cycles) -> FrequencyEstimate:
    """One step of weighted least squares on the phases of all detected harmonics."""
    times, count = cycles.times, cycles.times.size
    mean = cycles.harmonics.mean(axis=0)
    turned = cycles.harmonics * np.exp(-1j * np.angle(mean))
    straight, bent = times, times**2 - (times**2).mean()
    powers = np.array([straight @ straight, bent @ bent])
    slopes = np.array([straight @ turned.imag, bent @ turned.imag]) / powers[:, None]
    left = turned.imag - np.outer(straight, slopes[0]) - np.outer(bent, slopes[1])
    scatter = np.sum((turned.real - np.abs(mean)) ** 2, axis=0) + np.sum((left - left.mean(0)) ** 2, axis=0)
    variance = _smooth(scatter / max(2 * count - 4, 1))
    size = np.abs(mean) * cycles.orders
    seen = np.abs(mean) ** 2 * count > SEEN * 2.0 * variance
    seen[0] |= not seen.any()
    weight = np.where(seen, size**2 / variance, 0.0)
    turn, bend = (np.where(seen, slopes / size, 0.0) * weight).sum(axis=1) / weight.sum()
    turn_std, bend_std = 1.0 / np.sqrt(weight.sum() * powers)
    record = times[-1] - times[0] + (times[1] - times[0])
    over_record = 2.0 * record / cycles.omega
    frequency, std = (cycles.omega + turn) / (2.0 * pi), turn_std / (2.0 * pi)
    return FrequencyEstimate(
        float(frequency), float(std), float(bend * over_record), float(bend_std * over_record), 4 * count - 8
    )


def _bound(freedom: int) -> float:
    from scipy.special import stdtrit

    return -float(stdtrit(freedom, IMPROBABLE))


def _smooth(variance: np.ndarray) -> np.ndarray:
    """Average each variance with its neighbours: a single one has few degrees of freedom."""
    padded = np.pad(variance, 1, mode="edge")
    return np.maximum((padded[:-2] + padded[1:-1] + padded[2:]) / 3.0, np.finfo(float).tiny)


def _cycle_count(time: np.ndarray, frequency: float) -> float:
    return time.size / (time.size - 1) * (time[-1] - time[0]) * frequency


def _strongest(time: np.ndarray, signal: np.ndarray) -> float:
    """Frequency (Hz) of the highest peak of the spectrum.

    From 1.5 cycles per record up to 4 samples per cycle; with fewer samples a cycle cannot be fitted alone.
    """
    count = time.size
    step = (time[-1] - time[0]) / (count - 1)
    spectrum = power_of(signal - signal.mean(), PADDING)
    frequencies = np.arange(spectrum.size) / (PADDING * count * step)
    spectrum[(frequencies < 1.5 / (count * step)) | (frequencies > 0.25 / step)] = 0.0
    return float(frequencies[spectrum.argmax()])


def _divisor(time: np.ndarray, signal: np.ndarray, frequency: float) -> int:
    """Return the divisor of a frequency at which there are lines between its harmonics; 0 if there is none.

    As lines leak into each other, the divisor with the smallest residual is taken.
    """
    left: dict[int, float] = {}
    for divisor in DIVISORS:
        slower = frequency / divisor
        between = np.setdiff1d(np.arange(1, 2 * divisor), [divisor])
        orders = np.union1d(between, divisor * FIRST_HARMONICS)
        if _cycle_count(time, slower) < FEWEST_CYCLES:
            continue
        cycles = cut(time, signal, slower, orders)
        if _repeats(cycles, between) and not (divisor == 2 and _weak(cycles, between)):
            left[divisor] = estimate_noise(time, signal, slower).std
    return min(left, key=lambda divisor: left[divisor], default=0)


def _weak(cycles: Cycles, orders: np.ndarray) -> bool:
    """Whether harmonics of some orders are small beside the largest."""
    size, among = np.abs(cycles.harmonics.mean(axis=0)), np.isin(cycles.orders, orders)
    return bool(size[among].max() < LEAST_FUNDAMENTAL * size.max())


def _repeats(cycles: Cycles, orders: np.ndarray, chance: float = CHANCE) -> bool:
    """Whether the harmonics of some orders repeat from cycle to cycle beyond chance (F test)."""
    from scipy.special import fdtrc

    harmonics = cycles.harmonics[:, np.isin(cycles.orders, orders)]
    count, lines = harmonics.shape
    mean = harmonics.mean(axis=0)
    scatter = np.sum(np.abs(harmonics - mean) ** 2) / (lines * (count - 1))
    ratio = count * np.sum(np.abs(mean) ** 2) / lines / max(scatter, np.finfo(float).tiny)
    return bool(fdtrc(2 * lines, 2 * lines * (count - 1), ratio) < chance)
