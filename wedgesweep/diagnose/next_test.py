"""The cheapest further test that would tell the remaining explanations apart (T-optimality).

Each explanation predicts the harmonics of a test that was not made. Their distance counts only what its
own numbers, as uncertain as the data leave them, and an amplitude that is known to some percent cannot
take up (Atkinson and Fedorov, 1975, with the fit's covariance as prior). Next to breakaway predictions
differ by any amount, and a fit to what is measured there has many minima: a test counts as what it
and its neighbours in amplitude tell at the least, and as nothing where a suspect sticks.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from scipy.ndimage import minimum_filter1d

from wedgesweep.diagnose.jacobian import AMPLITUDE_STEP, STEP, derivatives
from wedgesweep.diagnose.steady import simulation
from wedgesweep.diagnose.steady.fit_data import FitData, real
from wedgesweep.diagnose.steady.model import Fit, Model
from wedgesweep.solvers.periodic import at_rest

FREQUENCIES = np.array([4.0, 6.0, 8.0, 10.0, 12.0, 14.0, 16.0, 20.0, 24.0, 28.0, 32.0, 36.0])
# Input amplitudes as peak accelerations (m/s^2): what a test costs, and what the bench can take.
ACCELERATIONS = np.geomspace(0.3, 4.0, 8)
# Least share of these tests that an explanation must predict; elsewhere its wedge locks.
PREDICTED = 0.5
# A fundamental of less than this share of the input is a bolster that sticks: nothing to fit.
MOVES = 1e-3
# Squared distance at which two explanations are told apart.
SEPARATED = 30.0
# Largest standard deviation of a number, in widths of its coordinate.
WIDEST = 10.0
# How well the amplitude of a new test is taken to be known.
AMPLITUDE_STD = 0.02


@dataclass(frozen=True)
class NextTest:
    """A test to make: frequency (Hz), amplitude (m), the closest two explanations that it separates."""

    frequency: float
    amplitude: float
    separates: tuple[str, str]
    distance: float


@dataclass(frozen=True)
class _Prediction:
    """Harmonics (n, C, H) of n tests, and their derivatives (n, C, H, j) in standard deviations.

    ``moves`` (n,): whether the bolster is predicted to move, as far as there is a prediction (``found``).
    """

    harmonics: np.ndarray
    spread: np.ndarray
    found: np.ndarray
    moves: np.ndarray


def recommend(fits: Sequence[Fit]) -> NextTest | None:
    """Test that separates most fits, the best one first; None where there is nothing to separate."""
    if len(fits) < 2:
        return None
    frequency, acceleration = (each.ravel() for each in np.meshgrid(FREQUENCIES, ACCELERATIONS))
    omega = 2.0 * np.pi * frequency
    amplitude = acceleration / omega**2
    made = [(fit, _predict(fit, omega, amplitude)) for fit in fits]
    made = [each for each in made if each[1].found.mean() >= PREDICTED]
    if len(made) < 2:
        return None
    weight = _weights(fits[0].model.data, [prediction for _, prediction in made])
    pairs = list(combinations(made, 2))
    distances = np.array([_distances(one, other, weight) for (_, one), (_, other) in pairs])
    best = _choice(distances)
    here = distances[:, best]
    told = here >= SEPARATED if (here >= SEPARATED).any() else np.ones(len(pairs), bool)
    # What it tells from the best one is of most interest.
    from_best = told & [one is fits[0] for (one, _), _ in pairs]
    chosen = np.flatnonzero(from_best if from_best.any() else told)
    closest = int(chosen[np.argmin(here[chosen])])
    (one, _), (other, _) = pairs[closest]
    names = (" + ".join(one.effects) or "base", " + ".join(other.effects) or "base")
    return NextTest(float(frequency[best]), float(amplitude[best]), names, float(here[closest]))


def _choice(distances: np.ndarray) -> int:
    """The test (place in the grid) that tells most pairs apart, the cheapest of several.

    ``distances`` (pairs, n). Where none tells any, the one at which the closest pair lies farthest apart.
    """
    grid = distances.reshape(len(distances), ACCELERATIONS.size, FREQUENCIES.size)
    sure = minimum_filter1d(grid, 3, axis=1, mode="nearest")
    told = (sure >= SEPARATED).sum(axis=0)
    least = np.where(told == told.max(), sure.min(axis=0), -1.0)
    if not told.any():
        return int(np.argmax(least))
    row = int(np.argmax(told.max(axis=1)))
    return row * FREQUENCIES.size + int(np.argmax(least[row]))


def _predict(fit: Fit, omega: np.ndarray, amplitude: np.ndarray) -> _Prediction:
    steps = np.r_[STEP * fit.model.scale, AMPLITUDE_STEP]
    nothing = np.zeros((1, steps.size))
    here, found, warm = _responses(fit, omega, amplitude, nothing, at_rest(omega.size))

    def changes(moves: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        there, found, _ = _responses(fit, omega, amplitude, moves, warm.repeated(len(moves)))
        return there - here, found

    change, moved = derivatives(changes, steps, np.full(steps.size, True))
    spread = np.concatenate([change[..., :-1] @ _spread(fit), change[..., -1:] * AMPLITUDE_STD], axis=-1)
    known = found[0] & moved.all(axis=0)
    moves = known & (np.abs(here[0, :, 0, 0]) > MOVES * amplitude)
    return _Prediction(here[0], spread, known, moves)


def _responses(
    fit: Fit, omega: np.ndarray, amplitude: np.ndarray, steps: np.ndarray, warm: simulation.Warm
) -> tuple[np.ndarray, np.ndarray, simulation.Warm]:
    """Harmonics (j, n, C, H) of n tests with a fit's numbers moved by ``steps`` (j, k + u + 1); found or not.

    The last step is the relative one of the amplitude.
    """
    model, data = fit.model, fit.model.data
    rows = [
        simulation.records(
            data.model, data.law, model.values(fit.x + step[:-1]), omega, amplitude * (1.0 + step[-1])
        )
        for step in steps
    ]
    done = _simulated(model, np.concatenate(rows), warm)
    harmonics = done.harmonics[:, : data.shape[0], : data.shape[1]]
    harmonics = harmonics.reshape(len(steps), omega.size, *data.shape)
    return harmonics, done.found.reshape(len(steps), -1), done.warm


def _simulated(model: Model, rows: np.ndarray, warm: simulation.Warm) -> simulation.Responses:
    """Responses of tests that nobody made, in which a foreign tone would meet the input in any way."""
    harmonics, tone = model.data.shape[1], model.data.tone
    if not model.has_tone or tone is None:
        return simulation.respond(rows, warm, harmonics)
    unknown = np.full(len(rows), np.nan)
    anyhow = (simulation.ToneTiming(simulation.LONG, 0.0, np.nan),) * len(rows)
    return simulation.respond_with_tone(rows, warm, harmonics, tone, anyhow, unknown)


def _spread(fit: Fit) -> np.ndarray:
    """Root (k, k) of the covariance of a fit's numbers, of which none is wider than its range."""
    std = np.sqrt(np.diag(fit.covariance))
    share = np.minimum(1.0, WIDEST * fit.model.scale / np.maximum(std, 1e-300))
    values, vectors = np.linalg.eigh(fit.covariance * np.outer(share, share))
    return vectors * np.sqrt(np.maximum(values, 0.0))


def _weights(data: FitData, predictions: Sequence[_Prediction]) -> np.ndarray:
    """One over the noise of a real part (n, C, 1), if new tests are as noisy as those made.

    The noise goes by the first prediction that there is: a wedge may lock under some of them. Where none is,
    there is nothing to weigh.
    """
    level = np.array(
        [
            np.sqrt(s.variance[c].mean() / (np.abs(s.mean[c]) ** 2).sum())
            for s in data.spectra
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
    for i in np.flatnonzero(a.moves & b.moves):
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
