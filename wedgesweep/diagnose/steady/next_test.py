"""The cheapest further test that would separate the remaining explanations (T-optimality).

Each explanation predicts the harmonics of a test that was not made. Their distance counts only what cannot
be taken up by its own parameters, as uncertain as the data leave them, and by an amplitude that is known to
some percent (Atkinson and Fedorov, 1975, with the fit's covariance as prior). Near breakaway predictions
differ by any amount, and a fit to what is measured there has many minima: a test counts by the least that it
and its neighbours in amplitude separate, and not at all where a candidate predicts sticking.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import NamedTuple, cast

import numpy as np
from scipy.ndimage import minimum_filter1d

from wedgesweep.diagnose.fit_data import INPUT_GAIN
from wedgesweep.diagnose.jacobian import STEP, derivatives
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.steady import simulation
from wedgesweep.diagnose.steady.harmonic_data import HarmonicData
from wedgesweep.diagnose.steady.whitened import real
from wedgesweep.natural_units import ACCELERATION, FREQUENCY
from wedgesweep.solvers.periodic import Warm, at_rest

# Frequencies (Hz) of the tests to choose from, for a rig like the bench; see natural_units.
FREQUENCIES = np.array([4.0, 6.0, 8.0, 10.0, 12.0, 14.0, 16.0, 20.0, 24.0, 28.0, 32.0, 36.0])
# Their input amplitudes as peak accelerations (m/s^2), of the mass under a force: what a test costs, and what
# the bench can take.
ACCELERATIONS = np.geomspace(0.3, 4.0, 8)
# Least share of these tests that an explanation must predict; at the others its wedge locks.
PREDICTED = 0.5
# A bolster whose fundamental is less than this share of the input sticks: there is nothing to fit.
MOVES = 1e-3
# Squared distance at which two explanations are separated.
SEPARATED = 30.0
# Largest standard deviation of a parameter, in its scales.
WIDEST = 10.0
# Relative finite-difference step of the amplitude, and how well that of a new test is taken to be known.
AMPLITUDE_STEP, AMPLITUDE_STD = 2e-3, 0.02
# Derivative by the start phase, which is unknown, in units that make it as good as free.
FREE_PHASE = 1e3


class Separation(NamedTuple):
    """Two explanations by name, the better one first, and the squared distance of their predictions."""

    names: tuple[str, str]
    distance: float


@dataclass(frozen=True)
class NextTest:
    """A test to make: frequency (Hz), amplitude (m or N), the closest two explanations that it separates.

    ``pairs``: how far apart every two of the compared explanations are, the best one's first.
    """

    frequency: float
    amplitude: float
    separates: tuple[str, str]
    distance: float
    pairs: tuple[Separation, ...]


class Conditions(NamedTuple):
    """Angular frequencies (rad/s) and input amplitudes (m or N) of n tests."""

    omega: np.ndarray
    amplitude: np.ndarray


@dataclass(frozen=True)
class _Prediction:
    """Harmonics (n, C, H) of n tests, and their derivatives (n, C, H, j) in standard deviations.

    ``moves`` (n,): whether the bolster is predicted to move; ``found`` (n,): whether there is a prediction.
    """

    harmonics: np.ndarray
    spread: np.ndarray
    found: np.ndarray
    moves: np.ndarray


def recommend(fits: Sequence[Fit]) -> NextTest | None:
    """The test that separates most fits, the best one first; None if there is nothing to separate."""
    if len(fits) < 2:
        return None
    units = _data(fits[0]).units
    frequency, acceleration = (each.ravel() for each in np.meshgrid(FREQUENCIES, ACCELERATIONS))
    frequency, acceleration = units.ratio(FREQUENCY) * frequency, units.ratio(ACCELERATION) * acceleration
    omega = 2.0 * np.pi * frequency
    forced = _data(fits[0]).model.forced
    tests = Conditions(omega, units.mass * acceleration if forced else acceleration / omega**2)
    predicted = [(fit, _predict(fit, tests)) for fit in fits]
    predicted = [each for each in predicted if each[1].found.mean() >= PREDICTED]
    if len(predicted) < 2:
        return None
    weight = _weights(_data(fits[0]), [prediction for _, prediction in predicted])
    pairs = list(combinations(predicted, 2))
    distances = np.array([_distances(one, other, weight) for (_, one), (_, other) in pairs])
    best = _choice(distances)
    here = distances[:, best]
    separated = here >= SEPARATED if (here >= SEPARATED).any() else np.ones(len(pairs), bool)
    # Pairs with the best explanation are of most interest.
    with_best = separated & [one is fits[0] for (one, _), _ in pairs]
    chosen = np.flatnonzero(with_best if with_best.any() else separated)
    closest = int(chosen[np.argmin(here[chosen])])
    separations = tuple(
        Separation((_name(one), _name(other)), float(distance))
        for ((one, _), (other, _)), distance in zip(pairs, here, strict=True)
    )
    return NextTest(float(frequency[best]), float(tests.amplitude[best]), *separations[closest], separations)


def _name(fit: Fit) -> str:
    return " + ".join(fit.effects) or "base"


def _data(fit: Fit) -> HarmonicData:
    return cast(HarmonicData, fit.model.data)


def _choice(distances: np.ndarray) -> int:
    """The test (index in the grid) that separates most pairs, the cheapest of several.

    ``distances`` (pairs, n). If none separates any, the one at which the closest pair lies farthest apart.
    """
    grid = distances.reshape(len(distances), ACCELERATIONS.size, FREQUENCIES.size)
    sure = minimum_filter1d(grid, 3, axis=1, mode="nearest")
    separated = (sure >= SEPARATED).sum(axis=0)
    least = np.where(separated == separated.max(), sure.min(axis=0), -1.0)
    if not separated.any():
        return int(np.argmax(least))
    row = int(np.argmax(separated.max(axis=1)))
    return row * FREQUENCIES.size + int(np.argmax(least[row]))


def _predict(fit: Fit, tests: Conditions) -> _Prediction:
    steps = np.r_[STEP * fit.model.scale, AMPLITUDE_STEP]
    nothing = np.zeros((1, steps.size))
    here, found, warm = _responses(fit, tests, nothing, at_rest(tests.omega.size))

    def changes(moves: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        there, found, _ = _responses(fit, tests, moves, warm.repeated(len(moves)))
        return there - here, found

    change = derivatives(changes, steps, np.full(steps.size, True))
    by_x, by_amplitude = change.values[..., :-1], change.values[..., -1:]
    spread = np.concatenate([by_x @ _covariance_root(fit), by_amplitude * AMPLITUDE_STD], axis=-1)
    known = found[0] & change.found.all(axis=0)
    deflection = _data(fit).model.deflection(tests.omega) * tests.amplitude
    moves = known & (np.abs(here[0, :, 0, 0]) > MOVES * deflection)
    return _Prediction(here[0], spread, known, moves)


def _responses(
    fit: Fit, tests: Conditions, steps: np.ndarray, warm: Warm
) -> tuple[np.ndarray, np.ndarray, Warm]:
    """Harmonics (j, n, C, H) of n tests with x and amplitude moved by ``steps`` (j, k + u + 1), if found.

    The last step is the relative one of the amplitude.
    """
    model, data = fit.model, _data(fit)
    rows = [
        simulation.records(
            data.model,
            data.law,
            {name: each for name, each in model.values(fit.x + step[:-1]).items() if name != INPUT_GAIN},
            tests.omega,
            tests.amplitude * (1.0 + step[-1]),
        )
        for step in steps
    ]
    done = _simulated(fit, np.concatenate(rows), warm)
    harmonics = done.harmonics[:, : data.shape[0], : data.shape[1]]
    harmonics = harmonics.reshape(len(steps), tests.omega.size, *data.shape)
    return harmonics, done.found.reshape(len(steps), -1), done.warm


def _simulated(fit: Fit, rows: np.ndarray, warm: Warm) -> simulation.Responses:
    """Responses of tests that nobody made, in which a spurious tone may have any phase."""
    data = _data(fit)
    harmonics, tone = data.shape[1], data.tone
    if tone is None or not data.has_tone(fit.effects):
        return simulation.respond(rows, warm, harmonics)
    unknown = np.full(len(rows), np.nan)
    untimed = (simulation.ToneTiming(simulation.UNTIMED, 0.0, np.nan),) * len(rows)
    return simulation.respond_with_tone(rows, warm, harmonics, tone, untimed, unknown)


def _covariance_root(fit: Fit) -> np.ndarray:
    """Root (k + u, k + u) of the covariance of a fit, in which no parameter is wider than its range."""
    std = np.sqrt(np.diag(fit.covariance))
    share = np.minimum(1.0, WIDEST * fit.model.scale / np.maximum(std, 1e-300))
    values, vectors = np.linalg.eigh(fit.covariance * np.outer(share, share))
    return vectors * np.sqrt(np.maximum(values, 0.0))


def _weights(data: HarmonicData, predictions: Sequence[_Prediction]) -> np.ndarray:
    """One over the noise of a real part (n, C, 1), if new tests are as noisy as those made.

    The noise is relative to the first prediction that exists, as a wedge may lock under some of them.
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
        size = np.where(each.found[:, None, None] & (own > 0.0), own, size)
    return np.sqrt(2.0) / (np.median(level) * size)


def _distances(a: _Prediction, b: _Prediction, weight: np.ndarray) -> np.ndarray:
    """Squared distances (n,) of two predictions beyond start phase and everything that is uncertain."""
    distance = np.zeros(len(a.harmonics))
    orders = np.arange(1, a.harmonics.shape[-1] + 1)
    for i in np.flatnonzero(a.moves & b.moves):
        turn = np.angle((a.harmonics[i] * b.harmonics[i].conj())[:, 0].sum())
        other = b.harmonics[i] * np.exp(1j * orders * turn)
        gap = real((weight[i] * (a.harmonics[i] - other))[None])[0]
        columns = [weight[i] * 1j * orders * a.harmonics[i] * FREE_PHASE]
        columns += [weight[i] * a.spread[i, ..., k] for k in range(a.spread.shape[-1])]
        rotated = b.spread[i] * np.exp(1j * orders * turn)[:, None]
        columns += [weight[i] * rotated[..., k] for k in range(rotated.shape[-1])]
        free = np.stack([real(each[None])[0] for each in columns], axis=1)
        # The least that any change of the parameters leaves, which itself counts in standard deviations.
        matrix = np.concatenate([free, np.eye(free.shape[1])])
        aim = np.concatenate([gap, np.zeros(free.shape[1])])
        change = np.linalg.lstsq(matrix, aim, rcond=None)[0]
        distance[i] = ((aim - matrix @ change) ** 2).sum()
    return distance
