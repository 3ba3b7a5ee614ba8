"""Starts of a simulation that a fit does not reach, because the response jumps on the way.

Where a mass just stops at a turn, or just does not, all that follows is different. The misfit has a cliff
there: a fit ends on the wrong side of it, or beside it, where the next step along it would lead over it. And
a spring that stiffens has two steady vibrations under one input: in the wrong one a fit takes the start far
from the record. So the start is looked for around where the fit ended and around where the record begins, in
all directions. Where a mass rests at first the record shows how it moves later, but not where between the
limits of friction it rests: its zero is unknown. So all places of rest are tried as well.
"""

from collections.abc import Callable

import numpy as np

# Distances, in units of the start, at which other starts are tried; numbers of directions, and of moves at
# each distance.
DISTANCES, DIRECTIONS, MOVES = (3e-2, 1e-2, 3e-3, 1e-3, 3e-4), 24, 4
# Places of rest that are tried, in units of the start.
PLACES_OF_REST = np.linspace(-1.0, 1.0, 101)
# A test stands out if its misfit, over the median of all tests, is so many standard deviations of noise too
# large. At most this share of the tests can stand out: where most are wrong, the model is.
DEVIATIONS, LARGEST_SHARE = 4.0, 1.0 / 3.0


def standing_out(chi2: np.ndarray, dof: np.ndarray) -> np.ndarray:
    """Tests whose misfit (T,) is much larger than that of most, the worst first."""
    over_median = chi2 / dof / max(float(np.median(chi2 / dof)), 1.0)
    deviations = (over_median - 1.0) * np.sqrt(0.5 * dof)
    worst = np.argsort(-deviations)[: max(int(LARGEST_SHARE * dof.size), 1)]
    return worst[deviations[worst] > DEVIATIONS]


def best_start(misfit: Callable[[np.ndarray], np.ndarray], start: np.ndarray) -> np.ndarray:
    """A start (2,) that fits better, or the given one.

    Parameters
    ----------
    misfit : callable
        Squared misfits (n,) of starts (n, 2); inf where there is no response.
    start : ndarray, shape (2,)
        Around which it is looked for.
    """
    angle = 2.0 * np.pi / DIRECTIONS * np.arange(DIRECTIONS)
    around = np.column_stack([np.cos(angle), np.sin(angle)])
    resting = np.column_stack([PLACES_OF_REST, np.zeros_like(PLACES_OF_REST)])
    begun = np.vstack([start, resting])
    found = misfit(begun)
    best, least = begun[np.argmin(found)], float(found.min())
    for distance in DISTANCES:
        for _ in range(MOVES):
            tried = best + distance * around
            found = misfit(tried)
            if found.min() >= least:
                break
            best, least = tried[np.argmin(found)], float(found.min())
    return best
