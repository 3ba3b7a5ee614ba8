"""Starts of a simulation that a fit does not reach, because the response jumps on the way.

Where a mass just stops at a turn, or just does not, all that follows is different. The misfit has a cliff there:
a fit ends on the wrong side of it, or beside it, where the next step along it would lead over it. A search
without derivatives goes on (Nelder and Mead, 1965).
"""

from collections.abc import Callable

import numpy as np

# Changes of a start, in its units, that are tried first.
MOVES = (1e-3, 3e-3, 1e-2, 3e-2)
# First change of each number in the search from the best of them, and evaluations that it may take.
FIRST, EVALUATIONS = 5e-4, 100
# Changes of the misfit that end the search.
UNNOTICED = 0.1
# A test stands out if its misfit, over the median of all tests, is so many standard deviations of noise too
# large. At most this share of the tests is looked at: where most are wrong, the model is.
DEVIATIONS, MOST = 4.0, 1.0 / 3.0


def standing_out(chi2: np.ndarray, dof: np.ndarray) -> np.ndarray:
    """Tests whose misfit (T,) is much larger than that of most, the worst first."""
    over_median = chi2 / dof / max(float(np.median(chi2 / dof)), 1.0)
    deviations = (over_median - 1.0) * np.sqrt(0.5 * dof)
    worst = np.argsort(-deviations)[: max(int(MOST * dof.size), 1)]
    return worst[deviations[worst] > DEVIATIONS]


def best_start(misfit: Callable[[np.ndarray], np.ndarray], start: np.ndarray) -> np.ndarray:
    """A start (s,) that fits better, or the given one.

    Parameters
    ----------
    misfit : callable
        Squared misfits (n,) of starts (n, s); inf where there is no response.
    start : ndarray, shape (s,)
        Where a fit has ended.
    """
    from scipy.optimize import minimize

    own = np.eye(start.size)
    around = start + np.concatenate([sign * size * own for size in MOVES for sign in (1.0, -1.0)])
    tried = np.vstack([start, around])
    best = tried[np.argmin(misfit(tried))]
    simplex = best + FIRST * np.vstack([np.zeros(start.size), own])
    options = {"initial_simplex": simplex, "maxfev": EVALUATIONS, "fatol": UNNOTICED, "xatol": np.inf}
    return minimize(lambda x: float(misfit(x[None])[0]), best, method="Nelder-Mead", options=options).x
