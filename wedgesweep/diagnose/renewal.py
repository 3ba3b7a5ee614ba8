"""Residuals whose covariance depends on the model: renew it at the best explanation.

The noise of a recorded input reaches the comparison through the response. Near a resonance the base model may
pass on much more, or much less, of it than the right model does.
"""

from dataclasses import replace

from wedgesweep.diagnose.explanation import Explanation, penalised
from wedgesweep.diagnose.least_squares import BRIEF, minimise
from wedgesweep.diagnose.search import Explained, Search, contenders


def with_renewed_covariance(explained: Explained) -> Explained:
    """All fits compared again under the covariance of the best explanation; the leading ones are refitted.

    All explanations share one covariance, as only then are their misfits on one scale.
    """
    search, base, found, scans = explained
    best = min([base, *found], key=penalised).fit
    data = search.data.renewed(best.model.scenario(best.point))
    if data is search.data:
        return explained
    search = replace(search, data=data)
    found = sorted((_compared_again(search, each) for each in found), key=penalised)
    leading = contenders(search, found)
    others = [each for each in found if not any(each is one for one in leading)]
    again = [_compared_again(search, base), *leading]
    base, *leading = search.each(lambda each: _refitted(search, each), again)
    found = sorted([*leading, *others], key=penalised)
    scans = {effect: [data.compared_again(each) for each in scan] for effect, scan in scans.items()}
    return Explained(search, base, found, scans)


def _compared_again(search: Search, each: Explanation) -> Explanation:
    model = each.fit.model.on(search.data)
    evaluation = search.data.compared_again(each.fit.evaluation)
    return search.explanation(replace(each.fit, model=model, evaluation=evaluation))


def _refitted(search: Search, each: Explanation) -> Explanation:
    return search.explanation(minimise(each.fit.model, each.fit.evaluation, BRIEF))
