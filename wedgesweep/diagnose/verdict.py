"""From fits to one of six verdicts; a wrong name is the worst of them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import inf
from operator import itemgetter
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.special import chdtrc

from wedgesweep.diagnose.explanation import ADEQUATE, POSSIBLE, TOLERABLE, penalised
from wedgesweep.diagnose.fit_data import FitData
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnosis_result import VERDICTS, Reason
from wedgesweep.effects import confounded, parts
from wedgesweep.uncertain import uncertain_numbers

if TYPE_CHECKING:
    from wedgesweep.diagnose.ladder import Level, Rated

NOTHING, NAMED, CONSISTENT, TIED, INSUFFICIENT, NONE = VERDICTS
# Explanations whose penalised misfits differ by less than this cannot be distinguished.
GAP = 10.0
# The tests that hold this share of the base model's excess must be explained by themselves.
EXCESS_SHARE = 0.9
# Excess chi-squared of the base model that is needed to name a cause.
STRONG = 800.0
# With fewer tests no cause can be checked on a test that it was not fitted to.
FEWEST_TESTS = 3
# With this many rivals the tests show that something is wrong, but not what.
MOST_TIED = 4
# Factor by which model errors may be larger than is allowed for, where one component of a pair may be a model
# error.
LARGER = 2.0
# A parameter that is uncertain anyway is a cause only if it is off by this many standard deviations.
UNCERTAIN = 3.0
# Measured power over that of noise, below which noise is as large as the response.
LEAST_POWER = 2.0
# Where nothing reaches the noise: factor by which an explanation must be more accurate than all others to
# be a cause, the most that it may leave of the response, and effects that it may have. In 27 sets whose
# truth was no candidate the most accurate single effect led the next one by at most 1.9, and the most
# accurate pair by 1.3; right single effects lead by 2.7 to 80. The factor is the geometric mean of 1.9 and
# 2.7.
CLEAR, MOST_LEFT, MOST_NAMED = 2.3, 0.2, 2


@dataclass(frozen=True)
class Thresholds:
    """What a verdict depends on beside the fits; --calibrate replaces them by its own.

    ``strong``: see STRONG. ``least_gain``: what a cause must take off the penalised misfit.
    """

    strong: float = STRONG
    least_gain: float = 0.0


DEFAULT = Thresholds()


def thresholds_for(data: FitData, given: Thresholds = DEFAULT) -> Thresholds:
    """The given thresholds, with a least gain that fits the model error that is allowed.

    A model error of the allowed size may have the shape of any effect, unlike noise. A cause must remove more
    than all of them together could leave.
    """
    return replace(given, least_gain=max(given.least_gain, float(data.model_misfit.sum())))


@dataclass(frozen=True)
class Finding:
    """A verdict with its reason, the best explanation and its adequate rivals.

    ``numbers``: of the reason, by the keys of diagnosis.json. ``larger``: fits of explanations that hold the
    best one and leave much less, so that its numbers may be theirs.
    """

    verdict: str
    reason: Reason
    best: Fit | None = None
    rivals: tuple[Fit, ...] = ()
    numbers: Mapping[str, Any] = field(default_factory=dict)
    larger: tuple[Fit, ...] = ()

    @property
    def cause(self) -> Fit | None:
        """What is reported as the cause; None where the verdict abstains."""
        return self.best if self.verdict in (NAMED, CONSISTENT, TIED) else None

    @property
    def alternatives(self) -> tuple[Fit, ...]:
        """What the tests cannot tell from the cause or, without a cause, from one another."""
        best = self.best
        if self.verdict == INSUFFICIENT and best is not None and best.p_value >= POSSIBLE:
            return (best, *self.rivals)
        return self.rivals


def eligible(each: Fit) -> bool:
    """Whether a fit may be called a cause.

    An effect that is an uncertain parameter of the base model counts as one only if it is off by more than
    UNCERTAIN standard deviations, and a play only if it is larger than the smallest one that is searched.
    """
    if each.model.hypothesis.vanishes(each.x):
        return False
    off = deviations(each)
    return all(off[name] > UNCERTAIN for name in off)


def deviations(fit: Fit) -> dict[str, float]:
    """Standard deviations by which effects that are uncertain parameters of the base model are off."""
    data = fit.model.data
    declared = {name: std for name, std in data.uncertain.items() if name in fit.effects}
    stated = uncertain_numbers(declared, data.model.effects)
    moved = np.abs(stated.at(fit.model.values(fit.x)) - stated.mean) / stated.std
    off = dict.fromkeys(declared, 0.0)
    for number, size in zip(stated.numbers, moved.tolist(), strict=True):
        off[number.effect] = max(off[number.effect], size)
    return off


def tolerable(base: Fit) -> bool:
    """Whether nothing need be missing: a small misfit, with uncertain parameters about as stated."""
    return base.p >= TOLERABLE and not base.implausible


def none_adequate(found: Sequence[Fit]) -> bool:
    """Whether there are explanations, and not even the best of them is adequate."""
    best = min(found, key=penalised, default=None)
    return best is not None and best.p_value < ADEQUATE


def ranked(explanations: Sequence[Fit]) -> list[Fit]:
    """Eligible explanations, best first, without those that beat a part of them by less than GAP."""
    allowed = sorted(filter(eligible, explanations), key=penalised)
    return [
        each
        for each in allowed
        if not any(_is_part(other, each) and each.penalised >= other.penalised - GAP for other in allowed)
    ]


def _is_part(one: Fit, other: Fit) -> bool:
    """Whether one explanation is the other without some effects, or with a special case of one of them."""
    return set(one.effects) < set(other.effects) or parts(one.effects) < parts(other.effects)


def decide(base: Fit, explanations: Sequence[Fit], thresholds: Thresholds) -> Finding:
    """Decide between the base model and everything that was fitted.

    Parameters
    ----------
    base : Fit
        The fitted base model.
    explanations : sequence of Fit
        Fits of single effects and of pairs, in any order.
    thresholds : Thresholds
        The default ones, or those of a calibration.
    """
    order = ranked(explanations)
    better = [each for each in order if each.penalised < base.penalised - thresholds.least_gain]
    if not better:
        return _nothing_better(base, order)
    best = next(filter(_possible, better), None)
    if best is None:
        return _unexplained(base, order[0])
    return _weigh(base, best, order, thresholds)


def _possible(each: Fit) -> bool:
    """Whether an explanation is possible; one that meets the model error that is allowed is."""
    data = each.model.data
    return (each.p if data.model_error else each.p_value) >= POSSIBLE


def _nothing_better(base: Fit, order: Sequence[Fit]) -> Finding:
    """The finding where no explanation removes as much misfit as a cause must."""
    if tolerable(base):
        return _nothing_missing(base)
    if base.p >= TOLERABLE:
        return _with_numbers_as_stated(base, order)
    if order and order[0].p_value >= ADEQUATE:
        return Finding(INSUFFICIENT, Reason.NEARLY_TOLERABLE, order[0])
    return _unexplained(base, order[0] if order else None)


def _nothing_missing(base: Fit) -> Finding:
    """The finding on a tolerable base model: nothing is missing, if there is a response to explain."""
    data = base.model.data
    share = float(data.power.sum() / data.observations.sum())
    if share < LEAST_POWER:
        return Finding(INSUFFICIENT, Reason.NO_SIGNAL, numbers={"power_over_noise": share})
    return Finding(NOTHING, Reason.ONLY_NOISE)


def _weigh(base: Fit, best: Fit, order: Sequence[Fit], thresholds: Thresholds) -> Finding:
    """The finding on the best possible explanation, by its fit, its rivals and the evidence for it."""
    p, against, numbers = _against(base, best)
    met = best.model.data.model_error and best.p >= ADEQUATE
    # With a weak excess, noise decides in part which tests hold most of it: then p says less.
    if p < POSSIBLE and base.excess >= STRONG and not met:
        return Finding(_abstention(base), against, best, (), numbers)
    near = [each for each in order if each.penalised - best.penalised < GAP and each is not best]
    rivals = tuple(filter(_possible, near))
    alternatives = _adequate_alternatives(order, best)
    if len(best.effects) > 1 and len(alternatives) >= MOST_TIED:
        return Finding(INSUFFICIENT, Reason.OTHERS_ADEQUATE, best, alternatives)
    if len(rivals) >= MOST_TIED:
        return Finding(INSUFFICIENT, Reason.EQUALLY_GOOD, best, rivals)
    if base.model.data.tests < FEWEST_TESTS:
        return Finding(INSUFFICIENT, Reason.FEW_TESTS, best, rivals)
    if rivals:
        return Finding(TIED, Reason.EQUALLY_GOOD, best, rivals)
    if confounded(best.effects):
        return Finding(INSUFFICIENT, Reason.CONFOUNDED, best, alternatives)
    if component := _sufficient_component(order, best):
        effects = list(component.effects)
        return Finding(INSUFFICIENT, Reason.COMPONENT_SUFFICES, best, alternatives, {"effects": effects})
    if nearly := _nearly_sufficient_component(order, best):
        larger = {"model_error": LARGER * best.model.data.model_error}
        return Finding(CONSISTENT, Reason.PAIR_LEAVES_LESS, nearly, (best, *alternatives), larger)
    if base.excess < thresholds.strong:
        return _weak(base, best)
    if p < ADEQUATE:
        return Finding(CONSISTENT, against, best, (), numbers)
    if alternatives:
        return Finding(CONSISTENT, Reason.OTHERS_ADEQUATE, best, alternatives)
    return Finding(NAMED, Reason.ALONE, best)


def _weak(base: Fit, best: Fit) -> Finding:
    """The finding on a small excess, which a base model may have made small by a number far from stated."""
    effect, *others = best.effects
    if effect in base.implausible and not (others or best.implausible):
        off = {"effect": effect, "standard_deviations": deviations(best)[effect]}
        return Finding(CONSISTENT, Reason.AT_LIMIT, best, (), off)
    return Finding(CONSISTENT, Reason.WEAK_EXCESS, best, (), {"excess": base.excess})


def _with_numbers_as_stated(base: Fit, order: Sequence[Fit]) -> Finding:
    """The finding where the base model fits, but only with uncertain parameters far from stated.

    Explanations are adequate here that leave these parameters about as stated.
    """
    found = [each for each in order if each.p >= ADEQUATE and not each.implausible][:MOST_TIED]
    if not found:
        return _unexplained(base, order[0] if order else None)
    return Finding(INSUFFICIENT, Reason.NEARLY_TOLERABLE, found[0], tuple(found[1:]))


def _sufficient_component(order: Sequence[Fit], best: Fit) -> Fit | None:
    """A component of a pair that fits by itself, but with parameters that differ from test to test.

    The other component hardly shows then, and many others would do as well.
    """
    components = (each for each in order if set(each.effects) < set(best.effects))
    return next((each for each in components if each.p >= ADEQUATE > each.p_value), None)


def _nearly_sufficient_component(order: Sequence[Fit], best: Fit) -> Fit | None:
    """The component of a pair that would do by itself if model errors were a little larger than allowed.

    How large they are is a guess, and the other component may be one of them.
    """
    if best.model.data.model_error == 0.0:
        return None
    components = [each for each in order if set(each.effects) < set(best.effects)]
    nearly = (each for each in components if _p_under_larger_errors(each) >= ADEQUATE)
    return next((each for each in nearly if not each.implausible), None)


def _p_under_larger_errors(fit: Fit) -> float:
    data = fit.model.data.with_model_error(LARGER * fit.model.data.model_error)
    return float(chdtrc(fit.dof, data.compared_again(fit.evaluation).chi2))


def _adequate_alternatives(order: Sequence[Fit], best: Fit) -> tuple[Fit, ...]:
    """Other explanations with an adequate misfit.

    Parts of the best one, and those that it is a part of, do not count.
    """
    others = [each for each in order if not (each is best or _is_part(each, best) or _is_part(best, each))]
    return tuple(each for each in others if each.p >= ADEQUATE)


def _against(base: Fit, best: Fit) -> tuple[float, Reason, Mapping[str, Any]]:
    """The strongest evidence against an explanation: its p-value, the reason, and the numbers of that.

    The smallest p-value over all tests, over those that hold most of the excess, and of constancy.
    """
    shows = p_where_it_shows(base, best)
    found: list[tuple[float, Reason, Mapping[str, Any]]] = [
        (best.p, Reason.UNEXPLAINED, {}),
        (shows, Reason.LEAVES_MORE, {"p": shows}),
    ]
    if best.p >= POSSIBLE:
        p, parameter = best.constancy
        found.append((p, Reason.VARIES, {"p": p, "parameter": parameter}))
    return min(found, key=itemgetter(0))


def p_where_it_shows(base: Fit, fit: Fit) -> float:
    """The p-value of a fit over the tests that hold most of the base model's excess.

    Other tests, with less noise than expected, cannot make up for a misfit there. Where model errors are
    allowed for, let M be the misfit that they leave in a test on average. As an error has one shape in each
    test, that part of chi-squared has one degree of freedom and the variance 2 M^2; the rest has the variance
    of noise. The sum is compared with the scaled chi-squared of its mean and variance (Satterthwaite, 1946).
    """
    dof = fit.model.data.dof
    excess = np.maximum(base.evaluation.chi2_by_test - dof, 0.0)
    order = np.argsort(-excess)
    most = int(np.searchsorted(np.cumsum(excess[order]), EXCESS_SHARE * excess.sum()))
    rows = order[: most + 1]
    mean = max(float(dof[rows].sum()) - fit.model.size, 1.0)
    by_errors = fit.model.data.model_misfit[rows]
    variance = 2.0 * max(mean - by_errors.sum(), 0.0) + 2.0 * (by_errors**2).sum()
    scale = variance / (2.0 * mean)
    return float(chdtrc(mean / scale, fit.evaluation.chi2_by_test[rows].sum() / scale))


def on_held_out_tests(
    finding: Finding, base: Fit, removed: float, interval: Sequence[float] | None
) -> Finding:
    """The finding, weakened if its cause may make predictions of held-out tests worse.

    Where the base model is tolerable, nothing is missing then. Otherwise a cause that leaves more than noise
    is dropped, and what was named or tied becomes weak evidence.

    Parameters
    ----------
    finding : Finding
        The verdict of ``decide``.
    base : Fit
        The fitted base model.
    removed : float
        Share of the excess on held-out tests that the cause removes.
    interval : sequence of float or None
        Its 95 % interval; None for too few tests, where a negative gain only turns a name into weak evidence.
    """
    # The base model of a number at its limit has moved that number, too.
    cause = None if finding.reason is Reason.AT_LIMIT else finding.cause
    if cause is None or (removed if interval is None else interval[0]) >= 0.0:
        return finding
    doubted = replace(finding, reason=Reason.UNCONFIRMED, numbers={})
    if interval is None:
        return replace(doubted, verdict=CONSISTENT) if finding.verdict == NAMED else finding
    if tolerable(base):
        return _nothing_missing(base)
    rival_adequate = any(each.p_value >= ADEQUATE for each in finding.rivals)
    if _against(base, cause)[0] < ADEQUATE and not rival_adequate:
        return replace(doubted, verdict=_abstention(base))
    return replace(doubted, verdict=CONSISTENT if finding.verdict == NAMED else INSUFFICIENT)


def as_far_as_done(finding: Finding, tried: bool, searched: bool, confirmed: bool) -> Finding:
    """The finding of a diagnosis that may have ended early.

    ``tried``: whether all single effects were; ``searched``: whether all rivals were; ``confirmed``: whether
    held-out tests were predicted.
    """
    if finding.verdict == NAMED and not (searched and confirmed):
        return replace(finding, verdict=CONSISTENT, reason=Reason.UNCHECKED, numbers={})
    if finding.verdict == NONE and not searched:
        return replace(finding, verdict=INSUFFICIENT, reason=Reason.UNCHECKED, numbers={})
    if finding.verdict == NOTHING and not tried:  # the noise is that of the records by themselves
        return replace(finding, verdict=INSUFFICIENT, reason=Reason.UNSEARCHED, numbers={})
    return finding


def by_accuracy(finding: Finding, levels: "Sequence[Level]") -> Finding:
    """The finding where no explanation reaches the noise, but one is by far the most accurate of its size.

    It has one effect, or two where no single one leads. It must be more accurate than the base model and all
    others with as many effects, or fewer, by the factor CLEAR, and beat the base model on held-out tests by
    that factor as well. Two that share an effect and each lead all others are tied with each other, and with
    larger ones without them that are more accurate by less than that factor: they may be the same physics in
    another form. By more, only one with either may be, if nothing else leads: then it is a part of what is
    missing, and its numbers are as uncertain as the rest.
    """
    if finding.verdict != NONE:
        return finding
    leading = {size: _leading(levels, size) for size in range(1, min(len(levels), MOST_NAMED + 1))}
    beside = {size: _beside(levels, size, found) for size, found in leading.items() if found}
    sizes = [
        size
        for size, (rivals, larger) in beside.items()
        if len(rivals) < MOST_TIED and all(_holds(each, leading[size]) for each in larger)
    ]
    if not sizes:
        return finding
    size = min(sizes, key=lambda size: (bool(beside[size][1]), size))
    best, (rivals, larger) = leading[size][0], beside[size]
    least = min((each.accuracy for each in larger), default=0.0)
    close = [each for each in larger if each.accuracy <= CLEAR * least]
    numbers: dict[str, Any] = {"accuracy": best.accuracy, "base": levels[0].best.accuracy}
    numbers |= {"next_best": _next_best(levels, size, leading[size]), "held_out": best.held_out}
    numbers |= {"rivals": _accuracies(rivals), "larger": _accuracies(close)}
    if best.explanation.p >= ADEQUATE:
        numbers["parameter"] = best.explanation.constancy.parameter
    tied, fits = tuple(each.explanation for each in rivals), tuple(each.fit for each in close)
    return Finding(TIED if tied else CONSISTENT, Reason.MORE_ACCURATE, best.explanation, tied, numbers, fits)


def _accuracies(rated: "Sequence[Rated]") -> list[dict[str, Any]]:
    return [{"effects": [*each.effects], "accuracy": each.accuracy} for each in rated]


def _next_best(levels: "Sequence[Level]", size: int, leading: "Sequence[Rated]") -> float:
    """The best accuracy but for that of the leading explanations, of those of some size or smaller."""
    others = (each for level in levels[1 : size + 1] for each in level.rated if each not in leading)
    return min((each.accuracy for each in others), default=inf)


def _leading(levels: "Sequence[Level]", size: int) -> "Sequence[Rated]":
    """The explanation of some size that leads, two that share an effect and lead the rest, or none."""
    first, *rest = levels[size].rated
    second = [each for each in rest[:1] if set(each.effects) & set(first.effects)]
    for found in ([first], [first, *second]):
        if _clearly_ahead(levels, size, found):
            return found
    return ()


def _clearly_ahead(levels: "Sequence[Level]", size: int, leading: "Sequence[Rated]") -> bool:
    """Whether explanations are by far more accurate than all others with as many effects, or fewer."""
    (best, *_), base, worst = leading, levels[0].best, max(each.accuracy for each in leading)
    # One that reaches the noise over all tests was refused for what it leaves in some of them.
    if best.accuracy == 0.0 or any(confounded(each.effects) for each in leading):
        return False
    # A base model that has no response predicts nothing.
    predicted, before = (inf if each.held_out is None else each.held_out for each in (best, base))
    return (
        CLEAR * worst <= min(base.accuracy, _next_best(levels, size, leading), CLEAR * MOST_LEFT)
        and predicted < inf
        and CLEAR * predicted <= before
    )


def _beside(
    levels: "Sequence[Level]", size: int, leading: "Sequence[Rated]"
) -> "tuple[list[Rated], list[Rated]]":
    """What is tied with the best of the leading explanations, and larger ones that are far more accurate.

    Larger ones that hold a leading one, and gain less than CLEAR by another number, are neither.
    """
    best, *tied = leading
    more = [each for level in levels[size + 1 :] for each in level.rated if each.accuracy < best.accuracy]
    larger = [each for each in more if CLEAR * each.accuracy < best.accuracy]
    return [*tied, *(each for each in more if each not in larger and not _holds(each, leading))], larger


def _holds(larger: "Rated", leading: "Sequence[Rated]") -> bool:
    """Whether one of the leading explanations is an explanation without some effects, or a special case."""
    return any(parts(each.effects) <= parts(larger.effects) for each in leading)


def _unexplained(base: Fit, best: Fit | None) -> Finding:
    """The finding where nothing explains the misfit."""
    if base.model.data.tests < FEWEST_TESTS:
        return Finding(INSUFFICIENT, Reason.FEW_TESTS, best)
    return Finding(NONE, Reason.UNEXPLAINED, best)


def _abstention(base: Fit) -> str:
    return NONE if base.model.data.tests >= FEWEST_TESTS else INSUFFICIENT
