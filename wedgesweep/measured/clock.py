"""The even grid behind the time stamps of a channel: its rate, the samples it lost, the scatter of stamps."""

from dataclasses import dataclass

import numpy as np

# Deviation from the grid that counts as none, over the step, besides the rounding of the stamps.
EVEN = 0.01
# Deviation by rounding, over the resolution of the stamps: 0.5, and the error of the fit.
ROUNDED = 0.6
# Largest deviation of stamps that belong to a grid of an even rate, over the step.
SCATTERED = 0.5
# A distance above this many steps may be a gap; the level of the stamps is compared over NEAR stamps at
# either side of it, as a single late stamp shifts none of them. More than a SHARE of them is scatter.
GAP, NEAR, SHARE = 1.5, 8, 0.1
# Samples of a run, and the distance of its first stamp from that of the first run, over its span, where it
# begins anew.
FEWEST, ANEW = 50, 0.05
# Stamps with more decimals count as not rounded.
DECIMALS = 12


@dataclass(frozen=True, eq=False)
class Clock:
    """An even grid, start + step * index (s), near time stamps of shape (n,).

    ``index`` (n,): place of each stamp on the grid; ``off`` (n,): its deviation over the step; ``exact``:
    whether rounding explains the deviations; ``even``: whether the stamps stay near a grid of one rate.
    """

    start: float
    step: float
    index: np.ndarray
    off: np.ndarray
    exact: bool
    even: bool = True

    @property
    def places(self) -> np.ndarray:
        """Times (s) of the samples on the grid, shape (n,)."""
        return self.start + self.step * self.index

    @property
    def gaps(self) -> np.ndarray:
        """Samples that are lost before each but the first, shape (n - 1,)."""
        return np.diff(self.index) - 1


def fit_clock(stamps: np.ndarray, resolution: np.ndarray) -> Clock:
    """Fit the grid of increasing stamps (s), (n,), that are rounded to ``resolution`` (s), (n,)."""
    step = typical_step(stamps)
    index = np.arange(stamps.size) + np.concatenate([[0], np.cumsum(_lost(stamps, step))])
    clock = _fitted(stamps, index, resolution)
    if clock.exact or np.abs(clock.off).max() <= max(SCATTERED, float((resolution / step).max())):
        return clock
    steps = np.diff(stamps)
    step = float(np.median(steps))
    index = np.rint((stamps - stamps[0]) / step).astype(int)
    off = np.concatenate([[0.0], np.minimum(np.abs(steps / step - 1.0), 1.0)])
    return Clock(float(stamps[0]), step, index, off, exact=False, even=False)


def continued(stamps: np.ndarray) -> tuple[np.ndarray, float]:
    """Stamps (n,) of runs that each begin anew, one behind the other, and the time between their beginnings.

    That time is a power of ten, so that stamps of the file can be read from the others. It is 0 where stamps
    go back to another time than that of their beginning.
    """
    known = np.flatnonzero(np.isfinite(stamps))
    given = stamps[known]
    starts = np.flatnonzero(np.diff(given) < 0.0) + 1
    runs = np.split(given, starts)
    span = max((float(np.ptp(run)) for run in runs if run.size), default=0.0)
    anew = all(run.size >= FEWEST and abs(run[0] - given[0]) <= ANEW * np.ptp(run) for run in runs)
    if not starts.size or not anew:
        return stamps, 0.0
    between = 10.0 ** np.ceil(np.log10((1.0 + SHARE) * span))
    number = np.searchsorted(known[starts], np.arange(stamps.size), side="right")
    return stamps + between * number, float(between)


def counted_clock(stamps: np.ndarray, resolution: np.ndarray) -> Clock:
    """The grid of stamps (s), (n,), that tell how many samples there were, but not when each was taken."""
    return _fitted(stamps, np.arange(stamps.size), resolution)


def _fitted(stamps: np.ndarray, index: np.ndarray, resolution: np.ndarray) -> Clock:
    """The straight line through the stamps over their places (least squares)."""
    about = index - index.mean()
    step = float(about @ stamps / (about @ about))
    start = float(stamps.mean() - step * index.mean())
    off = (stamps - start - step * index) / step
    exact = bool((np.abs(off) <= EVEN + ROUNDED * resolution / step).all())
    return Clock(start, step, index, off, exact)


def typical_step(stamps: np.ndarray) -> float:
    """Sampling interval: median slope over spans that are long against the rounding of the stamps."""
    span = max(1, stamps.size // 20)
    return float(np.median(stamps[span:] - stamps[:-span])) / span


def _lost(stamps: np.ndarray, step: float) -> np.ndarray:
    """Samples that are lost before each stamp but the first, shape (n - 1,)."""
    lost = np.zeros(stamps.size - 1, int)
    wide = np.flatnonzero(np.diff(stamps) > GAP * step)
    if wide.size > SHARE * stamps.size:
        return lost
    shifted = stamps / step - np.arange(stamps.size)
    ends = [0, *(wide + 1).tolist(), stamps.size]
    for before, here, after in zip(ends, ends[1:], ends[2:], strict=False):
        left, right = shifted[max(before, here - NEAR) : here], shifted[here : min(after, here + NEAR)]
        lost[here - 1] = max(0, round(float(np.median(right) - np.median(left))))
    return lost


def resolution(stamps: np.ndarray) -> np.ndarray:
    """Rounding step of each stamp, shape (n,): a power of ten.

    It is found decade by decade, as it differs between them if the number of digits is limited, not that of
    decimals. Small numbers are not rounded more than large ones.
    """
    decades = np.floor(np.log10(np.maximum(np.abs(stamps), 10.0**-DECIMALS)))
    found, least = np.empty(stamps.size), np.inf
    for decade in np.unique(decades)[::-1]:
        here = decades == decade
        least = min(least, _resolution_of_all(stamps[here]))
        found[here] = least
    return found


def _resolution_of_all(stamps: np.ndarray) -> float:
    for decimals in range(-2, DECIMALS):
        scaled = stamps * 10.0**decimals
        if np.all(np.abs(scaled - np.rint(scaled)) <= 1e-9 + 8.0 * np.finfo(float).eps * np.abs(scaled)):
            return 10.0**-decimals
    return 10.0**-DECIMALS
