"""Whether a record is stationary: its level and its spectrum must be the same from beginning to end."""

from dataclasses import dataclass

import numpy as np

from wedgesweep.measured.measurement import TestRecord
from wedgesweep.periodogram import power_of, without_trend

PARTS = 4
# A steady vibration under noise or a beating tone stays below this ratio of rms between parts of a record.
MOST_LEVEL_RATIO = 1.5
# Largest share of the power that may move to other frequencies between the halves of a record.
MOST_MOVED = 0.5
# Of a vibration the largest 1/FEW of the samples hold less than MUCH of the power.
FEW, MUCH = 500, 0.2
MEND = "cut the record to its steady part (from_s, to_s)"


def remedy(motion: str) -> str:
    """What mends a record that may be of another motion than a steady vibration."""
    return f'{MEND}, or write kind = "transient" if it is {motion}'


@dataclass(frozen=True)
class Stationarity:
    """How much a channel changes from beginning to end.

    ``levels``, shape (4,): rms of each quarter about its linear trend, in the channel's unit. ``moved``:
    share of the power that lies at other frequencies in the second half than in the first, from 0 to 1;
    ``centres`` (Hz): median frequency of the power in each half.
    """

    levels: np.ndarray
    moved: float
    centres: tuple[float, float]

    @property
    def level_ratio(self) -> float:
        """Highest level over the lowest."""
        return float(self.levels.max() / max(self.levels.min(), np.finfo(float).tiny))


def stationarity_faults(test: TestRecord, file: str) -> list[str]:
    """What is not stationary in a test, with the number that shows it; one fault at most."""
    for name, samples in test.channels.items():
        found = stationarity(samples, test.sampling_rate)
        if found.moved > MOST_MOVED:
            first, second = found.centres
            fault = f"{100.0 * found.moved:.0f} % of the power of {name} moves to other frequencies"
            fault += f" (median {first:.4g} Hz, then {second:.4g} Hz)"
            return [f"{file}: not steady: {fault}; {_outliers(samples) or remedy('a sweep')}"]
        if found.level_ratio > MOST_LEVEL_RATIO:
            levels = ", ".join(f"{100.0 * each / found.levels.max():.3g}" for each in found.levels)
            fault = f"the rms of {name} is {levels} % of its largest in the four quarters"
            mend = remedy("a ring-down") if (np.diff(found.levels) < 0.0).all() else MEND
            return [f"{file}: not steady: {fault}; {_outliers(samples) or mend}"]
    return []


def _outliers(signal: np.ndarray) -> str:
    """What to do about the few samples, of shape (n,), that hold much of the power; else empty."""
    squares = np.sort(without_trend(signal) ** 2)[::-1]
    few = max(signal.size // FEW, 1)
    share = squares[:few].sum() / squares.sum()
    if share < MUCH:
        return ""
    where = f"{100.0 * share:.0f} % of its power lies in {few} of {signal.size} samples"
    return f"{where}: correct these, if they are faulty"


def stationarity(signal: np.ndarray, rate: float) -> Stationarity:
    """Measure how much a channel, shape (n,), sampled at a rate (Hz), changes."""
    halves = [_cumulative_power(half) for half in np.array_split(signal[: signal.size // 2 * 2], 2)]
    moved = float(np.abs(halves[0] - halves[1]).max())
    centres = [_median(half, rate / (signal.size // 2)) for half in halves]
    levels = np.array([without_trend(part).std() for part in np.array_split(signal, PARTS)])
    return Stationarity(levels, moved, (centres[0], centres[1]))


def median_frequency(signal: np.ndarray, rate: float) -> float:
    """Frequency (Hz) below which half of the power of a channel (n,), sampled at a rate (Hz), lies."""
    return _median(_cumulative_power(signal), rate / signal.size)


def _median(cumulative: np.ndarray, step: float) -> float:
    return float(np.searchsorted(cumulative, 0.5) * step)


def _cumulative_power(signal: np.ndarray) -> np.ndarray:
    """Share of the power up to each frequency; NaN without any power."""
    total = np.cumsum(power_of(without_trend(signal)))
    with np.errstate(invalid="ignore"):
        return total / total[-1]
