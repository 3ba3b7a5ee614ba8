"""The cheapest further test that would tell the remaining explanations apart (T-optimality).

Each explanation predicts the harmonics of a test that was not made. Their distance counts only what its
own numbers, as uncertain as the data leave them, and an amplitude that is known to some percent cannot
take up (Atkinson and Fedorov, 1975, with the fit's covariance as prior).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from wedgesweep.diagnose import simulation
from wedgesweep.diagnose.fit import AMPLITUDE_STEP, STEP, Fit
from wedgesweep.diagnose.problem import Problem, real

FREQUENCIES = np.array([4.0, 6.0, 8.0, 10.0, 12.0, 14.0, 16.0, 20.0, 24.0, 28.0, 32.0, 36.0])
# Input amplitudes as peak accelerations (m/s^2): what a test costs, and what the bench can take.
ACCELERATIONS = np.geomspace(0.3, 4.0, 8)
# Squared distance at which two explanations are told apart.
ENOUGH = 30.0
# Largest standard deviation of a number, in widths of its coordinate.
WIDEST = 10.0
# How well the amplitude of a new test is taken to be known.
AMPLITUDE_STD = 0.02


@dataclass(frozen=True)
class NextTest:
    """A test to make: frequency (Hz), amplitude (m), the two explanations closest there, their distance."""

    frequency: float
    amplitude: float
    separates: tuple[str, str]
    distance: float


@dataclass(frozen=True)
class _Prediction:
    """Harmonics (n, C, H) of n tests, and their derivatives (n, C, H, j) in standard deviations."""

    harmonics: np.ndarray
    spread: np.ndarray
    found: np.ndarray


def recommend(fits: Sequence[Fit]) -> NextTest | None:
    """Test that separates all fits from the first one; None where there is nothing to separate."""
    if len(fits) < 2:
        return None
    problem = fits[0].model.problem
    frequency, acceleration = (each.ravel() for each in np.meshgrid(FREQUENCIES, ACCELERATIONS))
    omega = 2.0 * np.pi * frequency
    amplitude = acceleration / omega**2
    predictions = [_predict(fit, omega, amplitude) for fit in fits]
    weight = _weights(problem, predictions)
    pairs = list(combinations(range(len(fits)), 2))
    distances = np.array([_distances(predictions[i], predictions[j], weight) for i, j in pairs])
    closest = np.argmin(distances, axis=0)
    reached = distances.min(axis=0)
    enough = np.flatnonzero(reached >= ENOUGH)
    best = int(enough[np.argmin(acceleration[enough])]) if enough.size else int(np.argmax(reached))
    names = [" + ".join(fit.effects) or "base" for fit in fits]
    i, j = pairs[closest[best]]
    return NextTest(
        float(frequency[best]), float(amplitude[best]), (names[i], names[j]), float(reached[best])
    )


def _predict(fit: Fit, omega: np.ndarray, amplitude: np.ndarray) -> _Prediction:
    model, problem = fit.model, fit.model.problem
    spread, step = _spread(fit), STEP * model.width
    points = [fit.x, *(fit.x + step * row for row in np.eye(len(fit.x)))]
    rows = [simulation.records(problem.model, problem.law, model.values(x), omega, amplitude) for x in points]
    louder = rows[0].copy()
    louder["amplitude"] *= 1.0 + AMPLITUDE_STEP
    done = simulation.respond(np.concatenate(rows[:1]), simulation.cold(omega.size), problem.shape[1])
    rest = np.concatenate([*rows[1:], louder])
    moved = simulation.respond(rest, done.warm.repeated(len(rows)), problem.shape[1])
    here = done.harmonics[:, : problem.shape[0]]
    there = moved.harmonics[:, : problem.shape[0]].reshape(len(rows), *here.shape)
    change = there - here
    by_number = np.moveaxis(change[:-1], 0, -1) / step @ spread if len(fit.x) else np.zeros((*here.shape, 0))
    by_amplitude = change[-1][..., None] / AMPLITUDE_STEP * AMPLITUDE_STD
    ok = done.found & moved.found.reshape(len(rows), -1).all(axis=0)
    return _Prediction(here, np.concatenate([by_number, by_amplitude], axis=-1), ok)


def _spread(fit: Fit) -> np.ndarray:
    """Root (k, k) of the covariance of a fit's numbers, of which none is wider than its range."""
    std = np.sqrt(np.diag(fit.covariance))
    share = np.minimum(1.0, WIDEST * fit.model.width / np.maximum(std, 1e-300))
    values, vectors = np.linalg.eigh(fit.covariance * np.outer(share, share))
    return vectors * np.sqrt(np.maximum(values, 0.0))


def _weights(problem: Problem, predictions: Sequence[_Prediction]) -> np.ndarray:
    """One over the noise of a real part (n, C, 1), if new tests are as noisy as those made.

    The noise goes by the first prediction that there is: a wedge may lock under some of them. Where none is,
    there is nothing to weigh.
    """
    level = np.array(
        [
            np.sqrt(s.variance[c].mean() / (np.abs(s.mean[c]) ** 2).sum())
            for s in problem.spectra
            for c in range(s.mean.shape[0])
        ]
    )
    size = np.ones((*predictions[0].harmonics.shape[:2], 1))
    for each in reversed(predictions):
        own = np.sqrt((np.abs(each.harmonics) ** 2).sum(-1, keepdims=True))
        size = np.where(each.found[:, None, None], own, size)
    return np.sqrt(2.0) / (np.median(level) * np.maximum(size, 1e-12))


def _distances(a: _Prediction, b: _Prediction, weight: np.ndarray) -> np.ndarray:
    """Squared distances (n,) of two predictions, start phase and all that is uncertain taken out."""
    distance = np.zeros(len(a.harmonics))
    orders = np.arange(1, a.harmonics.shape[-1] + 1)
    for i in np.flatnonzero(a.found & b.found):
        turn = np.angle((a.harmonics[i] * b.harmonics[i].conj())[:, 0].sum())
        other = b.harmonics[i] * np.exp(1j * orders * turn)
        gap = real((weight[i] * (a.harmonics[i] - other))[None])[0]
        columns = [weight[i] * 1j * orders * a.harmonics[i] * 1e3]
        columns += [weight[i] * a.spread[i, ..., k] for k in range(a.spread.shape[-1])]
        turned = b.spread[i] * np.exp(1j * orders * turn)[:, None]
        columns += [weight[i] * turned[..., k] for k in range(turned.shape[-1])]
        free = np.stack([real(each[None])[0] for each in columns], axis=1)
        # The least that any change of the numbers leaves, counted in their standard deviations.
        matrix = np.concatenate([free, np.eye(free.shape[1])])
        aim = np.concatenate([gap, np.zeros(free.shape[1])])
        change = np.linalg.lstsq(matrix, aim, rcond=None)[0]
        distance[i] = ((aim - matrix @ change) ** 2).sum()
    return distance
