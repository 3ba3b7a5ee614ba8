"""From fits to one of six answers; a wrong name is the worst of them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import chdtrc

from wedgesweep.diagnose.search import POSSIBLE, Explanation, penalised
from wedgesweep.diagnose.steady.model import Fit
from wedgesweep.effects import confounded

NOTHING, NAMED, CONSISTENT, TIED, INSUFFICIENT, NONE = (
    "nothing-missing",
    "named",
    "consistent-with",
    "tied",
    "data-insufficient",
    "none-of-mine",
)
# Penalised misfits closer than this cannot be told apart.
GAP = 10.0
# Least probability of what an explanation leaves to be named; POSSIBLE is that to be one at all.
ADEQUATE = 0.01
# And of that which the base model leaves.
TOLERABLE = 1e-4
# Share of the base model's excess whose tests a cause must explain for themselves.
EXCESS_SHARE = 0.9
# Excess chi-squared of the base model that it takes to name a cause.
STRONG = 800.0
# With fewer tests no cause can be checked on a test that it was not fitted to.
FEWEST_TESTS = 3
# With this many rivals the tests show that something is wrong, but not what.
MOST_TIED = 4
# An uncertain number is a cause only if it is this many of its standard deviations off.
UNCERTAIN = 3.0


@dataclass(frozen=True)
class Thresholds:
    """What a verdict depends on beside the fits; --calibrate puts its own in place of these.

    ``least_gain``: penalised misfit that a cause must take away at the least.
    """

    gap: float = GAP
    strong: float = STRONG
    least_gain: float = 0.0


DEFAULT = Thresholds()


@dataclass(frozen=True)
class Finding:
    """A verdict with the best explanation, and those that will do as well, or that leave noise only, too."""

    verdict: str
    best: Explanation | None
    rivals: tuple[Explanation, ...]

    @property
    def cause(self) -> Explanation | None:
        """What is reported as the cause; None where the verdict abstains."""
        return self.best if self.verdict in (NAMED, CONSISTENT, TIED) else None

    @property
    def alternatives(self) -> tuple[Explanation, ...]:
        """What the tests cannot tell from the cause or, where they cannot show one, from one another."""
        best = self.best
        if self.verdict == INSUFFICIENT and best is not None and best.p_value >= POSSIBLE:
            return (best, *self.rivals)
        return self.rivals


def eligible(each: Explanation) -> bool:
    """Whether a fit may be called a cause: an uncertain number must have moved beyond its spread."""
    data = each.fit.model.data
    return all(
        abs(numbers["scale"] - 1.0) > UNCERTAIN * data.uncertain[name]
        for name, numbers in each.fit.values.items()
        if name in data.uncertain
    )


def none_adequate(found: Sequence[Explanation]) -> bool:
    """Whether even the best of explanations, if there is any, will not do."""
    best = min(found, key=penalised, default=None)
    return best is not None and best.p_value < ADEQUATE


def ranked(explanations: Sequence[Explanation], gap: float = GAP) -> list[Explanation]:
    """Explanations best first; a pair that hardly beats one of its own effects is left out."""
    allowed = sorted(filter(eligible, explanations), key=penalised)
    alone = {each.effects[0]: each.penalised for each in allowed if len(each.effects) == 1}
    return [
        each
        for each in allowed
        if len(each.effects) == 1
        or each.penalised < min(alone.get(effect, float("inf")) for effect in each.effects) - gap
    ]


def decide(base: Explanation, explanations: Sequence[Explanation], thresholds: Thresholds) -> Finding:
    """Weigh the base model against everything that was fitted."""
    order = ranked(explanations, thresholds.gap)
    better = [each for each in order if each.penalised < base.penalised - thresholds.least_gain]
    if not better:
        if base.fit.p >= TOLERABLE:
            return Finding(NOTHING, None, ())
        will_do = bool(order) and order[0].p_value >= ADEQUATE
        return Finding(INSUFFICIENT if will_do else _unexplained(base), order[0] if order else None, ())
    best = next((each for each in better if each.p_value >= POSSIBLE), None)
    if best is None:
        return Finding(_unexplained(base), order[0], ())
    left = _left(base, best)
    # Where little shows, noise has a part in where: those tests hold more of it than others.
    if left < POSSIBLE and base.fit.excess >= STRONG:
        return Finding(_unexplained(base), best, ())
    near = [each for each in order if each.penalised - best.penalised < thresholds.gap and each is not best]
    rivals = tuple(each for each in near if each.p_value >= POSSIBLE)
    others = _adequate_alternatives(order, best)
    if len(best.effects) > 1 and len(others) >= MOST_TIED:
        return Finding(INSUFFICIENT, best, others)
    if len(rivals) >= MOST_TIED or base.fit.model.data.tests < FEWEST_TESTS:
        return Finding(INSUFFICIENT, best, rivals)
    if rivals:
        return Finding(TIED, best, rivals)
    if confounded(best.effects) or _component_suffices(order, best):
        return Finding(INSUFFICIENT, best, others)
    if base.fit.excess < thresholds.strong or left < ADEQUATE:
        return Finding(CONSISTENT, best, ())
    return Finding(CONSISTENT if others else NAMED, best, others)


def _component_suffices(order: Sequence[Explanation], best: Explanation) -> bool:
    """Whether one effect of a pair alone leaves noise only, but with numbers that differ from test to test.

    What is beside it hardly shows then, and many will do for that.
    """
    component_fits = [each for each in order if set(each.effects) < set(best.effects)]
    return any(each.fit.p >= ADEQUATE > each.p_value for each in component_fits)


def _adequate_alternatives(order: Sequence[Explanation], best: Explanation) -> tuple[Explanation, ...]:
    """Explanations that leave noise only, too: what others can imitate may be none of them.

    What is part of the best one, or more than it, is no other.
    """
    mine = set(best.effects)
    beside = [each for each in order if not (mine <= set(each.effects) or set(each.effects) <= mine)]
    return tuple(each for each in beside if each.fit.p >= ADEQUATE)


def _left(base: Explanation, best: Explanation) -> float:
    """Probability of what an explanation leaves, over all tests or where there was more: the smaller one."""
    return min(best.p_value, where_it_shows(base.fit, best.fit))


def where_it_shows(base: Fit, fit: Fit) -> float:
    """Probability of what a fit leaves in the tests that hold most of the base model's excess.

    Tests in which nothing shows cannot make up for it there with less noise than they should have.
    """
    dof = fit.model.data.dof
    excess = np.maximum(base.evaluation.chi2_by_test - dof, 0.0)
    order = np.argsort(-excess)
    most = int(np.searchsorted(np.cumsum(excess[order]), EXCESS_SHARE * excess.sum()))
    rows = order[: most + 1]
    return float(chdtrc(max(dof[rows].sum() - fit.model.size, 1), fit.evaluation.chi2_by_test[rows].sum()))


def on_unseen_tests(
    finding: Finding, base: Explanation, removed: float, interval: Sequence[float] | None
) -> Finding:
    """The finding, unless its cause may well make worse what it was not fitted to.

    Then nothing is missing where the base model will do. Else none is the cause; or if it leaves noise only,
    too few tests show it for others to confirm it: what would be named is weak evidence, else none.
    ``removed``: share of the excess that the cause removes there, and its 95 % interval; where the tests are
    too few for one they can only make a name weak evidence.
    """
    if finding.cause is None or (removed if interval is None else interval[0]) >= 0.0:
        return finding
    if interval is None:
        return Finding(CONSISTENT, finding.best, finding.rivals) if finding.verdict == NAMED else finding
    if base.fit.p >= TOLERABLE:
        return Finding(NOTHING, None, ())
    rival_will_do = any(each.p_value >= ADEQUATE for each in finding.rivals)
    if _left(base, finding.cause) < ADEQUATE and not rival_will_do:
        return Finding(_unexplained(base), finding.best, finding.rivals)
    return Finding(CONSISTENT if finding.verdict == NAMED else INSUFFICIENT, finding.best, finding.rivals)


def _unexplained(base: Explanation) -> str:
    return NONE if base.fit.model.data.tests >= FEWEST_TESTS else INSUFFICIENT
