"""How the misfit of a trial changes with everything that is unknown."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from wedgesweep.diagnose.model import Model, Trial
from wedgesweep.diagnose.problem import real

# Finite differences: share of a coordinate's width, and of an amplitude. The noise of a simulation looks like
# information: shorter steps make intervals too narrow where amplitude and effect are hard to tell apart.
STEP, AMPLITUDE_STEP = 2e-3, 2e-3
# And of the phase of a foreign vibration (rad).
AHEAD_STEP = 1e-2


class Tangents(NamedTuple):
    """Derivatives of the residual by the numbers (T, m, k + u), and by what is local to a test (T, m, L).

    Local are start phase and amplitude, and the phase of a foreign vibration where the point has one.
    """

    by_number: np.ndarray
    by_test: np.ndarray


def tangents_of(model: Model, trial: Trial, side: float = 1.0) -> Tangents:
    """Derivatives of the residual, from a simulation of each step.

    ``side``: to which side (1 or -1) numbers are changed, where the bounds allow it.
    """
    x = trial.point.x
    local = [AMPLITUDE_STEP, AHEAD_STEP][: 1 + model.meets(trial.point)]
    steps = side * np.r_[STEP * model.width, local]
    free = [np.inf] * len(local)
    low, high = np.r_[model.low - x, np.negative(free)], np.r_[model.high - x, free]
    steps = np.where((low <= steps) & (steps <= high), steps, -steps)
    back = (low <= -steps) & (-steps <= high)
    columns, _ = derivatives(lambda moved: _changes(model, trial, moved), steps, back)
    by_test = np.concatenate([_turn(model, trial)[..., None], columns[..., len(x) :]], axis=-1)
    return Tangents(columns[..., : len(x)], by_test)


def cautious(model: Model, trial: Trial) -> Tangents:
    """Derivatives to the side to which less changes.

    Across a jump of the response they would be large, and seem to tell a number ever so precisely.
    """
    return Tangents(*map(_smaller, tangents_of(model, trial), tangents_of(model, trial, -1.0)))


def _turn(model: Model, trial: Trial) -> np.ndarray:
    """Derivative of the residual by the start phase (T, m)."""
    problem = model.problem
    orders = np.r_[problem.orders, [0] * (problem.columns - problem.orders.size)]
    return real(-1j * orders * problem.turned(trial.whitened, trial.phase))


def _changes(model: Model, trial: Trial, steps: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Changes of the residual (n, T, m) by steps (n, k + u + L - 1) of all but start phases; found or not."""
    point, problem = trial.point, model.problem
    numbers = len(point.x)
    harmonics, found, _ = model.simulate([point.moved(step[:numbers], step[numbers:]) for step in steps])
    phase = np.repeat(trial.phase[None], len(steps), axis=0)
    moved = problem.turned(problem.whiten(problem.shown(harmonics)), phase)
    images = np.where(trial.unfiltered, problem.images(harmonics, phase), 0.0) - trial.images
    change = problem.turned(trial.whitened, trial.phase) - moved - problem.whiten(images)
    return real(change), found


def derivatives(
    changes: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]], steps: np.ndarray, back: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Derivatives (T, ..., n) of responses by n numbers, 0 where there is none, and whether (n, T) there is.

    ``changes``: what steps (j, n) change in each response (j, T, ...), and whether (j, T) it was found;
    ``steps`` (n,): of each number; ``back`` (n,): whether it may be changed to the other side.
    """
    change, found = changes(np.diag(steps))
    # Beyond the limit at which a wedge locks there is no response: the near side tells.
    lost = np.flatnonzero(~found.all(axis=1) & back)
    if lost.size:
        near, near_found = changes(np.diag(-steps)[lost])
        change[lost] = np.where(_beside(found[lost], near), change[lost], -near)
        found[lost] |= near_found
    return np.moveaxis(np.where(_beside(found, change), change, 0.0), 0, -1) / steps, found


def _beside(found: np.ndarray, values: np.ndarray) -> np.ndarray:
    """``found`` (j, T) with as many axes as ``values`` (j, T, ...)."""
    return found.reshape(*found.shape, *[1] * (values.ndim - found.ndim))


def _smaller(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Of two derivatives (T, m, k), test by test and number by number, the one of less length."""
    shorter = (one**2).sum(axis=1) <= (other**2).sum(axis=1)
    return np.where(shorter[:, None], one, other)
