"""Check of time stamps: they must be an even grid."""

from collections.abc import Callable

import numpy as np

from wedgesweep.formatting import counted

# Tolerated deviation of a stamp from the grid besides its rounding, over the sampling interval.
JITTER = 0.01
DRIFT = 0.05
# Stamps with more decimals count as not rounded.
DECIMALS = 12
FEWEST = 8


def even_grid(stamps: np.ndarray, where: Callable[[int], str], problems: list[str]) -> np.ndarray:
    """Return the even grid, shape (n,), of which the time stamps are rounded values, in their unit.

    Parameters
    ----------
    stamps : array, shape (n,)
        As written, so that their rounding shows.
    where : callable
        Names the place of a sample in the file, by its index.
    problems : list
        Receives the faults; the result is then empty.
    """
    fault = _too_few(stamps, where) or _step_fault(stamps, where) or _drift_fault(stamps, where)
    if fault:
        problems.append(fault)
        return np.array([])
    start, step = _line(stamps)
    return start + step * np.arange(stamps.size)


def resolution(stamps: np.ndarray) -> np.ndarray:
    """Rounding step of each stamp, shape (n,): a power of ten.

    It is found decade by decade, as it differs between them if the number of digits is limited, not that of
    decimals.
    """
    decades = np.floor(np.log10(np.maximum(np.abs(stamps), 10.0**-DECIMALS)))
    found = np.empty(stamps.size)
    for decade in np.unique(decades):
        here = decades == decade
        found[here] = _resolution_of_all(stamps[here])
    return found


def _resolution_of_all(stamps: np.ndarray) -> float:
    for decimals in range(-2, DECIMALS):
        scaled = stamps * 10.0**decimals
        if np.all(np.abs(scaled - np.rint(scaled)) <= 1e-9 + 8.0 * np.finfo(float).eps * np.abs(scaled)):
            return 10.0**-decimals
    return 10.0**-DECIMALS


def _line(stamps: np.ndarray) -> tuple[float, float]:
    """First value and step of the straight line through the stamps (least squares)."""
    place = np.arange(stamps.size) - 0.5 * (stamps.size - 1)
    step = float(place @ stamps / (place @ place))
    return float(stamps.mean() + step * place[0]), step


def _too_few(stamps: np.ndarray, where: Callable[[int], str]) -> str | None:
    if stamps.size >= FEWEST:
        return None
    return f"{where(stamps.size - 1)}: ends after {stamps.size} samples; at least {FEWEST} are needed"


def _step_fault(stamps: np.ndarray, where: Callable[[int], str]) -> str | None:
    steps = np.diff(stamps)
    falls = np.flatnonzero(steps <= 0.0)
    if falls.size:
        i = int(falls[0])
        fault = f"{stamps[i + 1]:.12g} follows {stamps[i]:.12g}"
        if steps[i] == 0.0:
            return f"{where(i + 1)}: time stands still ({fault}); write it with more decimals"
        return f"{where(i + 1)}: time goes back ({fault}); put the samples in order"
    step = _typical(stamps)
    coarse = resolution(stamps)
    rounding = np.minimum(np.maximum(coarse[1:], coarse[:-1]), 0.5 * step)
    wrong = np.flatnonzero(np.abs(steps - step) > rounding + JITTER * step)
    if not wrong.size:
        return None
    i = int(wrong[0])
    if steps[i] > 1.5 * step:
        missing = round(steps[i] / step) - 1
        fault = f"a gap of {counted(missing, 'sample')} after {stamps[i]:.12g}"
        return f"{where(i + 1)}: {fault}; samples must follow each other every {step:.6g}"
    fault = f"{steps[i]:.6g} from the sample before, {step:.6g} elsewhere"
    return f"{where(i + 1)}: sampling not constant ({fault}); resample evenly, or write more decimals"


def _typical(stamps: np.ndarray) -> float:
    """Sampling interval: median slope over spans that are long against the rounding of the stamps."""
    span = max(1, stamps.size // 20)
    return float(np.median(stamps[span:] - stamps[:-span])) / span


def _drift_fault(stamps: np.ndarray, where: Callable[[int], str]) -> str | None:
    start, step = _line(stamps)
    off = np.abs(stamps - start - step * np.arange(stamps.size))
    worst = int((off - resolution(stamps)).argmax())
    if off[worst] <= resolution(stamps)[worst] + DRIFT * step:
        return None
    fault = f"{stamps[worst]:.12g} is off an even grid by {off[worst] / step:.2g} sampling intervals"
    return f"{where(worst)}: sampling not constant ({fault}); resample evenly"
