"""What the tests could show of each effect, before anything is fitted.

A score test asks whether the misfit of the base model points the way in which an effect would change the
response, once what phases, amplitudes and uncertain numbers can take up is taken out of both.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import inf

import numpy as np

from wedgesweep.diagnose import tone
from wedgesweep.diagnose.coordinates import Hypothesis
from wedgesweep.diagnose.model import TONE, Fit, Model, Trial
from wedgesweep.diagnose.problem import Problem, real
from wedgesweep.diagnose.search import Search
from wedgesweep.diagnose.tangents import tangents_of
from wedgesweep.effects import EFFECTS

# Share of a signal that must survive the nuisances for an effect to be testable.
RETAINED = 0.05
# Squared distance from the base model that the tests would have shown.
SHOWN = 12.6
# Points between the weakest and the strongest value of an effect's leading number.
POINTS = 12
# A direction of a response that is not smooth: two steps must agree this well.
AGREE = 0.10


@dataclass(frozen=True)
class Score:
    """Score of one effect: t2 (chi-squared with one degree of freedom if it is absent), share retained.

    ``detectable`` is the weakest value (key unit) of ``key`` that the tests would have shown, None if none.
    """

    effect: str
    t2: float | None
    retention: float
    key: str
    detectable: float | None

    @property
    def testable(self) -> bool:
        return self.retention >= RETAINED and self.detectable is not None


class Projector:
    """Takes out of a change of the responses what the nuisances of a fit can imitate."""

    def __init__(self, fit: Fit) -> None:
        by_number, by_test = tangents_of(fit.model, fit.trial)
        tests, points, numbers = by_number.shape
        local = np.zeros((tests, points, tests, 2))
        local[np.arange(tests), :, np.arange(tests)] = by_test
        tangents = np.concatenate(
            [local.reshape(tests * points, -1), by_number.reshape(tests * points, numbers)], axis=1
        )
        priors = np.diag(
            np.r_[np.stack([np.zeros(tests), fit.model.amplitude_weight], 1).ravel(), self._stiff(fit)]
        )
        matrix = np.concatenate([tangents, priors])
        matrix /= np.maximum(np.linalg.norm(matrix, axis=0), 1e-300)
        u, s, _ = np.linalg.svd(matrix, full_matrices=False)
        self._basis = u[:, s > 1e-9]
        self._extra = len(priors)

    @staticmethod
    def _stiff(fit: Fit) -> np.ndarray:
        numbers = np.zeros(len(fit.x))
        numbers[fit.model.size :] = 1.0 / fit.model.prior_std
        return numbers

    def __call__(self, change: np.ndarray) -> np.ndarray:
        """What is left of a change (T, m), as one vector."""
        vector = np.r_[change.ravel(), np.zeros(self._extra)]
        return vector - self._basis @ (self._basis.T @ vector)


def scores(search: Search, base: Fit) -> list[Score]:
    """Score of every effect of a search, in its order."""
    project = Projector(base)
    residual = project(base.trial.residual)
    found = search.each(lambda effect: _score(search, base, effect, project, residual), search.effects)
    return [*found, _unheard(search.problem, base)] if search.unheard else found


def _unheard(problem: Problem, base: Fit) -> Score:
    """Score of a foreign tone where none stands out: what would have shown, between the harmonics."""
    frequency = tone.between(problem.spectra)
    silent = replace(
        problem, spectra=tuple(s.with_silence(frequency) for s in problem.spectra), tone=frequency
    )
    search = Search(silent, (TONE,))
    model = search.model()
    fit = Fit(model, model.trial(base.trial.point), base.covariance, base.arrived)
    project = Projector(fit)
    return replace(_score(search, fit, TONE, project, project(fit.trial.residual)), t2=None)


def _score(search: Search, base: Fit, effect: str, project: Projector, residual: np.ndarray) -> Score:
    model = search.model(effect)
    hypothesis = model.hypothesis
    path, trials = _along(search, base, model)
    changes = [_change(base, each) for each in trials]
    sizes = np.array([np.linalg.norm(each) for each in changes])
    remaining = [project(each) for each in changes]
    left = np.array([np.linalg.norm(each) for each in remaining])
    key = hypothesis.coordinates[0].name.split(".")[1]
    weak = _weakest(left)
    retention = float(left[weak] / sizes[weak]) if sizes[weak] > 0.0 else 0.0
    t2 = None
    if retention >= RETAINED and left[weak] > 0.0:
        t2 = float((remaining[weak] @ residual) ** 2 / left[weak] ** 2)
    return Score(effect, t2, retention, key, _detectable(hypothesis, path, left**2))


def _along(search: Search, base: Fit, model: Model) -> tuple[np.ndarray, Sequence[Trial]]:
    """Points (n, k) along the leading number of an effect, and their responses."""
    hypothesis, coordinates = model.hypothesis, model.hypothesis.coordinates
    known = search.along.get(hypothesis.effects[0])
    told = not np.isinf(base.model.problem.amplitude_std).any()
    if known and told and len(coordinates) == 1 and coordinates[0].logarithmic:
        return np.array([trial.point.x[:1] for trial in known]), known
    path = _path(hypothesis)
    return path, model.trials([model.start(base, x) for x in path])


def _path(hypothesis: Hypothesis) -> np.ndarray:
    """Points (n, k) from where an effect hardly acts to where it does, along its leading number."""
    first = hypothesis.coordinates[0]
    quantity = EFFECTS[hypothesis.effects[0]].quantities[0]
    others = np.array([0.5 * (each.low + each.high) for each in hypothesis.coordinates])
    if first.logarithmic:
        leading = np.linspace(first.low, first.high, POINTS)
    else:
        neutral = (
            min(max(quantity.default, first.low), first.high)
            if quantity.default == quantity.default
            else first.low
        )
        leading = neutral + (first.high - neutral) * np.geomspace(1e-4, 1.0, POINTS)
    path = np.repeat(others[None], POINTS, axis=0)
    path[:, 0] = leading
    return path


def _change(base: Fit, trial: Trial) -> np.ndarray:
    """How a trial's responses differ from the base model's (T, m), turned alike; none where not found."""
    problem = base.model.problem
    both = problem.turned(np.stack([trial.whitened, base.trial.whitened]), np.stack([base.trial.phase] * 2))
    change = real(both[0] - both[1])
    change[~trial.found_tests] = 0.0
    return change


def _weakest(left: np.ndarray) -> int:
    """The point with the smallest change that is more than rounding."""
    seen = np.flatnonzero(left > 1e-2)
    return int(seen[np.argmin(left[seen])]) if seen.size else int(np.argmax(left))


def _detectable(hypothesis: Hypothesis, path: np.ndarray, distance: np.ndarray) -> float | None:
    """Weakest value of the leading number at which the squared distance exceeds what shows."""
    order = np.argsort(distance)
    shown = [i for i in order if distance[i] >= SHOWN]
    if not shown:
        return None
    i = shown[0]
    key = hypothesis.coordinates[0].name.split(".")[1]
    below = [j for j in (i - 1, i + 1) if 0 <= j < len(path) and distance[j] < SHOWN]
    point = path[i].copy()
    if below:
        j = below[0]
        low, high = np.sqrt(distance[j]), np.sqrt(distance[i])
        point[0] = path[j, 0] + (path[i, 0] - path[j, 0]) * (np.sqrt(SHOWN) - low) / (high - low)
    values = hypothesis.in_key_units(point)[hypothesis.effects[0]]
    value = values.get(key, inf)
    return float(value)
