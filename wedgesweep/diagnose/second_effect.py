"""A second effect beside one that is adequate: what chi-squared as a whole is too blunt to miss.

A misfit of a few standard deviations is lost among hundreds of numbers, and the effect that leads makes up
for another with a wrong value of its own. A score test asks for each other effect whether what is left points
its way; those that gain more than they cost are fitted as well.
"""

from functools import partial
from math import nan
from typing import NamedTuple

import numpy as np

from wedgesweep.diagnose.evaluation import Evaluation, Point
from wedgesweep.diagnose.explanation import ADEQUATE, parameter_penalty, penalised
from wedgesweep.diagnose.least_squares import fit_from
from wedgesweep.diagnose.model import Fit, Model
from wedgesweep.diagnose.parameter_constancy import Projector
from wedgesweep.diagnose.score_test import RETAINED
from wedgesweep.diagnose.search import LEADING, Explained, Search
from wedgesweep.effects import go_together

# Share of its range at which an effect is weak enough for responses to add: where a mass comes to rest they
# add up to a thousandth only, and below a tenth of this rounding shows.
WEAK = 3e-4
# Names by which a spent budget tells what it left out.
SECOND_EFFECT, EITHER_FIRST = (
    "a second effect beside an adequate one",
    "the best pair from either of its effects",
)


class Candidate(NamedTuple):
    """An effect beside the fit of another one, with its own numbers ``x`` (k,) from which it is made weak.

    ``t2``: by which it would reduce chi-squared; NaN if that was not asked.
    """

    first: Fit
    other: str
    x: np.ndarray
    t2: float = nan

    @property
    def effects(self) -> tuple[str, ...]:
        return (*self.first.effects, self.other)


def adequate_alone(known: Explained) -> bool:
    """Whether a single effect leads, is adequate, and explains more than the base model.

    Not under an allowed model error: what such an error leaves may point the way of any effect.
    """
    best = min([known.base, *known.explanations], key=penalised)
    return len(best.effects) == 1 and best.p_value >= ADEQUATE and not best.model.data.model_error


def with_second_effect(known: Explained) -> Explained:
    """The explanations with the leading effect beside each other one that what it leaves points to."""
    search, best = known.search, min(known.explanations, key=penalised)
    project = Projector(best)
    others = [
        name for name in search.effects if name not in best.effects and go_together((*best.effects, name))
    ]
    scored = search.each(lambda other: _scored(search, best, project, other), others)
    cost = parameter_penalty(search.data)
    useful = sorted((each for each in scored if each.t2 > cost), key=lambda each: -each.t2)
    return known.joined(search.each_affordable(partial(_fitted, search), useful[:LEADING], SECOND_EFFECT))


def with_either_first(known: Explained) -> Explained:
    """The best pair fitted again from either of its effects by itself, as if the other did nothing.

    A mass with friction comes to rest after some number of swings, and each number has a minimum of its own.
    Where friction leads and takes the place of a damper, only the damper by itself leads to the right one.
    """
    search, found = known.search, known.explanations
    pair = min(found, key=penalised).effects
    alone = [each for each in found if len(each.effects) == 1 and each.effects[0] in pair]
    others = [next(name for name in pair if name not in first.effects) for first in alone]
    both = [
        Candidate(first, other, search.model(other).hypothesis.starts()[0])
        for first, other in zip(alone, others, strict=True)
    ]
    return known.joined(search.each_affordable(partial(_fitted, search), both, EITHER_FIRST))


def _fitted(search: Search, each: Candidate) -> Fit:
    """A fit that starts where the candidate does nothing, if it can: there it is as good as without."""
    model, alone = search.model(*each.effects), search.model(each.other).hypothesis
    return fit_from(model, _beside(model, each.first, alone.near_neutral(each.x)))


def _beside(model: Model, first: Fit, x: np.ndarray) -> Point:
    """The point of a model with the numbers x (k,) of its second effect beside a fit of the first one."""
    return model.start(first, np.r_[first.x[: first.model.size], x])


def _scored(search: Search, best: Fit, project: Projector, other: str) -> Candidate:
    """Another effect beside the best one, with the numbers by which it gains most."""
    model, alone = search.model(*best.effects, other), search.model(other).hypothesis
    parameter, points = alone.parameters[0], alone.starts()
    if parameter.fades:
        farthest = parameter.high if parameter.high > parameter.neutral else parameter.low
        points[:, 0] = parameter.neutral + WEAK * (farthest - parameter.neutral)
    points = np.unique(points, axis=0)
    evaluations = model.evaluate_all([_beside(model, best, x) for x in points])
    t2 = [_t2(project, best, each) for each in evaluations]
    leading = int(np.argmax(t2))
    return Candidate(best, other, points[leading], t2[leading])


def _t2(project: Projector, best: Fit, there: Evaluation) -> float:
    """Reduction of chi-squared along the change from the best fit to an evaluation, if responses add."""
    if not there.found:
        return 0.0
    change = best.model.data.response_change(best.evaluation, there)
    left, size = project(change), float(np.linalg.norm(change))
    length = float(np.linalg.norm(left))
    return float(left @ project.misfit) ** 2 / length**2 if length > RETAINED * size else 0.0
