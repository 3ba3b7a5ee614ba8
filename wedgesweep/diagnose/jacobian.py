"""Derivatives of the residual by everything that is fitted, by finite differences."""

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from wedgesweep.diagnose.evaluation import Evaluation

if TYPE_CHECKING:
    from wedgesweep.diagnose.model import Model

# Step as a share of a parameter's scale. Over shorter steps the error of the simulation would look like
# information, and intervals become too narrow where amplitude and effect are hard to distinguish.
STEP = 2e-3
# Steps change no test by more than its noise (root mean square of whitened residuals). Over longer ones
# responses are not linear, and a parameter that a nuisance parameter can imitate looks distinguishable from
# it. Where noise is small, a change may be this many times the error of the simulation.
LARGEST_CHANGE, RESOLVED = 1.0, 1e3


class Jacobian(NamedTuple):
    """Derivatives of the residual by x (T, m, k + u), and by the nuisance parameters of each test (T, m, L).

    The latter are those that are eliminated in closed form, then those that are fitted by simulation.
    """

    by_parameter: np.ndarray
    by_nuisance: np.ndarray


class Derivatives(NamedTuple):
    """Derivatives (T, ..., n) of responses by n numbers, 0 where ``found`` (n, T) says that there is none."""

    values: np.ndarray
    found: np.ndarray


def step_sizes(model: "Model", near: Jacobian | None = None) -> np.ndarray:
    """Steps of differences for all parameters and fitted nuisance parameters, shape (k + u + L,).

    ``near``: derivatives at a point nearby; steps are shortened where these predict too large a change.
    """
    sizes = np.r_[STEP * model.scale, [each.step for each in model.data.nuisances(model.effects)]]
    if near is None:
        return sizes
    by_nuisance = near.by_nuisance[..., model.data.eliminated :]
    columns = np.concatenate([near.by_parameter, by_nuisance], axis=-1)
    count = np.maximum(model.data.observations, 1)
    change = np.sqrt((columns**2).sum(axis=1) / count[:, None]) * sizes
    simulated = np.sqrt(model.data.power / count)
    allowed = np.maximum(LARGEST_CHANGE, RESOLVED * model.tolerance * simulated)
    return sizes / np.maximum((change / allowed[:, None]).max(axis=0), 1.0)


def jacobian(
    model: "Model", evaluation: Evaluation, side: float = 1.0, near: Jacobian | None = None
) -> Jacobian:
    """Derivatives at an evaluation by one-sided differences; 0 by parameters that are held or exact.

    Parameters
    ----------
    model : Model
        The model that was evaluated.
    evaluation : Evaluation
        Where derivatives are taken.
    side : float
        To which side (1 or -1) parameters are changed where the bounds allow it.
    near : Jacobian, optional
        Derivatives at a point nearby, see ``step_sizes``.
    """
    point, data, size = evaluation.point, model.data, len(evaluation.point.x)
    steps = side * step_sizes(model, near)
    unbounded = [np.inf] * (len(steps) - size)
    low, high = np.r_[model.low - point.x, np.negative(unbounded)], np.r_[model.high - point.x, unbounded]
    free = (low < high) & (steps != 0.0)
    exact = (data.nuisance_std == 0.0).all(axis=0)
    free[size : size + exact.size] &= ~exact
    fitted = np.flatnonzero(free)
    steps = np.where((low <= steps) & (steps <= high), steps, -steps)
    back = (low <= -steps) & (-steps <= high)

    def changes(moves: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        whole = np.zeros((len(moves), len(steps)))
        whole[:, fitted] = moves
        scenarios = [model.scenario(point.moved(move[:size], move[size:])) for move in whole]
        return data.changes(evaluation, scenarios, model.tolerance)

    columns = np.zeros((*evaluation.residual.shape, len(steps)))
    if fitted.size:
        columns[..., fitted] = derivatives(changes, steps[fitted], back[fitted]).values
    eliminated = data.eliminated_derivatives(evaluation)
    return Jacobian(columns[..., :size], np.concatenate([eliminated, columns[..., size:]], axis=-1))


def accurate_jacobian(model: "Model", evaluation: Evaluation, side: float = 1.0) -> Jacobian:
    """Derivatives at an evaluation, taken again by shorter steps if a response has changed too much."""
    first = jacobian(model, evaluation, side)
    short_enough = np.array_equal(step_sizes(model, first), step_sizes(model))
    return first if short_enough else jacobian(model, evaluation, side, first)


def conservative_jacobian(model: "Model", evaluation: Evaluation) -> Jacobian:
    """The smaller of forward and backward difference, for each test and parameter.

    A difference across a jump of the response is large, and would make a parameter look far too certain.
    """
    forward, backward = (accurate_jacobian(model, evaluation, side) for side in (1.0, -1.0))
    return Jacobian(*map(_smaller, forward, backward))


def derivatives(
    changes: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]], steps: np.ndarray, back: np.ndarray
) -> Derivatives:
    """Finite differences of responses that may not exist.

    Parameters
    ----------
    changes : callable
        Changes of the responses (j, T, ...) by moves (j, n), and whether the responses exist (j, T).
    steps : ndarray, shape (n,)
        Step of each number.
    back : ndarray of bool, shape (n,)
        Whether a number may be moved to the other side.
    """
    change, found = changes(np.diag(steps))
    # Beyond the limit at which the wedge locks there is no response; then the other side is used.
    lost = np.flatnonzero(~found.all(axis=1) & back)
    if lost.size:
        other, other_found = changes(np.diag(-steps)[lost])
        change[lost] = np.where(_expanded(found[lost], other), change[lost], -other)
        found[lost] |= other_found
    return Derivatives(np.moveaxis(np.where(_expanded(found, change), change, 0.0), 0, -1) / steps, found)


def _expanded(found: np.ndarray, values: np.ndarray) -> np.ndarray:
    """``found`` (j, T) with as many axes as ``values`` (j, T, ...)."""
    return found.reshape(*found.shape, *[1] * (values.ndim - found.ndim))


def _smaller(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Of two derivatives (T, m, k) the one of smaller norm, for each test and parameter."""
    shorter = (one**2).sum(axis=1) <= (other**2).sum(axis=1)
    return np.where(shorter[:, None], one, other)
