"""A second effect beside one that is adequate: what chi-squared as a whole is too blunt to miss.

A misfit of a few standard deviations is lost among hundreds of numbers, and the effect that leads makes up
for another with a wrong value of its own. A score test asks for each other effect whether what is left points
its way; those that gain more than they cost are fitted as well.
"""

from functools import partial
from typing import NamedTuple

import numpy as np

from wedgesweep.diagnose.evaluation import Evaluation, Point
from wedgesweep.diagnose.explanation import ADEQUATE, parameter_penalty, penalised
from wedgesweep.diagnose.least_squares import grown, minimise, of_beginnings
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.parameter_constancy import Projector
from wedgesweep.diagnose.score_test import RETAINED
from wedgesweep.diagnose.search import LEADING, Explained, Search
from wedgesweep.effects import go_together

# Share of its range at which an effect is weak enough for responses to add: where a mass comes to rest they
# add up to a thousandth only, and below a tenth of this rounding shows.
WEAK = 3e-4
# Names by which a spent budget tells what it left out.
SECOND, EITHER = "a second effect beside an adequate one", "the best pair from either of its effects"


class Beside(NamedTuple):
    """A second effect: ``t2`` by which it would reduce chi-squared, and where its fit starts."""

    t2: float
    point: Point
    effects: tuple[str, ...]


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
    scored = search.each(lambda other: _beside(search, best, project, other), others)
    cost = parameter_penalty(search.data)
    useful = sorted((each for each in scored if each.t2 > cost), key=lambda each: -each.t2)
    return known.joined(search.each_affordable(partial(_fitted, search), useful[:LEADING], SECOND))


def with_either_first(known: Explained) -> Explained:
    """The best pair fitted again from either of its effects by itself, as if the other did nothing.

    A mass with friction comes to rest after some number of swings, and each number has a minimum of its own.
    Where friction leads and takes the place of a damper, only the damper by itself leads to the right one.
    """
    search, found = known.search, known.explanations
    pair = min(found, key=penalised).effects
    alone = [each for each in found if len(each.effects) == 1 and each.effects[0] in pair]

    def followed(first: Fit) -> Fit:
        (other,) = set(pair) - set(first.effects)
        hypothesis = search.model(other).hypothesis
        model = search.model(*first.effects, other)
        x = np.r_[first.x[: first.model.size], hypothesis.near_neutral(hypothesis.starts()[0])]
        return _fitted(search, Beside(0.0, model.start(first, x), model.effects))

    return known.joined(search.each_affordable(followed, alone, EITHER))


def _fitted(search: Search, beside: Beside) -> Fit:
    model = search.model(*beside.effects)
    begun = of_beginnings(model)
    return grown(model, minimise(begun, begun.evaluate(beside.point)))


def _beside(search: Search, best: Fit, project: Projector, other: str) -> Beside:
    """The score of another effect, by the point at which it gains most.

    A fit starts from where the effect does nothing, if there is such a point: there it is as good as without.
    """
    effects, hypothesis = (*best.effects, other), search.model(other).hypothesis
    model, first, points = search.model(*effects), hypothesis.parameters[0], hypothesis.starts()
    if first.fades:
        farthest = first.high if first.high > first.neutral else first.low
        points[:, 0] = first.neutral + WEAK * (farthest - first.neutral)
    points, known = np.unique(points, axis=0), best.x[: best.model.size]
    found = model.evaluate_all([model.start(best, np.r_[known, x]) for x in points])
    t2 = [_t2(project, best, each) for each in found]
    leading = int(np.argmax(t2))
    start = hypothesis.near_neutral(points[leading])
    return Beside(t2[leading], model.start(best, np.r_[known, start]), effects)


def _t2(project: Projector, best: Fit, there: Evaluation) -> float:
    """Reduction of chi-squared along the change from the best fit to an evaluation, if responses add."""
    if not there.found:
        return 0.0
    change = best.model.data.response_change(best.evaluation, there)
    left, size = project(change), float(np.linalg.norm(change))
    length = float(np.linalg.norm(left))
    return float(left @ project.misfit) ** 2 / length**2 if length > RETAINED * size else 0.0
