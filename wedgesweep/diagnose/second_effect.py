"""A second effect beside one that is adequate: what chi-squared as a whole is too blunt to miss.

A misfit of a few standard deviations is lost among hundreds of numbers, and the effect that leads makes up
for another with a wrong value of its own. A score test asks for each other effect whether what is left points
its way; those that gain more than they cost are fitted as well.
"""

from typing import NamedTuple

import numpy as np

from wedgesweep.diagnose.evaluation import Evaluation
from wedgesweep.diagnose.explanation import ADEQUATE, parameter_penalty, penalised
from wedgesweep.diagnose.least_squares import minimise
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.parameter_constancy import Projector
from wedgesweep.diagnose.search import LEADING, Explained, Search
from wedgesweep.effects import go_together

# Share of its value at the start of a fit at which an effect is weak enough for responses to add.
WEAK = 0.01
# Share of a change that must survive the projection.
RETAINED = 0.05
# Name by which a spent budget tells what it left out.
SECOND = "a second effect beside an adequate one"


class Beside(NamedTuple):
    """A second effect: ``t2`` by which it would reduce chi-squared, and where its fit starts."""

    t2: float
    start: Evaluation
    effects: tuple[str, ...]


def adequate_alone(known: Explained) -> bool:
    """Whether a single effect leads, is adequate, and explains more than the base model."""
    best = min([known.base, *known.explanations], key=penalised)
    return len(best.effects) == 1 and best.p_value >= ADEQUATE


def with_second_effect(known: Explained) -> Explained:
    """The explanations with the leading effect beside each other one that what it leaves points to."""
    search, best = known.search, min(known.explanations, key=penalised)
    project = Projector(best)
    others = [each for each in search.effects if go_together((*best.effects, each))]
    scored = search.each(lambda other: _beside(search, best, project, other), others)
    cost = parameter_penalty(search.data)
    useful = sorted((each for each in scored if each.t2 > cost), key=lambda each: -each.t2)
    fits = search.each_affordable(
        lambda each: minimise(search.model(*each.effects), each.start), useful[:LEADING], SECOND
    )
    return known.joined(fits)


def _beside(search: Search, best: Fit, project: Projector, other: str) -> Beside:
    """The score of another effect, over the points at which its fit may start."""
    effects = (*best.effects, other)
    model, hypothesis = search.model(*effects), search.model(other).hypothesis
    first = best.x[: best.model.size]
    points = []
    for x in hypothesis.starts():
        parameter = hypothesis.parameters[0]
        if parameter.fades:
            x = np.r_[parameter.neutral + WEAK * (x[0] - parameter.neutral), x[1:]]
        points.append(model.start(best, np.r_[first, x]))
    found = [_scored(project, best, each, effects) for each in model.evaluate_all(points)]
    return max(found, key=lambda each: each.t2)


def _scored(project: Projector, best: Fit, there: Evaluation, effects: tuple[str, ...]) -> Beside:
    if not there.found:
        return Beside(0.0, there, effects)
    change = best.model.data.response_change(best.evaluation, there)
    left, size = project(change), float(np.linalg.norm(change))
    length = float(np.linalg.norm(left))
    t2 = float(left @ project.misfit) ** 2 / length**2 if length > RETAINED * size else 0.0
    return Beside(t2, there, effects)
