"""The workflow of a diagnosis: from measured tests to a verdict."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import cast

from wedgesweep.diagnose import score_test, verdict, work
from wedgesweep.diagnose.beyond_range import followed_beyond
from wedgesweep.diagnose.calibration import calibrate
from wedgesweep.diagnose.cross_validation import Gain, Predictor, cross_validate
from wedgesweep.diagnose.explanation import Explanation, best_of_each, penalised
from wedgesweep.diagnose.ladder import Level, ladder
from wedgesweep.diagnose.least_squares import from_other_nuisances, minimise, tight_refit
from wedgesweep.diagnose.loop.from_measurement import loop_data
from wedgesweep.diagnose.loop.loop_data import LoopData
from wedgesweep.diagnose.mixed.mixed_data import MixedData
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.next_test.offer import NextTest
from wedgesweep.diagnose.next_test.recommend import recommend
from wedgesweep.diagnose.pairs import component_fits, fit_pairs
from wedgesweep.diagnose.profile_likelihood import profile_likelihood
from wedgesweep.diagnose.renewal import Explained, with_renewed_covariance
from wedgesweep.diagnose.score_test import Score
from wedgesweep.diagnose.search import (
    PAIRS_SHARE,
    Search,
    base_fit,
    followed,
    from_shared_nuisances,
    from_special_cases,
    multistart,
    quiet,
    refit_base,
    refit_best,
    single_fits,
)
from wedgesweep.diagnose.steady.from_measurement import harmonic_data
from wedgesweep.diagnose.steady.harmonic_data import HarmonicData
from wedgesweep.diagnose.transient.from_measurement import transient_data
from wedgesweep.diagnose.transient.transient_data import TransientData
from wedgesweep.diagnose.verdict import Finding, Thresholds
from wedgesweep.diagnose.work import Untried
from wedgesweep.effects import EFFECTS, SCALES, acting
from wedgesweep.measured import Measurement
from wedgesweep.measured.declarations import LOOP, STEADY, TRANSIENT

# Explanations that a next test should separate where the verdict abstains.
COMPARED = 6
# Explanations are close if their penalised chi-squared is within so many times the gap of a tie of the best.
FOLLOWED_GAPS = 5.0
# Single effects are fitted again if a refit of the base model leaves less than this share of its chi-squared.
REFIT_BELOW = 0.9
Data = HarmonicData | LoopData | TransientData | MixedData
# How the tests of each kind become data of a fit.
DATA: dict[str, Callable[[Measurement], HarmonicData | LoopData | TransientData]] = {
    STEADY: harmonic_data,
    LOOP: loop_data,
    TRANSIENT: transient_data,
}


@dataclass(frozen=True)
class Diagnosis:
    """Everything that was found; ``explanations`` are sorted, the best first.

    ``scores``: of every candidate effect. ``gain``: on held-out tests, None without an explanation.
    ``ladder``: accuracy by number of effects. ``calibration``: None unless thresholds were calibrated.
    ``untried``: what the budget of the search left out; ``never_tried``: pairs of effects that were not
    fitted at all.
    """

    measurement: Measurement
    data: Data
    base: Explanation
    explanations: tuple[Explanation, ...]
    scores: tuple[Score, ...]
    finding: Finding
    gain: Gain | None
    next_test: NextTest | None
    thresholds: Thresholds
    ladder: tuple[Level, ...]
    calibration: dict[str, float | None] | None = None
    untried: tuple[Untried, ...] = ()
    never_tried: tuple[tuple[str, ...], ...] = ()

    @property
    def extended(self) -> Fit:
        """The best explanation's fit, or the base model's if the verdict is that nothing is missing."""
        best = self.finding.best
        return self.base.fit if best is None else best.fit


def diagnose(
    measurement: Measurement,
    effects: Sequence[str] = tuple(EFFECTS),
    threads: int = 1,
    progress: Callable[[str], None] = quiet,
    calibrated: bool = False,
) -> Diagnosis:
    """Name what the base model misses, or say why it cannot be named.

    Parameters
    ----------
    measurement : Measurement
        Tests of one rig, and the config of its base model.
    effects : sequence of str
        Candidates. Effects that the base model already has are skipped, unless they scale a parameter.
    threads : int
        Fits that run at the same time.
    progress : callable
        Called with each step.
    calibrated : bool
        Take the thresholds of the verdict from simulations of these very tests.

    Returns
    -------
    Diagnosis
        Verdict, fits, scores, gain on held-out tests and the recommended next test.
    """
    data = data_of(measurement)
    effects = _candidates(effects, measurement, progress)
    search, base, explanations, scans = explain(Search.of(data, effects, threads, progress))
    thresholds, calibration = verdict.thresholds_for(search.data), None
    finding = verdict.decide(base, explanations, thresholds)
    if calibrated:
        # What it simulates is not part of the search's budget.
        result = work.uncounted(
            lambda: calibrate(search, base, finding.best, lambda sample: explain(sample)[1:3], effects)
        ).result
        thresholds = verdict.thresholds_for(search.data, result.thresholds)
        calibration = result.as_dict()
        finding = verdict.decide(base, explanations, thresholds)
    finding, explanations = refit_cause(search, base, finding, explanations, thresholds)
    progress("scores")
    scores = score_test.scores(search, base.fit, scans)
    predict = Predictor(search.each)
    finding, gain = on_held_out_tests(search, base, finding, predict)
    progress("accuracy")
    levels = ladder(search, base, explanations, predict)
    progress("next test")
    next_test = recommend(_undecided(finding, explanations, thresholds))
    return Diagnosis(
        measurement=measurement,
        data=cast("Data", search.data),
        base=base,
        explanations=tuple(explanations),
        scores=tuple(scores),
        finding=finding,
        gain=gain,
        next_test=next_test,
        thresholds=thresholds,
        ladder=levels,
        calibration=calibration,
        untried=tuple(search.budget.untried),
        never_tried=search.budget.never_tried,
    )


def data_of(measurement: Measurement) -> Data:
    """The measured tests as data of a fit."""
    parts = [DATA[kind](measurement.of_kind(kind)) for kind in measurement.kinds]
    if len(parts) == 1:
        return parts[0]
    # Only steady tests have the gain of the input among the uncertain numbers; all parts have the same ones.
    uncertain = {name: std for part in parts for name, std in part.uncertain.items()}
    return MixedData.of([replace(part, uncertain=uncertain) for part in parts])


def of_each_kind(found: Diagnosis) -> dict[str, Diagnosis]:
    """The diagnosis restricted to the tests of each kind: their data, and both fits on them."""
    if not isinstance(found.data, MixedData):
        return {found.data.kind: found}
    base, extended = found.data.fits(found.base.fit), found.data.fits(found.extended)
    best = found.finding.best
    return {
        part.kind: replace(
            found,
            data=cast("Data", part),
            base=replace(found.base, fit=base[part.kind]),
            finding=replace(found.finding, best=best and replace(best, fit=extended[part.kind])),
        )
        for part in found.data.present
    }


def _candidates(
    effects: Sequence[str], measurement: Measurement, progress: Callable[[str], None]
) -> tuple[str, ...]:
    """Effects that the base model may lack."""
    possible = measurement.model.possible_effects
    effects = [name for name in effects if name in possible]
    in_base = acting(measurement.model.effects)
    contained = [name for name in effects if name in in_base and name not in SCALES]
    if contained:
        progress(f"already part of the base model, so no candidates: {', '.join(contained)}")
    return tuple(name for name in effects if name not in contained)


def refit_cause(
    search: Search, base: Explanation, finding: Finding, found: list[Explanation], thresholds: Thresholds
) -> tuple[Finding, list[Explanation]]:
    """The finding with its best explanation fitted tightly, and all explanations, best first.

    Rivals whose fits had not converged are followed further first, as the gap to them decides. If another
    explanation becomes the best one after the tight fit, it is fitted tightly as well.
    """
    if finding.best is not None:
        found = best_of_each([*_continued(search, found, thresholds), *found], penalised)
        finding = verdict.decide(base, found, thresholds)
    done: list[Explanation] = []
    while finding.best is not None and not any(finding.best is each for each in done):
        search.progress(f"final fit of {' + '.join(finding.best.effects)}")
        fit = tight_refit(from_other_nuisances(finding.best.fit))
        # Without a cause there is no interval to report.
        if finding.cause is not None or search.budget.left > 0.0:
            fit = profile_likelihood(fit, search.each)
        done.append(search.explanation(fit))
        found = [done[-1] if each is finding.best else each for each in found]
        found.sort(key=penalised)
        finding = verdict.decide(base, found, thresholds)
    return finding, found


def _continued(search: Search, found: Sequence[Explanation], thresholds: Thresholds) -> list[Explanation]:
    """The best explanation and those close to it, followed further where their fits had not converged."""
    limit = min(map(penalised, found)) + FOLLOWED_GAPS * thresholds.gap
    waiting = [each for each in found if penalised(each) < limit and not each.fit.converged]
    return search.each(
        lambda each: search.explanation(minimise(each.fit.model, each.fit.evaluation)), waiting
    )


def on_held_out_tests(
    search: Search, base: Explanation, finding: Finding, predict: Predictor
) -> tuple[Finding, Gain | None]:
    """The finding after cross-validation, and the gain on held-out tests; None without an explanation."""
    if finding.best is None or search.data.tests < 2:
        return finding, None
    search.progress("held-out tests")
    gain = cross_validate(base.fit, finding.best.fit, predict)
    finding = verdict.on_held_out_tests(finding, base, gain.excess_removed, gain.interval)
    return finding, gain if finding.best is not None else None


def explain(search: Search) -> Explained:
    """Fit the base model, every candidate, and pairs of candidates where no single one is adequate.

    Each stage may renew the search: its data (records aligned, covariance renewed) and its ranges.
    """
    search.progress("base model")
    search, base = base_fit(search)
    search, found, scans = single_fits(search, base.fit)
    sharing = search.data.shares_nuisances
    if sharing and verdict.none_adequate(found):
        found = followed(search, found)
    search, better = refit_base(search, base, found)
    # An adequate explanation hands its nuisance parameters on to the others, which need no better base then.
    handed_on = sharing and not verdict.none_adequate(found)
    if better.fit.chi2 < REFIT_BELOW * base.fit.chi2 and not handed_on:
        search, again, scans = single_fits(search, better.fit)
        found = best_of_each([*found, *again], penalised)
    found = from_shared_nuisances(search, from_special_cases(search, found))
    search, base, found, scans = with_renewed_covariance(Explained(search, better, found, scans))
    if verdict.none_adequate([base]):
        found = refit_best(search, found)
    if verdict.none_adequate([base, *found]):
        search, found = followed_beyond(search, base, found)
    if verdict.none_adequate([base, *found]) and search.data.tests >= verdict.FEWEST_TESTS:
        search.budget.grant(PAIRS_SHARE * search.budget.total)
        pairs = fit_pairs(search, base.fit, found, scans)
        found = found + pairs + component_fits(search, pairs)
        if verdict.none_adequate(found):
            search, found = followed_beyond(search, base, found)
        if verdict.none_adequate(found):
            found = found + multistart(search, scans)
        if sharing and verdict.none_adequate(found):
            found = refit_best(search, found)
    found = from_shared_nuisances(search, best_of_each(found, penalised))
    search, base = refit_base(search, base, found)
    return with_renewed_covariance(Explained(search, base, found, scans))


def _undecided(finding: Finding, explanations: Sequence[Explanation], thresholds: Thresholds) -> list[Fit]:
    """Fits that a next test should separate, at most COMPARED of them without a cause.

    These are a cause and its rivals. Without a cause they are the adequate explanations or, if fewer than two
    are adequate, the best ones.
    """
    if finding.cause is not None:
        return [finding.cause.fit, *(each.fit for each in finding.rivals)]
    if finding.verdict != verdict.INSUFFICIENT:
        return []
    adequate = finding.alternatives
    closest = adequate if len(adequate) > 1 else verdict.ranked(explanations, thresholds.gap)
    return [each.fit for each in closest[:COMPARED]]
