"""What the tests could show of each effect, before anything is fitted.

A score test asks whether the misfit of the base model points the scan in which an effect would change the
response, once what phases, amplitudes and uncertain numbers can take up is taken out of both.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from math import inf, log
from typing import NamedTuple

import numpy as np

from wedgesweep.diagnose.fit_parameters import Hypothesis
from wedgesweep.diagnose.projector import Projector
from wedgesweep.diagnose.search import Search
from wedgesweep.diagnose.steady import tone
from wedgesweep.diagnose.steady.fit_data import FitData, real
from wedgesweep.diagnose.steady.model import Evaluation, Fit, Model
from wedgesweep.diagnose.steady.tone import TONE

# Share of a signal that must survive the nuisances for an effect to be testable.
RETAINED = 0.05
# Squared distance from the base model that the tests would have shown.
DETECTABLE = 12.6
# Points between the weakest and the strongest value of an effect's leading number, and how many times weaker
# than that it may be said to show.
POINTS, BEYOND = 12, 1e3
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


def scores(search: Search, base: Fit) -> list[Score]:
    """Score of every effect of a search, in its order."""
    project = Projector(base)
    found = search.each(lambda effect: _score(search, base, effect, project), search.effects)
    return [*found, _undetected_tone(search.data, base)] if search.tone_undetected else found


def _undetected_tone(data: FitData, base: Fit) -> Score:
    """Score of a foreign tone where none stands out: what would have shown, between the harmonics."""
    frequency = tone.between(data.spectra)
    silent = replace(
        data, spectra=tuple(s.with_undetected_tone(frequency) for s in data.spectra), tone=frequency
    )
    search = Search(silent, (TONE,))
    model = search.model()
    fit = Fit(model, model.evaluate(base.evaluation.point), base.covariance, base.converged)
    return replace(_score(search, fit, TONE, Projector(fit)), t2=None)


class _Scan(NamedTuple):
    """Points (n, k) along one number of an effect.

    ``sizes`` (n,): how far the responses there are from the base model's; ``left``: what is left of that, a
    row each, once the nuisances are projected out.
    """

    number: int
    points: np.ndarray
    sizes: np.ndarray
    left: np.ndarray

    @property
    def distance(self) -> np.ndarray:
        """What the tests would show of each point, (n,)."""
        return (self.left**2).sum(axis=1)


def _score(search: Search, base: Fit, effect: str, project: Projector) -> Score:
    model = search.model(effect)
    for scan in _scans(search, base, model, project):
        if scan.distance.min() < DETECTABLE:
            break
    size = np.sqrt(scan.distance)
    weak = _weakest(size)
    retention = float(size[weak] / scan.sizes[weak]) if scan.sizes[weak] > 0.0 else 0.0
    t2 = None
    if retention >= RETAINED and size[weak] > 0.0:
        t2 = float((scan.left[weak] @ project.misfit) ** 2 / size[weak] ** 2)
    key = model.hypothesis.parameters[scan.number].name.split(".")[1]
    return Score(effect, t2, retention, key, _detectable(model.hypothesis, scan, key))


def _scans(search: Search, base: Fit, model: Model, project: Projector) -> Iterator[_Scan]:
    """Along the leading number of an effect; along others, if it does not fade with the first.

    Stribeck friction without a peak is not the base model: it fades with its velocity.
    """

    def tried(number: int, points: np.ndarray, evaluations: Sequence[Evaluation]) -> _Scan:
        changes = [_change(base, each) for each in evaluations]
        left = np.array([project(each) for each in changes])
        return _Scan(number, points, np.array([np.linalg.norm(each) for each in changes]), left)

    def simulated(number: int, points: np.ndarray) -> _Scan:
        return tried(number, points, model.evaluate_all([model.start(base, x) for x in points]))

    hypothesis, coordinates = model.hypothesis, model.hypothesis.parameters
    known = search.scans.get(hypothesis.effects[0])
    told = not np.isinf(base.model.data.amplitude_std).any()
    if known and told and len(coordinates) == 1 and coordinates[0].logarithmic:
        leading = tried(0, np.array([evaluation.point.x[:1] for evaluation in known]), known)
    else:
        leading = simulated(0, _path(hypothesis, 0))
    yield leading
    if coordinates[0].logarithmic:  # it fades beyond its range
        return
    for number, each in enumerate(coordinates):
        if each.logarithmic:
            yield simulated(number, _path(hypothesis, number))


def _path(hypothesis: Hypothesis, number: int) -> np.ndarray:
    """Points (n, k) from where an effect hardly acts to where it does, along one of its numbers.

    The others are in the middle of their range, but for a leading one that is neutral somewhere.
    """
    first, along = hypothesis.parameters[0], hypothesis.parameters[number]
    neutral = _neutral(hypothesis)
    at = np.array([0.5 * (each.low + each.high) for each in hypothesis.parameters])
    if not first.logarithmic:
        at[0] = neutral
    path = np.repeat(at[None], POINTS, axis=0)
    if along.logarithmic:
        path[:, number] = np.linspace(along.low, along.high, POINTS)
    else:
        path[:, number] = neutral + (along.high - neutral) * np.geomspace(1e-4, 1.0, POINTS)
    return path


def _neutral(hypothesis: Hypothesis) -> float:
    """Number in its range at which the leading one of an effect acts least, if it is no logarithm."""
    first = hypothesis.parameters[0]
    return min(max(first.neutral, first.low), first.high)


def _change(base: Fit, evaluation: Evaluation) -> np.ndarray:
    """How a trial's responses differ from the base model's (T, m), turned alike; none where not found."""
    data = base.model.data
    both = data.rotated(
        np.stack([evaluation.whitened, base.evaluation.whitened]), np.stack([base.evaluation.phase] * 2)
    )
    change = real(both[0] - both[1])
    change[~evaluation.found_tests] = 0.0
    return change


def _weakest(left: np.ndarray) -> int:
    """The point with the smallest change that is more than rounding."""
    seen = np.flatnonzero(left > 1e-2)
    return int(seen[np.argmin(left[seen])]) if seen.size else int(np.argmax(left))


def _detectable(hypothesis: Hypothesis, scan: _Scan, key: str) -> float | None:
    """Weakest value of a number at which the squared distance exceeds what shows."""
    distance, points = scan.distance, scan.points
    shown = [i for i in np.argsort(distance) if distance[i] >= DETECTABLE]
    if not shown:
        return None
    i = int(shown[0])
    below = [j for j in (i - 1, i + 1) if 0 <= j < len(points) and distance[j] < DETECTABLE]
    point = points[i].copy()
    if below:
        j = below[0]
        low, high = np.sqrt(distance[j]), np.sqrt(distance[i])
        point += (points[j] - points[i]) * (high - np.sqrt(DETECTABLE)) / (high - low)
    elif hypothesis.parameters[scan.number].logarithmic and i in (0, len(points) - 1):
        point[scan.number] += _beyond(points[:, scan.number], distance, i)
    elif i == 0:  # next to its neutral value it acts in proportion
        neutral = _neutral(hypothesis)
        point[scan.number] = neutral + (point[scan.number] - neutral) * np.sqrt(DETECTABLE / distance[i])
    return float(hypothesis.in_key_units(point)[hypothesis.effects[0]].get(key, inf))


def _beyond(x: np.ndarray, distance: np.ndarray, end: int) -> float:
    """How far beyond an end of a logarithmic range an effect would fade that still shows there.

    A weak effect changes responses by a power of its number, that of the last two points. 0 if it does not
    fade by that: what a range ends with did show.
    """
    inwards = 1 if end == 0 else end - 1
    slope = np.log(distance[end] / distance[inwards]) / (x[end] - x[inwards])
    fades = np.log(DETECTABLE / distance[end]) / slope if slope else np.inf
    outwards = fades * (x[end] - x[inwards]) > 0.0
    return float(fades) if outwards and abs(fades) < log(BEYOND) else 0.0
