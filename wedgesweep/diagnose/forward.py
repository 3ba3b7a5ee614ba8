"""Forward selection: effects are added to the best pair one at a time, as long as predictions gain.

On a damper rig several causes at once are the rule. Where neither one effect nor two explain the tests, the
effects that are added next, with the gain of each, say what the model lacks; they are not named as causes.
Tests that are left out of the fits are the judge, as each further effect fits the others better.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from wedgesweep.diagnose.cross_validation import Predictor
from wedgesweep.diagnose.explanation import NOTABLE, Explanation
from wedgesweep.diagnose.ladder import Level, Rated, by_accuracy, level_of, rated_where_it_ended
from wedgesweep.diagnose.least_squares import minimise
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.search import Search
from wedgesweep.effects import go_together

NAME = "forward selection"
# Effects beside each other, at most: with more, none of a rig's few tests would be left to judge them.
MOST = 5
# Iterations of the first fit of each candidate, and candidates that are followed to the end.
BRIEF, FOLLOWED = 5, 3
# Work that may be spent, as a share of the work of the whole search.
SHARE = 1.0 / 6.0


def forward_selection(
    search: Search, explanations: Sequence[Explanation], levels: Sequence[Level], predict: Predictor
) -> tuple[Level, ...]:
    """The levels of the ladder, and one more for each effect that is added to its best pair.

    None is added where no pair was fitted, or where it predicts hardly better than one effect.
    """
    found = list(levels)
    if len(found[-1].best.effects) < 2 or not _gained(*found[-2:]):
        return tuple(found)
    singles = {each.effects[0]: each.fit for each in explanations if len(each.effects) == 1}
    search.budget.grant(SHARE * search.budget.total)
    while len(found[-1].best.effects) < MOST:
        rated = _with_one_more(search, found[-1].best, singles)
        level = level_of(search, rated, predict) if rated else None
        if level is None or not _gained(found[-1], level):
            break
        found.append(level)
    return tuple(found)


def _gained(before: Level, after: Level) -> bool:
    """Whether a level predicts tests left out clearly better than the one with an effect less."""
    was, now = before.best.held_out, after.best.held_out
    return was is not None and now is not None and now < NOTABLE * was


def _with_one_more(search: Search, best: Rated, singles: Mapping[str, Fit]) -> list[Rated]:
    """The best explanation with each other effect that can go with it; only the leading ones, best first."""
    others = [
        single
        for name, single in singles.items()
        if name not in best.effects and go_together((*best.effects, name))
    ]
    begun = search.each_affordable(lambda single: _begun(search, best, single), others, NAME)
    leading = sorted(begun, key=lambda fit: fit.chi2)[:FOLLOWED]
    found = search.each(lambda fit: rated_where_it_ended(Explanation(fit)), leading)
    return sorted(found, key=by_accuracy)


def _begun(search: Search, best: Rated, single: Fit) -> Fit:
    """A fit under the model error of the best explanation, with one effect more.

    The new effect starts as it was fitted by itself, or so weak that it changes nothing.
    """
    fit = best.fit
    model = search.model(*fit.effects, *single.effects)
    model = model.on(fit.model.data.with_model_error(best.accuracy))
    alone, hypothesis = single.x[: single.model.size], single.model.hypothesis
    starts = [np.r_[fit.x[: fit.model.size], x] for x in (alone, hypothesis.near_neutral(alone))]
    evaluations = model.evaluate_all([model.start(fit, x) for x in starts])
    return minimise(model, min(evaluations, key=lambda each: each.chi2), BRIEF)
