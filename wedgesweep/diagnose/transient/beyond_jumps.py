"""Starts of a simulation that a fit does not reach, because the response jumps on the way.

Where a mass just stops at a turn, or just does not, all that follows is different. The misfit has a cliff
there: a fit ends on the wrong side of it, or beside it, where the next step along it would lead over it. And
a spring that stiffens has two steady vibrations under one input: in the wrong one a fit takes the start far
from the record. So the start is looked for around where the fit ended and around where the record begins, in
all directions. The record does not show where it begins, either: its zero is unknown, and friction may hold
the mass far from where the spring would. So places in all of that range are tried as well.
"""

from collections.abc import Callable, Sequence
from math import ceil, log

import numpy as np

# Distances, in units of the start, at which other starts are tried; numbers of directions, and of moves at
# each distance.
DISTANCES, DIRECTIONS, MOVES = (3e-2, 1e-2, 3e-3, 1e-3, 3e-4), 24, 4
# Places may be farther apart than that: around the best of them larger distances come first, each
# REFINED times the next one.
REFINED = 3.0
# Places that are tried, as shares of their range.
SHARES = np.linspace(-1.0, 1.0, 101)
# A velocity below this, in units of the start, is that of a mass at rest.
AT_REST = 0.05
# A test stands out if its misfit, over the median of all tests, is DEVIATIONS standard deviations of noise
# too large. At most this share of the tests can stand out: where most are wrong, the model is.
DEVIATIONS, MOST = 4.0, 1.0 / 3.0


def standing_out(chi2: np.ndarray, dof: np.ndarray) -> np.ndarray:
    """Tests whose misfit (T,) is much larger than that of most, the worst first."""
    median = max(float(np.median(chi2 / dof)), 1.0)
    deviations = (chi2 / dof / median - 1.0) * np.sqrt(0.5 * dof)
    worst = np.argsort(-deviations)[: max(int(MOST * dof.size), 1)]
    return worst[deviations[worst] > DEVIATIONS]


def places(reach: float, velocity: float) -> np.ndarray:
    """Starts (n, 2) at places up to ``reach`` on either side; a small velocity is that of a mass at rest."""
    moving = velocity if abs(velocity) > AT_REST else 0.0
    return np.column_stack([reach * SHARES, np.full_like(SHARES, moving)])


def best_start(
    misfit: Callable[[np.ndarray], np.ndarray], starts: Sequence[np.ndarray], anywhere: np.ndarray
) -> np.ndarray:
    """The start (2,) that fits best near some starts and near the best one of many others.

    Parameters
    ----------
    misfit : callable
        Squared misfits (n,) of starts (n, 2); inf where there is no response.
    starts : sequence of ndarray, shape (2,) each
        Starts that are tried unless another one fits better.
    anywhere : ndarray, shape (n, 2)
        These others, at even distances.
    """
    spacing = anywhere[1, 0] - anywhere[0, 0]
    wider = max(ceil(log(spacing / DISTANCES[0], REFINED)), 0)
    distances = (*(spacing / REFINED**i for i in range(1, wider + 1)), *DISTANCES)
    near, elsewhere = misfit(np.array(starts)), misfit(anywhere)
    least = float(elsewhere.min())
    found = [
        _descended(misfit, start, float(own), DISTANCES)
        for start, own in zip(starts, near, strict=True)
        if own <= least
    ]
    if (near > least).any():
        found.append(_descended(misfit, anywhere[np.argmin(elsewhere)], least, distances))
    return min(found, key=lambda each: each[1])[0]


def _descended(
    misfit: Callable[[np.ndarray], np.ndarray], start: np.ndarray, least: float, distances: Sequence[float]
) -> tuple[np.ndarray, float]:
    """The start (2,) that moves over smaller and smaller distances lead to, as long as they fit better.

    With its misfit; ``least``: that of the first start.
    """
    angle = 2.0 * np.pi / DIRECTIONS * np.arange(DIRECTIONS)
    around, best = np.column_stack([np.cos(angle), np.sin(angle)]), start
    for distance in distances:
        for _ in range(MOVES):
            tried = best + distance * around
            found = misfit(tried)
            if found.min() >= least:
                break
            best, least = tried[np.argmin(found)], float(found.min())
    return best, least
