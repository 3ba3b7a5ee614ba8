"""Checks that a test vibrates steadily at its frequency for long enough, and lost no samples meanwhile."""

from dataclasses import dataclass
from math import isnan

import numpy as np

from wedgesweep.formatting import counted
from wedgesweep.measured import frequency
from wedgesweep.measured.cycles import FIRST_HARMONICS, NoiseEstimate, estimate_noise
from wedgesweep.measured.frequency import FrequencyEstimate
from wedgesweep.measured.measurement import TestRecord

FEWEST_PERIODS = 4
# A period that lacks less than this share counts as complete, as frequencies are rounded.
WHOLE = 1e-3
# With fewer samples per period, two harmonics do not fit below the cut-off of an anti-aliasing filter.
FEWEST_SAMPLES = 5
# More samples take gigabytes of memory and add no information.
MOST_SAMPLES = 300_000
# A line outside of the search range leaks less than this share of its amplitude into the stated frequency.
LEAKAGE = 0.3
# Ratio of residual variances above which the stated frequency is wrong. A smaller ratio may come from a tone
# beside a harmonic, whose modulation of a short record resembles another frequency.
WORSE = 3.0
# Numbers of lost samples that are tried; -1 is one that was stored twice.
LOST = (1, 2, 3, -1)
# Places that are tried in a record, and around the best of them in each of ROUNDS; samples that are fitted.
PLACES, ROUNDS, FITTED = 48, 3, 4000


def frequency_faults(test: TestRecord, file: str, at: str) -> list[str]:
    """Faults of the frequency of a test, in its data or as stated by its keys at ``at``."""
    if test.time.size > MOST_SAMPLES:
        fault = f"has {test.time.size} samples, at most {MOST_SAMPLES} are used"
        return [f"{file}: {fault}; cut it shorter, or low-pass it and sample it down"]
    stated = test.frequency
    found = frequency.estimate_frequency(test.time, test.leading) if stated is None else stated
    if isnan(found):
        return [f"{file}: no vibration stands out of the noise; state frequency_hz in {at}"]
    samples = test.sampling_rate / found
    if samples < FEWEST_SAMPLES:
        fault = (
            f"has {samples:.3g} samples per period of {found:.6g} Hz; at least {FEWEST_SAMPLES} are needed"
        )
        return [f"{file}: {fault}: sample faster, or correct the unit of time"]
    periods = test.duration * found
    if periods < FEWEST_PERIODS - WHOLE:
        fault = f"covers {periods:.3g} periods of {found:.6g} Hz; at least {FEWEST_PERIODS} are needed"
        return [f"{file}: {fault}: record longer, or correct the unit of time"]
    estimate = frequency.estimate_near(test.time, test.leading, found, frequency.LOBE / periods)
    faults = _drift(estimate, periods, file) or _contradiction(test, estimate, file, at)
    return faults and (_lost_samples(test, found, estimate.frequency, file) or faults)


def _contradiction(test: TestRecord, estimate: FrequencyEstimate, file: str, at: str) -> list[str]:
    stated = test.frequency
    if stated is None:
        return []
    actual = (
        estimate.frequency
        if estimate.differs(stated) and _worse(test, stated, estimate.frequency)
        else stated
    )
    if actual == stated and not frequency.stands_out(test.time, test.leading, stated):
        actual = _elsewhere(test, stated)
    if abs(actual / stated - 1.0) < frequency.NEGLIGIBLE:
        return []
    return [f"{at}.frequency_hz: {stated:.6g}, but {file} vibrates at {actual:.6g} Hz; correct one of them"]


def _lost_samples(test: TestRecord, stated: float, other: float, file: str) -> list[str]:
    """A step of phase that explains a record much better than another frequency (Hz)."""
    found = find_step(test.time, test.leading, stated)
    if not found.lost or WORSE * found.left**2 > _noise(test, other).std ** 2:
        return []
    samples = counted(abs(found.lost), "lost sample" if found.lost > 0 else "doubled sample")
    turn = abs(found.lost) / test.sampling_rate * stated * 360.0
    fault = f"a step of phase of {turn:.2g} degrees near {found.time:.4g} s, as {samples} would make"
    return [f"{file}: {fault}; choose the part before or after it (from_s, to_s), or mend the time stamps"]


def _worse(test: TestRecord, stated: float, other: float) -> bool:
    """Whether another frequency (Hz) fits a record much better than the stated one."""
    here, there = (_noise(test, each).std for each in (stated, other))
    return here**2 > WORSE * there**2


def _noise(test: TestRecord, at: float) -> NoiseEstimate:
    return estimate_noise(test.time, test.leading, at)


def _elsewhere(test: TestRecord, stated: float) -> float:
    """Frequency (Hz) of a vibration that dominates the stated one; else the stated one."""
    found = frequency.estimate_frequency(test.time, test.leading)
    # In noise alone the highest line is a small part of the record.
    if isnan(found) or test.duration * found < 2.0 or _noise(test, found).share > 1.0:
        return stated
    there, here = (frequency.amplitude(test.time, test.leading, each) for each in (found, stated))
    return found if here < LEAKAGE * there else stated


def _drift(estimate: FrequencyEstimate, periods: float, file: str) -> list[str]:
    if abs(estimate.drift) < min(frequency.NEGLIGIBLE, frequency.SLIP / periods) or not estimate.drifts:
        return []
    share, std = 100.0 * estimate.drift, 100.0 * estimate.drift_std
    change = f"by {share:+.2g} % ({std:.1g} % std) around {estimate.frequency:.6g} Hz"
    return [f"{file}: the frequency drifts {change}; keep it constant, or cut the record shorter"]


@dataclass(frozen=True)
class PhaseStep:
    """Samples lost after a time (s), and the std of what a periodic signal with that step leaves."""

    lost: int
    time: float
    left: float


def find_step(time: np.ndarray, signal: np.ndarray, frequency: float) -> PhaseStep:
    """The step of phase at which a signal (n,) over even times (n,) in s is most periodic."""
    step = (time[-1] - time[0]) / (time.size - 1)
    every = -(-time.size // FITTED)
    time, signal = time[::every], signal[::every]
    orders = FIRST_HARMONICS[FIRST_HARMONICS * frequency * step < 0.25]
    best = PhaseStep(0, float(time[0]), _left(time, signal, frequency, orders))
    for lost in LOST:
        places = np.linspace(0, time.size - 1, PLACES + 2).astype(int)[1:-1]
        for _ in range(ROUNDS):
            moved = (time + lost * step * (np.arange(time.size) > place) for place in places)
            left = [_left(times, signal, frequency, orders) for times in moved]
            place = int(places[int(np.argmin(left))])
            best = min(best, PhaseStep(lost, float(time[place]), min(left)), key=lambda found: found.left)
            reach = int(places[1] - places[0]) if places.size > 1 else 1
            around = np.arange(place - reach, place + reach + 1, max(reach // 8, 1))
            places = np.unique(np.clip(around, 0, time.size - 2))
    return best


def _left(time: np.ndarray, signal: np.ndarray, frequency: float, orders: np.ndarray) -> float:
    """Std of a signal without its harmonics."""
    waves = np.exp(2j * np.pi * frequency * np.outer(time, orders))
    design = np.hstack([np.ones((time.size, 1)), waves.real, waves.imag])
    fitted = design @ np.linalg.solve(design.T @ design, design.T @ signal)
    freedom = max(time.size - design.shape[1], 1)
    return float(np.linalg.norm(signal - fitted) / np.sqrt(freedom))
