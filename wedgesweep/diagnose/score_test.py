"""Score tests: whether the tests show an effect, and the weakest value that they would have shown.

A score test asks whether the misfit of the base model points in the direction in which an effect would change
the response, after everything that nuisance and uncertain parameters can take up is projected out of both.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from math import inf, log
from typing import NamedTuple

import numpy as np

from wedgesweep.diagnose.evaluation import Evaluation
from wedgesweep.diagnose.fit_parameters import Hypothesis
from wedgesweep.diagnose.model import Fit, Model
from wedgesweep.diagnose.parameter_constancy import Projector
from wedgesweep.diagnose.search import Scans, Search

# Share of a change of the response that must survive the projection for an effect to be testable.
RETAINED = 0.05
# An effect is detectable if it moves the response this far (squared distance) from that of the base model.
DETECTABLE = 12.6
# Points between the weakest and the strongest value of an effect's leading parameter, and how many times
# weaker than the weakest a detectable value may be extrapolated.
POINTS, EXTRAPOLATED = 12, 1e3
# Norm of a projected change that is more than rounding.
ROUNDING = 1e-2


@dataclass(frozen=True)
class Score:
    """Score of one effect.

    ``t2``: chi-squared with one degree of freedom if the effect is absent, None if not testable.
    ``retention``: share of the change by a weak effect that survives the projection. ``detectable``: the
    weakest value of ``key``, in its unit, that the tests would have shown; None if they would not show any.
    """

    effect: str
    t2: float | None
    retention: float
    key: str
    detectable: float | None

    @property
    def testable(self) -> bool:
        return self.retention >= RETAINED and self.detectable is not None


class _Scan(NamedTuple):
    """Points (n, k) along one parameter of an effect.

    ``sizes`` (n,): norms of the changes of the base model's responses; ``projected``: the changes after
    projection, a row each.
    """

    parameter: int
    points: np.ndarray
    sizes: np.ndarray
    projected: np.ndarray

    @property
    def distance(self) -> np.ndarray:
        """Squared distance of each point from the base model as the tests would show it, (n,)."""
        return (self.projected**2).sum(axis=1)


class _Baseline(NamedTuple):
    """The fitted base model with its projection."""

    search: Search
    fit: Fit
    project: Projector

    def scan(self, parameter: int, points: np.ndarray, evaluations: Sequence[Evaluation]) -> _Scan:
        """The changes between the base model and some evaluations."""
        data, here = self.fit.model.data, self.fit.evaluation
        changes = [data.response_change(here, each) for each in evaluations]
        for change, each in zip(changes, evaluations, strict=True):
            change[~each.found_tests] = 0.0
        sizes = np.array([np.linalg.norm(each) for each in changes])
        return _Scan(parameter, points, sizes, np.array([self.project(each) for each in changes]))


def scores(search: Search, base: Fit, scans: Scans) -> list[Score]:
    """Score of every effect of a search, in its order; those that were not detected come last."""
    baseline = _Baseline(search, base, Projector(base))
    found = search.each(lambda effect: _score(baseline, effect, scans.get(effect, ())), search.effects)
    return [*found, *(_score_undetected(search, base, effect) for effect in search.undetected)]


def _score_undetected(search: Search, base: Fit, effect: str) -> Score:
    """Score of an effect of which the records show nothing; only its detectable value is of interest."""
    data = search.data.with_undetected(effect)
    if data is search.data:  # such records do not depend on the effect
        key = search.model(effect).hypothesis.parameters[0].key
        return Score(effect, None, 0.0, key, None)
    silent = Search(data, (effect,))
    model = silent.model()
    fit = Fit(model, model.evaluate(base.point), base.covariance, base.converged)
    return replace(_score(_Baseline(silent, fit, Projector(fit)), effect, ()), t2=None)


def _score(baseline: _Baseline, effect: str, known: Sequence[Evaluation]) -> Score:
    model = baseline.search.model(effect)
    for scan in _scans(baseline, model, known):
        if scan.distance.min() < DETECTABLE:
            break
    size = np.sqrt(scan.distance)
    weak = _weakest(size)
    retention = float(size[weak] / scan.sizes[weak]) if scan.sizes[weak] > 0.0 else 0.0
    t2 = None
    if retention >= RETAINED and size[weak] > 0.0:
        t2 = float((scan.projected[weak] @ baseline.project.misfit) ** 2 / size[weak] ** 2)
    key = model.hypothesis.parameters[scan.parameter].key
    return Score(effect, t2, retention, key, _detectable(model.hypothesis, scan, key))


def _scans(baseline: _Baseline, model: Model, known: Sequence[Evaluation]) -> Iterator[_Scan]:
    """Scans along the leading parameter of an effect, then along its logarithmic ones.

    The latter are for effects that do not fade with the leading one: Stribeck friction is not the base model
    without its peak, but only with a small velocity as well.
    """
    base, hypothesis = baseline.fit, model.hypothesis

    def simulated(parameter: int) -> _Scan:
        points = _path(hypothesis, parameter)
        return baseline.scan(parameter, points, model.evaluate_all([model.start(base, x) for x in points]))

    parameters = hypothesis.parameters
    stated = not np.isinf(base.model.data.nuisance_std).any()
    if known and stated and len(parameters) == 1 and parameters[0].logarithmic:
        yield baseline.scan(0, np.array([each.point.x[:1] for each in known]), known)
    else:
        yield simulated(0)
    if parameters[0].logarithmic:  # it fades beyond its range
        return
    for parameter, each in enumerate(parameters):
        if each.logarithmic:
            yield simulated(parameter)


def _path(hypothesis: Hypothesis, parameter: int) -> np.ndarray:
    """Points (n, k) from where an effect hardly acts to where it does, along one of its parameters.

    The others are in the middle of their range, except for a leading one that has a neutral value.
    """
    first, varied = hypothesis.parameters[0], hypothesis.parameters[parameter]
    at = np.array([0.5 * (each.low + each.high) for each in hypothesis.parameters])
    if first.fades:
        at[0] = first.neutral
    path = np.repeat(at[None], POINTS, axis=0)
    if varied.fades:
        path[:, parameter] = varied.neutral + (varied.high - varied.neutral) * np.geomspace(1e-4, 1.0, POINTS)
    else:
        path[:, parameter] = np.linspace(varied.low, varied.high, POINTS)
    return path


def _weakest(size: np.ndarray) -> int:
    """The point with the smallest change that is more than rounding."""
    seen = np.flatnonzero(size > ROUNDING)
    return int(seen[np.argmin(size[seen])]) if seen.size else int(np.argmax(size))


def _detectable(hypothesis: Hypothesis, scan: _Scan, key: str) -> float | None:
    """Weakest value of a parameter at which the squared distance reaches DETECTABLE."""
    distance, points = scan.distance, scan.points
    shown = [i for i in np.argsort(distance) if distance[i] >= DETECTABLE]
    if not shown:
        return None
    number, varied = scan.parameter, hypothesis.parameters[scan.parameter]
    if varied.switches:  # the effect shows at all values, or at none
        return _value(hypothesis, points[min(shown)], key)
    i = int(shown[0])
    below = [j for j in (i - 1, i + 1) if 0 <= j < len(points) and distance[j] < DETECTABLE]
    point = points[i].copy()
    if below:
        j = below[0]
        low, high = np.sqrt(distance[j]), np.sqrt(distance[i])
        point += (points[j] - points[i]) * (high - np.sqrt(DETECTABLE)) / (high - low)
    elif varied.logarithmic and i in (0, len(points) - 1):
        point[number] += _extrapolation(points[:, number], distance, i)
    elif i == 0 and varied.fades:  # near its neutral value an effect acts in proportion
        point[number] = varied.neutral + (point[number] - varied.neutral) * np.sqrt(DETECTABLE / distance[i])
    return _value(hypothesis, point, key)


def _value(hypothesis: Hypothesis, x: np.ndarray, key: str) -> float:
    """A number of the only effect of a hypothesis, in its key unit."""
    return float(hypothesis.in_key_units(x)[hypothesis.effects[0]].get(key, inf))


def _extrapolation(x: np.ndarray, distance: np.ndarray, end: int) -> float:
    """How far beyond an end of its logarithmic range an effect that still shows there would fade.

    A weak effect changes responses by a power of its parameter, that of the last two points. 0 if the effect
    does not fade that way: the end of the range did show.
    """
    inwards = 1 if end == 0 else end - 1
    slope = np.log(distance[end] / distance[inwards]) / (x[end] - x[inwards])
    fades = np.log(DETECTABLE / distance[end]) / slope if slope else np.inf
    outwards = fades * (x[end] - x[inwards]) > 0.0
    return float(fades) if outwards and abs(fades) < log(EXTRAPOLATED) else 0.0
