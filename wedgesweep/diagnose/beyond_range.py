"""Fits beyond the searched range of a number, for numbers that ended at an end of it.

The ranges suit dampers like the bench's, in natural units of the model on trial. On another rig a number may
lie outside: bristles that are shorter, a drag that is larger. A fit then ends at the end of the range, and
what it leaves would be taken for a cause that no effect describes.
"""

from dataclasses import replace

from wedgesweep.diagnose.explanation import NOTABLE, penalised
from wedgesweep.diagnose.least_squares import minimise
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.search import LEADING, Explained
from wedgesweep.diagnose.work import SLIGHT

# A number is at an end of its range if it is closer to it than this share of the range's width.
AT_END = 1e-3


def followed_beyond(known: Explained) -> Explained:
    """The best explanations at an end of their range fitted again beyond it.

    The search knows the ranges that were left. An effect that explains next to nothing ends where it is
    absent, as an ever stiffer column does; it stays there.
    """
    search, base, found, _ = known
    leading = [
        each
        for each in sorted(found, key=penalised)[:LEADING]
        if each.chi2 < NOTABLE * base.chi2 and effects_at_range_end(each)
    ]
    better = [
        further
        for each, further in zip(leading, search.each(_followed, leading), strict=True)
        if further.chi2 < each.chi2 - SLIGHT
    ]
    wider = {name for each in better for name in each.model.hypothesis.wider}
    search = replace(search, wider=tuple(sorted({*search.wider, *wider})))
    return known._replace(search=search).joined(better)


def effects_at_range_end(fit: Fit) -> tuple[str, ...]:
    """Effects with a number at an end of its searched range beyond which it may go."""
    hypothesis = fit.model.hypothesis
    ends = []
    for each, x in zip(hypothesis.parameters, fit.x, strict=False):
        close = AT_END * (each.high - each.low)
        below = x - each.low < close and each.wider[0] < each.low
        above = each.high - x < close and each.wider[1] > each.high
        if (below or above) and not each.angle and each.effect not in hypothesis.wider:
            ends.append(each.effect)
    return tuple(dict.fromkeys(ends))


def _followed(fit: Fit) -> Fit:
    """A fit continued with wider bounds of the effects at an end of their range."""
    hypothesis = fit.model.hypothesis
    wider = (*hypothesis.wider, *effects_at_range_end(fit))
    model = replace(fit.model, hypothesis=replace(hypothesis, wider=wider))
    return minimise(model, model.evaluate(fit.point))
