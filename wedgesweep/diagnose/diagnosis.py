"""The workflow of a diagnosis: from measured tests to a verdict."""

import logging
import traceback
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace

from wedgesweep.config import Config
from wedgesweep.diagnose import score_test, verdict, work
from wedgesweep.diagnose.calibration import calibrate
from wedgesweep.diagnose.concatenation import joined
from wedgesweep.diagnose.cross_validation import Gain, Predictor, cross_validate, widened
from wedgesweep.diagnose.empirical.stage import EmpiricalForce, empirical_force
from wedgesweep.diagnose.explanation import best_of_each, penalised
from wedgesweep.diagnose.fit_data import FitData
from wedgesweep.diagnose.ladder import (
    FORWARD,
    RECORD_BY_RECORD,
    REFINED,
    ByRecord,
    Level,
    forward_selection,
    ladder,
    record_by_record,
    rough_ladder,
)
from wedgesweep.diagnose.least_squares import minimise, tight_refit
from wedgesweep.diagnose.loop.loop_data import loop_data
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.next_test.recommend import NextTest, recommend
from wedgesweep.diagnose.profile_likelihood import profile_likelihood
from wedgesweep.diagnose.repeats import Spread, spread_of
from wedgesweep.diagnose.score_test import Score
from wedgesweep.diagnose.search import LEADING, Explained, Search, base_fit, quiet, single_fits
from wedgesweep.diagnose.stages import PAIRS, REFINEMENT, taken
from wedgesweep.diagnose.steady.from_measurement import harmonic_data
from wedgesweep.diagnose.transient.from_measurement import transient_data
from wedgesweep.diagnose.verdict import Finding, Thresholds
from wedgesweep.diagnose.work import Best, Change, Untried
from wedgesweep.effects import EFFECTS, SCALES, acting, candidates
from wedgesweep.effects.base import OSCILLATOR
from wedgesweep.effects.empirical_force import NAME as FORCE
from wedgesweep.measured import Measurement
from wedgesweep.measured.declarations import LOOP, NORMAL_FORCE, STEADY, TRANSIENT

log = logging.getLogger(__name__)
# Verdicts that name no cause; further effects and an empirical force are tried after them.
ABSTAINING = (verdict.NONE, verdict.INSUFFICIENT)
# How the tests of each kind become data of a fit.
DATA: dict[str, Callable[[Measurement], FitData]] = {
    STEADY: harmonic_data,
    LOOP: loop_data,
    TRANSIENT: transient_data,
}


# Why a step has no result while the diagnosis goes on, or after it was killed.
NOT_REACHED = "not reached"


@dataclass(frozen=True)
class Diagnosis:
    """Everything that was found so far; ``explanations`` are sorted, the best first.

    ``scores``: of every candidate effect. ``gain``: on held-out tests, None without an explanation.
    ``ladder``: accuracy by number of effects. ``calibration``: None unless thresholds were calibrated.
    ``untried``: what the search left out; ``never_tried``: pairs of effects that were not
    fitted at all. ``unfinished``: steps without a result, with the reason; ``failed``: effects whose fits
    raised an error; ``ended``: the interrupt or time limit that ended the diagnosis early. ``changes``: what
    each stage changed; ``without``: stages that were left out; ``empirical``: the force that is missing where
    no name explains it; ``by_record``: effects whose numbers differ from record to record. ``spread``: that
    between repeats of a test, which counts as an error that a model may have.
    """

    measurement: Measurement
    data: FitData
    base: Fit
    decided: Finding
    thresholds: Thresholds
    explanations: tuple[Fit, ...] = ()
    scores: tuple[Score, ...] = ()
    gain: Gain | None = None
    next_test: NextTest | None = None
    ladder: tuple[Level, ...] = ()
    calibration: dict[str, float | None] | None = None
    untried: tuple[Untried, ...] = ()
    never_tried: tuple[tuple[str, ...], ...] = ()
    unfinished: Mapping[str, str] = field(default_factory=dict)
    failed: Mapping[str, str] = field(default_factory=dict)
    ended: KeyboardInterrupt | None = None
    changes: tuple[Change, ...] = ()
    without: tuple[str, ...] = ()
    empirical: EmpiricalForce | None = None
    by_record: tuple[ByRecord, ...] = ()
    spread: Spread | None = None

    @property
    def best(self) -> Best:
        """The explanation that the verdict is about, else the base model."""
        decided = self.decided.best or self.base
        return Best(decided.effects, decided.penalised)

    @property
    def finding(self) -> Finding:
        """The verdict, which claims no more than the steps that were done allow."""
        done = [step not in self.unfinished for step in ("single effects", "pairs", "held-out tests")]
        return verdict.as_far_as_done(self.decided, done[0], all(done[:2]), done[2])

    @property
    def extended(self) -> Fit:
        """The best explanation's fit, or the base model's if the verdict is that nothing is missing."""
        return self.finding.best or self.base


# Called with everything that is known whenever a step has ended.
Reached = Callable[[Diagnosis], None]


class Course:
    """A diagnosis on its way from step to step; ``found`` is what is known so far."""

    def __init__(
        self, measurement: Measurement, explained: Explained, steps: Sequence[str], reached: Reached
    ) -> None:
        self.explained, self._reached, self.empirical_force = explained, reached, False
        self.predict = Predictor(explained.search.each)
        data, base = explained.search.data, explained.base
        thresholds = verdict.thresholds_for(data)
        decided = verdict.decide(base, [], thresholds)
        unfinished = dict.fromkeys(steps, NOT_REACHED)
        left_out = tuple(sorted(explained.search.without))
        self.found = Diagnosis(
            measurement, data, base, decided, thresholds, unfinished=unfinished, without=left_out
        )
        self.found = self.explained_by(explained)

    @property
    def search(self) -> Search:
        return self.explained.search

    def take(self, step: str, function: Callable[["Course"], Diagnosis]) -> None:
        """Take a step, which returns what is known after it; one that fails leaves its place empty."""
        self.search.progress(step)
        unfinished, untried = dict(self.found.unfinished), self.search.budget.untried
        already = len(untried)
        try:
            self.found = self.search.tried(step, self.found, lambda _: function(self))
            if any(each.ended_by == work.TIME_LIMIT for each in untried[already:]):
                unfinished[step] = work.TIME_LIMIT
            else:
                del unfinished[step]
        except Exception as error:  # no step may take the results of the others with it
            log.debug(traceback.format_exc())
            self.search.progress(f"{step}: failed ({_described(error)}); the diagnosis goes on without")
            self._take_finished()
            unfinished[step] = _described(error)
        changes = tuple(self.search.budget.changes)
        self.found = replace(self.found, unfinished=unfinished, changes=changes)
        self._reached(self.found)

    def end(self, interrupt: KeyboardInterrupt) -> Diagnosis:
        """What is known where an interrupt or the time limit ends the diagnosis."""
        self._take_finished()
        reason = work.TIME_LIMIT if isinstance(interrupt, work.OutOfTime) else "interrupted"
        unfinished = {
            step: reason if why == NOT_REACHED else why for step, why in self.found.unfinished.items()
        }
        return replace(self.found, unfinished=unfinished, ended=interrupt)

    def _take_finished(self) -> None:
        """Take over what a stage of the search has fitted before it was cut off."""
        finished = [each for each in self.search.finished if each.model.data is self.search.data]
        if finished:
            with suppress(Exception):  # what made the stage fail may fail here as well
                self.found = self.explained_by(self.explained.joined(finished))

    def explained_by(self, explained: Explained) -> Diagnosis:
        """The diagnosis by the explanations of a search, rated where their fits ended."""
        search, base, explanations, _ = self.explained = explained
        search.finished.clear()
        return replace(
            self.found,
            data=search.data,
            base=base,
            explanations=tuple(explanations),
            decided=verdict.decide(base, explanations, self.found.thresholds),
            ladder=rough_ladder(search, base, explanations),
            untried=tuple(search.budget.untried),
            never_tried=search.budget.never_tried,
            failed={effect: _described(error) for effect, error in search.failed.items()},
        )


def _described(error: Exception) -> str:
    return ": ".join(filter(None, (type(error).__name__, str(error))))


def diagnose(
    measurement: Measurement,
    effects: Sequence[str] | None = None,
    threads: int = 1,
    progress: Callable[[str], None] = quiet,
    calibrated: bool = False,
    *,
    reached: Reached = lambda found: None,
    time_used: Callable[[], float] = work.unlimited,
) -> Diagnosis:
    """Name what the base model misses, or say why it cannot be named.

    Parameters
    ----------
    measurement : Measurement
        Tests of one rig, and the config of its base model.
    effects : sequence of str
        Candidates, by default all. Effects that the base model already has are skipped, unless they scale a
        parameter. "empirical_force" among them: fit one whatever the verdict is.
    threads : int
        Fits that run at the same time.
    progress : callable
        Called with each step.
    calibrated : bool
        Take the thresholds of the verdict from simulations of these very tests.
    reached : callable
        Called with everything that is known whenever a step has ended.
    time_used : callable
        Returns the share of a time limit that is used up; the fits end at 1. The base model is always fitted.

    Returns
    -------
    Diagnosis
        Verdict, fits, scores, gain on held-out tests and the recommended next test. After an interrupt or the
        time limit, what was known by then.

    Raises
    ------
    KeyboardInterrupt
        Before the base model is fitted.
    """
    force_wanted = effects is not None and FORCE in effects
    effects = _candidates(candidates() if effects is None else effects, measurement, progress)
    spread = spread_of(measurement)
    allowed = measurement if spread is None else spread.allowed_in(measurement)
    explained = base_fit(Search.of(data_of(allowed), effects, threads, progress))
    left_out = {*explained.search.without, *(() if calibrated else ("calibration",))}
    steps = {name: step for name, step in STEPS.items() if name not in left_out}
    course = Course(measurement, explained, tuple(steps), reached)
    course.empirical_force = force_wanted
    course.found = replace(course.found, spread=spread)
    try:
        reached(course.found)
        with work.limited(time_used):
            for name, step in steps.items():
                course.take(name, step)
    except KeyboardInterrupt as interrupt:
        return course.end(interrupt)
    return course.found


def _calibrated(course: Course) -> Diagnosis:
    """The diagnosis with thresholds from simulations of its tests, which are not part of the budget."""
    found, search = course.found, course.search
    result = work.uncounted(lambda: calibrate(search, found.base, found.decided.best)).result
    thresholds = verdict.thresholds_for(search.data, result.thresholds)
    decided = verdict.decide(found.base, found.explanations, thresholds)
    return replace(found, decided=decided, thresholds=thresholds, calibration=result.as_dict())


def _with_intervals(course: Course) -> Diagnosis:
    found = course.found
    known = list(found.explanations)
    decided, known = refit_cause(course.search, found.base, found.decided, known, found.thresholds)
    return replace(found, decided=decided, explanations=tuple(known))


def _held_out(course: Course) -> Diagnosis:
    """The diagnosis with the gain on held-out tests, if there is anything to gain, and tests to hold out."""
    found = course.found
    base, decided = found.base, found.decided
    if decided.best is None or found.data.tests < 2:
        return found
    gain = cross_validate(base, decided.best, course.predict)
    decided = verdict.on_held_out_tests(decided, base, gain.excess_removed, gain.interval)
    return replace(found, decided=decided, gain=None if decided.best is None else gain)


def _rated(course: Course) -> Diagnosis:
    """The diagnosis with the refined ladder, and with what is by far the most accurate, if anything is."""
    found, search = course.found, course.search
    levels = ladder(search, found.base, found.explanations, course.predict)
    found, before = replace(found, ladder=levels), found.decided
    found = replace(found, decided=verdict.by_accuracy(before, levels))
    return found if found.decided is before else _with_leading_explanation(search, found, course.predict)


def _with_leading_explanation(search: Search, found: Diagnosis, predict: Predictor) -> Diagnosis:
    """The diagnosis with numbers, intervals and gain of the explanation that is by far the most accurate.

    It is fitted with the weights of its accuracy: those of noise alone would make the intervals too narrow.
    """
    rated = next(level.best for level in found.ladder if level.best.explanation is found.decided.best)
    strict = rated.explanation.model.data
    data = strict.with_model_error(rated.accuracy)
    fit = minimise(rated.fit.model.on(data), data.compared_again(rated.fit.evaluation))
    fit = profile_likelihood(tight_refit(fit), search.each)
    again = strict.compared_again(fit.evaluation)
    best = replace(fit, model=fit.model.on(strict), evaluation=again)
    others = [each for each in found.explanations if each.effects != best.effects]
    gain, best = cross_validate(found.base, best, predict), widened(best, predict)
    decided = replace(found.decided, best=best)
    known = tuple(best_of_each([best, *others], penalised))
    return replace(found, decided=decided, explanations=known, gain=gain)


def _with_more_effects(course: Course) -> Diagnosis:
    found = course.found
    if found.finding.verdict not in ABSTAINING:
        return found
    levels = forward_selection(course.search, found.explanations, found.ladder, course.predict)
    return replace(found, ladder=levels)


def _with_records_by_themselves(course: Course) -> Diagnosis:
    found = course.found
    if found.finding.verdict not in ABSTAINING or len(found.ladder) < 2:
        return found
    return replace(found, by_record=record_by_record(course.search, found.ladder[1]))


def _with_empirical_force(course: Course) -> Diagnosis:
    found = course.found
    if found.finding.verdict not in ABSTAINING and not course.empirical_force:
        return found
    force = empirical_force(found.base, found.ladder, course.search.each)
    return replace(found, empirical=force)


def _scored(course: Course) -> Diagnosis:
    scores = score_test.scores(course.search, course.found.base, course.explained.scans)
    return replace(course.found, scores=tuple(scores))


def _with_next_test(course: Course) -> Diagnosis:
    found = course.found
    fits = _undecided(found.finding, found.explanations)
    return replace(found, next_test=recommend(fits))


def data_of(measurement: Measurement) -> FitData:
    """The measured tests as data of a fit."""
    return joined([DATA[kind](measurement.of_kind(kind)) for kind in measurement.kinds])


def _candidates(
    effects: Sequence[str], measurement: Measurement, progress: Callable[[str], None]
) -> tuple[str, ...]:
    """Effects that the base model may lack."""
    excluded = excluded_effects(measurement)
    effects = [name for name in effects if EFFECTS[name].searched]
    asked = set() if set(effects) == set(candidates()) else set(effects)
    if not asked and measurement.kinds != (LOOP,):
        effects = [name for name in effects if not EFFECTS[name].of_loops]
    for name in [
        name for name in effects if name in excluded and (name in asked or excluded[name] == IN_BASE)
    ]:
        progress(f"no candidate: {name} {excluded[name]}")
    return tuple(name for name in effects if name not in excluded)


IN_BASE = "is part of the model already"
# Largest over smallest recorded load of a contact up to which tests tell nothing of what depends on it.
ALIKE = 1.05


def excluded_effects(measurement: Measurement) -> dict[str, str]:
    """Effects that the base model of a measurement cannot lack, and why."""
    model = measurement.model
    # Recorded loads always differ a little.
    alike = ALIKE if NORMAL_FORCE in measurement.columns else 1.0
    models = [measurement.model_of(test) for test in measurement.tests]
    differ = False
    if model.system == OSCILLATOR:
        loads = [each.oscillator["normal_force"] for each in models]
        differ = max(loads) > alike * min(loads)
    contained = [name for name in acting(model.effects) if name not in SCALES]
    return (
        model.excluded_effects(differ, measurement.kinds == (LOOP,))
        | _of_one_condition(models)
        | dict.fromkeys(contained, IN_BASE)
    )


def _of_one_condition(models: Sequence[Config]) -> dict[str, str]:
    """Effects whose operating condition is the same in the models of all tests, and why they do not show."""
    found = {}
    for name, effect in EFFECTS.items():
        if (stated := effect.condition) is not None:
            values = {model.effects.get(name, effect.off)[stated.name] for model in models}
            if len(values) == 1:
                found[name] = f"shows only where {stated.key} differs from test to test"
    return found


def refit_cause(
    search: Search, base: Fit, finding: Finding, found: list[Fit], thresholds: Thresholds
) -> tuple[Finding, list[Fit]]:
    """The finding with its best explanation fitted tightly, and all explanations, best first.

    Rivals whose fits had not converged are followed further first, as the gap to them decides. If another
    explanation becomes the best one after the tight fit, it is fitted tightly as well.
    """
    if finding.best is not None:
        found = best_of_each([*_continued(search, found), *found], penalised)
        finding = verdict.decide(base, found, thresholds)
    done: list[Fit] = []
    while finding.best is not None and not any(finding.best is each for each in done):
        fit = tight_refit(finding.best)
        # Without a cause there is no interval to report.
        if finding.cause is not None or search.budget.left > 0.0:
            fit = profile_likelihood(fit, search.each)
        done.append(fit)
        found = [done[-1] if each is finding.best else each for each in found]
        found.sort(key=penalised)
        finding = verdict.decide(base, found, thresholds)
    return finding, found


def _continued(search: Search, found: Sequence[Fit]) -> list[Fit]:
    """The leading explanations, followed further where their fits had not converged."""
    waiting = [each for each in sorted(found, key=penalised)[:LEADING] if not each.converged]
    return search.each(lambda fit: minimise(fit.model, fit.evaluation), waiting)


def _undecided(finding: Finding, explanations: Sequence[Fit]) -> list[Fit]:
    """Fits that a next test should separate, at most REFINED of them without a cause.

    These are a cause and its rivals. Without a cause they are the adequate explanations or, if fewer than two
    are adequate, the best ones.
    """
    if finding.cause is not None:
        return [finding.cause, *finding.rivals]
    if finding.verdict != verdict.INSUFFICIENT:
        return []
    adequate = finding.alternatives
    closest = adequate if len(adequate) > 1 else verdict.ranked(explanations)
    return list(closest[:REFINED])


# Steps of a diagnosis after the fit of the base model, in their order; any of them may fail or be cut off.
STEPS: dict[str, Callable[[Course], Diagnosis]] = {
    "single effects": lambda course: course.explained_by(single_fits(course.explained)),
    "refinement of single effects": lambda course: course.explained_by(taken(REFINEMENT, course.explained)),
    "pairs": lambda course: course.explained_by(taken(PAIRS, course.explained)),
    "calibration": _calibrated,
    "intervals": _with_intervals,
    "held-out tests": _held_out,
    "accuracy": _rated,
    FORWARD: _with_more_effects,
    RECORD_BY_RECORD: _with_records_by_themselves,
    "empirical force": _with_empirical_force,
    "scores": _scored,
    "next test": _with_next_test,
}
