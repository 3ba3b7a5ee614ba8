"""How the misfit of a trial changes with everything that is unknown."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from wedgesweep.diagnose.steady.fit_data import real
from wedgesweep.diagnose.steady.model import Evaluation, Model

# Finite differences: share of a coordinate's width, and of an amplitude. The noise of a simulation looks like
# information: shorter steps make intervals too narrow where amplitude and effect are hard to tell apart.
STEP, AMPLITUDE_STEP = 2e-3, 2e-3
# And of the phase of a foreign vibration (rad).
TONE_PHASE_STEP = 1e-2


class Jacobian(NamedTuple):
    """Derivatives of the residual by the numbers (T, m, k + u), and by what is local to a test (T, m, L).

    Local are start phase and amplitude, and the phase of a foreign vibration where the point has one.
    """

    by_parameter: np.ndarray
    by_local: np.ndarray


def jacobian(model: Model, evaluation: Evaluation, side: float = 1.0) -> Jacobian:
    """Derivatives of the residual, from a simulation of each step.

    ``side``: to which side (1 or -1) numbers are changed, where the bounds allow it.
    """
    x = evaluation.point.x
    local = [AMPLITUDE_STEP, TONE_PHASE_STEP][: 1 + model.fits_tone_phase(evaluation.point)]
    steps = side * np.r_[STEP * model.scale, local]
    free = [np.inf] * len(local)
    low, high = np.r_[model.low - x, np.negative(free)], np.r_[model.high - x, free]
    steps = np.where((low <= steps) & (steps <= high), steps, -steps)
    back = (low <= -steps) & (-steps <= high)
    columns, _ = derivatives(lambda moved: _changes(model, evaluation, moved), steps, back)
    by_local = np.concatenate([_turn(model, evaluation)[..., None], columns[..., len(x) :]], axis=-1)
    return Jacobian(columns[..., : len(x)], by_local)


def conservative_jacobian(model: Model, evaluation: Evaluation) -> Jacobian:
    """Derivatives to the side to which less changes.

    Across a jump of the response they would be large, and seem to tell a number ever so precisely.
    """
    return Jacobian(*map(_smaller, jacobian(model, evaluation), jacobian(model, evaluation, -1.0)))


def _turn(model: Model, evaluation: Evaluation) -> np.ndarray:
    """Derivative of the residual by the start phase (T, m)."""
    data = model.data
    orders = np.r_[data.orders, [0] * (data.columns - data.orders.size)]
    return real(-1j * orders * data.rotated(evaluation.whitened, evaluation.phase))


def _changes(model: Model, evaluation: Evaluation, steps: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Changes of the residual (n, T, m) by steps (n, k + u + L - 1) of all but start phases; found or not."""
    point, data = evaluation.point, model.data
    numbers = len(point.x)
    harmonics, found, _ = model.simulate([point.moved(step[:numbers], step[numbers:]) for step in steps])
    phase = np.repeat(evaluation.phase[None], len(steps), axis=0)
    moved = data.rotated(data.whiten(data.compared(harmonics)), phase)
    aliases = np.where(evaluation.aliased, data.aliases(harmonics, phase), 0.0) - evaluation.aliases
    change = data.rotated(evaluation.whitened, evaluation.phase) - moved - data.whiten(aliases)
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
