"""The observations of Chandiramani's experiment, and the distances of simulated responses from them.

The paper shows no scales and states no inputs: every tolerance is wide, and its comment says why. Distances
are in tolerances: an observation is satisfied up to 1.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

SLOW_HERTZ, FAST_HERTZ = 20.0, 30.0
# An instrument with 4 % noise on the smallest motion shown, 0.03 mm, cannot resolve a smaller motion (mm).
RESOLUTION = 1e-3

# Levels (mm): twice the inputs at which the paper's simulation came closest, with a ratio of about 1 there.
# Its inputs differ by factors of at most 1.4 (1,800 cases), and its ratio is read off a diagram.
LEVELS = {SLOW_HERTZ: 0.03, FAST_HERTZ: 0.2}
LEVEL_FACTOR = 1.5
# "Small plateaus around 1/8 of the response period", estimated from a small plot: 1/12 to 3/16.
PLATEAU, PLATEAU_FACTOR = 1 / 8, 1.5
# On a plateau the velocity stays below this share of its largest value, which a plot shows as a line on the
# axis. A sine does so for 0.016 of its period.
ON_THE_AXIS = 0.05
# "Sticking zones" at 30 Hz, without a length: half of those at 20 Hz, and four times that of a sine.
STICK = 1 / 16
# "A highly distorted velocity profile" at 30 Hz, unlike that at 20 Hz: more harmonics than there, where
# set-valued friction with stops of an eighth has 0.27 of the fundamental.
DISTORTION = 0.27
# "Increases initially slowly": up to 33 Hz the rise within 2 Hz is at most a fifth of the sweep's highest
# peak-to-peak, twice that of a straight line from 20 to 40 Hz. A fall of a twentieth would be visible.
SLOWLY_UNTIL, STEEPEST, FALL = 33.0, 0.2, 0.05
# "About 35 Hz, it makes a jump towards a higher value": within 2 Hz between 33 and 37 Hz the peak-to-peak
# grows by half or more, and does not fall again up to 40 Hz.
JUMP_HERTZ, STRIDE, JUMP_FACTOR = (33.0, 37.0), 2.0, 1.5


@dataclass(frozen=True)
class Observation:
    """What was observed, and the criterion for a response that shows it."""

    name: str
    description: str
    criterion: str


OBSERVATIONS = (
    Observation("level-20", "peak-to-peak at 20 Hz about 0.03 mm", "0.02 to 0.045 mm"),
    Observation("plateau-20", "plateaus of 1/8 period at 20 Hz", "1/12 to 3/16 of the period"),
    Observation("level-30", "peak-to-peak at 30 Hz about 0.2 mm", "0.133 to 0.3 mm"),
    Observation("stick-30", "sticking at 30 Hz", "velocity at zero for at least 1/16 of the period"),
    Observation(
        "distorted-30",
        "velocity highly distorted at 30 Hz",
        "harmonics of at least 0.27 of the fundamental",
    ),
    Observation(
        "slow-growth",
        "peak-to-peak grows slowly from 20 Hz",
        "growth up to 33 Hz, within 2 Hz at most a fifth of the highest value, no fall above a twentieth",
    ),
    Observation(
        "jump",
        "peak-to-peak jumps near 35 Hz",
        "x 1.5 within 2 Hz between 33 and 37 Hz, no later fall",
    ),
)
# Those in the recordings at 20 and 30 Hz, and those in the sweep.
OF_SLOW, OF_FAST, OF_SWEEP = slice(0, 2), slice(2, 5), slice(5, 7)
OF_TESTS = OF_FAST.stop


class Recording(NamedTuple):
    """One frequency of n models: peak-to-peak (mm), longest plateau (of the period), distortion; (n,)."""

    peak_to_peak: np.ndarray
    plateau: np.ndarray
    distortion: np.ndarray


def of_tests(slow: Recording, fast: Recording) -> np.ndarray:
    """Distances from the recordings at 20 and 30 Hz, shape (n, OF_TESTS)."""
    distances = (
        _ratio_distance(slow.peak_to_peak, LEVELS[SLOW_HERTZ], LEVEL_FACTOR),
        _ratio_distance(slow.plateau, PLATEAU, PLATEAU_FACTOR),
        _ratio_distance(fast.peak_to_peak, LEVELS[FAST_HERTZ], LEVEL_FACTOR),
        _if_visible(_shortfall(fast.plateau, STICK), fast.peak_to_peak),
        _if_visible(_shortfall(fast.distortion, DISTORTION), fast.peak_to_peak),
    )
    return _without_nan(np.stack(distances, axis=1))


def of_sweep(hertz: np.ndarray, peak_to_peak: np.ndarray) -> np.ndarray:
    """Distances from slow growth and jump, shape (n, 2).

    ``peak_to_peak`` has shape (n, f) over ``hertz`` (f,), whose even steps divide 2 Hz and include 33 Hz.
    """
    return _without_nan(np.stack([_growth(hertz, peak_to_peak), _jump(hertz, peak_to_peak)], axis=1))


def _without_nan(distances: np.ndarray) -> np.ndarray:
    """Replace NaN, as of a wedge that locks, by infinity."""
    return np.where(np.isnan(distances), np.inf, distances)


def _if_visible(distance: np.ndarray, peak_to_peak: np.ndarray) -> np.ndarray:
    """The distance, infinite where the motion is below the resolution."""
    return np.where(peak_to_peak >= RESOLUTION, distance, np.inf)


def _ratio_distance(value: np.ndarray, wanted: float, factor: float) -> np.ndarray:
    """Distance of a ratio."""
    return np.abs(np.log(np.maximum(value, 1e-12) / wanted)) / np.log(factor)


def _shortfall(value: np.ndarray, least: float) -> np.ndarray:
    """Distance below a smallest value."""
    return least / np.maximum(value, 1e-12)


def _steps_in_stride(hertz: np.ndarray) -> int:
    """Number of frequency steps in 2 Hz."""
    return round(STRIDE / (hertz[1] - hertz[0]))


def _growth(hertz: np.ndarray, peak_to_peak: np.ndarray) -> np.ndarray:
    stride, highest = _steps_in_stride(hertz), peak_to_peak.max(axis=1)
    early = peak_to_peak[:, hertz <= SLOWLY_UNTIL]
    steepest = (early[:, stride:] - early[:, :-stride]).max(axis=1)
    fall = (np.maximum.accumulate(early, axis=1) - early).max(axis=1)
    grows = (early[:, -1] > early[:, 0]) & (early[:, 0] >= RESOLUTION)
    distance = np.maximum(steepest / STEEPEST, fall / FALL) / np.maximum(highest, 1e-12)
    return np.where(grows, distance, np.inf)


def _jump(hertz: np.ndarray, peak_to_peak: np.ndarray) -> np.ndarray:
    stride = _steps_in_stride(hertz)
    starts = np.flatnonzero((hertz >= JUMP_HERTZ[0]) & (hertz + STRIDE <= JUMP_HERTZ[1]))
    after = np.stack([peak_to_peak[:, i + stride :].min(axis=1) for i in starts], axis=1)
    before = np.maximum(peak_to_peak[:, starts], RESOLUTION)
    largest = (after / before).max(axis=1)
    return np.where(largest > 1.0, np.log(JUMP_FACTOR) / np.log(np.maximum(largest, 1.0 + 1e-12)), np.inf)


def recording(spectra: np.ndarray, extremes: np.ndarray, samples: int = 256) -> Recording:
    """Recordings of responses with ``spectra`` (n, 2, H) and ``extremes`` (n, 2) in m."""
    size = np.abs(spectra[:, 1])
    distortion = np.sqrt((size[:, 1:] ** 2).sum(axis=1)) / np.maximum(size[:, 0], 1e-15)
    orders = np.arange(1, spectra.shape[2] + 1)
    turns = np.exp(2j * np.pi * np.outer(orders, np.arange(samples)) / samples)
    velocity = np.abs((spectra[:, 1] @ turns).real)
    on_axis = velocity <= ON_THE_AXIS * velocity.max(axis=1, keepdims=True)
    return Recording(1e3 * (extremes[:, 1] - extremes[:, 0]), _longest_run(on_axis), distortion)


def _longest_run(flags: np.ndarray) -> np.ndarray:
    """Longest run of each periodic row as a share of the row; shape (n,)."""
    n, samples = flags.shape
    run, longest = np.zeros(n, int), np.zeros(n, int)
    for column in np.concatenate([flags, flags], axis=1).T:
        run = np.where(column, run + 1, 0)
        longest = np.maximum(longest, run)
    return np.minimum(longest, samples) / samples
