"""The whole way from measured tests to a verdict."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from wedgesweep.diagnose import cross_validation, next_test, pairs, score_test, verdict
from wedgesweep.diagnose.calibration import calibrate
from wedgesweep.diagnose.cross_validation import Gain
from wedgesweep.diagnose.least_squares import tight_refit
from wedgesweep.diagnose.next_test import NextTest
from wedgesweep.diagnose.profile_likelihood import profile_likelihood
from wedgesweep.diagnose.score_test import Score
from wedgesweep.diagnose.search import Explanation, Search, best_of_each, penalised
from wedgesweep.diagnose.steady import tone
from wedgesweep.diagnose.steady.fit_data import FitData
from wedgesweep.diagnose.steady.model import Fit
from wedgesweep.diagnose.steady.spectra import fitted, spectrum
from wedgesweep.diagnose.steady.tone_phase import with_tone_phase
from wedgesweep.diagnose.verdict import Finding, Thresholds
from wedgesweep.effects import EFFECTS, SCALES, acting
from wedgesweep.measured import Measurement, TestRecord

# Explanations that a next test should tell apart where the verdict abstains.
COMPARED = 6
# A base model that leaves less than this share of what it left first may have other singles beside it.
MUCH = 0.9


@dataclass(frozen=True)
class Diagnosis:
    """Everything that was found; ``explanations`` are sorted, the best first."""

    measurement: Measurement
    data: FitData
    base: Explanation
    explanations: tuple[Explanation, ...]
    scores: tuple[Score, ...]
    finding: Finding
    gain: Gain | None
    next_test: NextTest | None
    thresholds: Thresholds
    calibration: dict[str, float | None] | None = None

    @property
    def extended(self) -> Fit:
        """The best explanation's fit, the base model's where the verdict is that nothing is missing."""
        best = self.finding.best
        return self.base.fit if best is None else best.fit


def fit_data_of(measurement: Measurement) -> FitData:
    """Spectra of all tests at their actual frequencies; a foreign tone is the model's, or it is found."""
    tests = measurement.tests
    signals = [_channels(test, measurement.derived_velocity) for test in tests]
    records = [(test.time, s, test.refined_frequency) for test, s in zip(tests, signals, strict=True)]
    foreign = tone.of(acting(measurement.model.effects)) or tone.find([fitted(*each) for each in records])
    found = [spectrum(*each, foreign.frequency if foreign else None) for each in records]
    known = [test.amplitude is not None for test in tests]
    return FitData(
        measurement.model,
        measurement.law,
        tuple(test.name for test in tests),
        tuple(found),
        np.array([test.amplitude if test.amplitude else np.nan for test in tests]),
        np.array([t.amplitude_std if k else np.inf for t, k in zip(tests, known, strict=True)]),
        dict(measurement.uncertain),
        foreign.frequency if foreign else None,
        foreign.std if foreign else 0.0,
    )


def _channels(test: TestRecord, derived_velocity: bool) -> np.ndarray:
    """Channels that say something of their own, (C, n)."""
    if test.velocity is None or derived_velocity:
        return test.displacement[None]
    return np.array([test.displacement, test.velocity])


def diagnose(
    measurement: Measurement,
    effects: Sequence[str] = tuple(EFFECTS),
    threads: int = 1,
    progress: Callable[[str], None] = lambda step: None,
    calibrated: bool = False,
) -> Diagnosis:
    """Name what the base model misses, or say why it cannot be named.

    ``effects``: the candidates; what the base model has already is none, unless it scales a number.
    ``calibrated``: with thresholds from simulations of these very tests, not the general ones.
    """
    data = fit_data_of(measurement)
    effects = _missing(effects, measurement, progress)
    search = Search(data, effects, threads, progress)
    base, explanations = explain(search)
    thresholds, simulated = verdict.DEFAULT, None
    finding = verdict.decide(base, explanations, thresholds)
    if calibrated:
        simulated = calibrate(base, finding.best, explain, effects, threads, progress)
        thresholds = simulated.thresholds
        finding = verdict.decide(base, explanations, thresholds)
    finding, explanations = _refit_best(search, base, finding, explanations, thresholds)
    progress("scores")
    scores = score_test.scores(search, base.fit)
    measured_gain = None
    if finding.best is not None and data.tests > 1:
        progress("held-out tests")
        measured_gain = cross_validation.cross_validate(base.fit, finding.best.fit, search.each)
        finding = verdict.on_unseen_tests(finding, base, measured_gain.excess_removed, measured_gain.interval)
        measured_gain = measured_gain if finding.best is not None else None
    progress("next test")
    following = next_test.recommend(_undecided(finding, explanations, thresholds))
    return Diagnosis(
        measurement,
        data,
        base,
        tuple(explanations),
        tuple(scores),
        finding,
        measured_gain,
        following,
        thresholds,
        simulated.as_dict() if simulated else None,
    )


def _missing(
    effects: Sequence[str], measurement: Measurement, progress: Callable[[str], None]
) -> tuple[str, ...]:
    """Effects that the base model may lack."""
    own = acting(measurement.model.effects)
    there = [name for name in effects if name in own and name not in SCALES]
    if there:
        progress(f"part of the base model, so no candidates: {', '.join(there)}")
    return tuple(name for name in effects if name not in there)


def _refit_best(
    search: Search, base: Explanation, finding: Finding, found: list[Explanation], thresholds: Thresholds
) -> tuple[Finding, list[Explanation]]:
    """The finding with its best explanation fitted exactly, and all explanations, best first.

    One that was only the best for the error of its responses gives way to the next.
    """
    done: list[Explanation] = []
    while finding.best is not None and not any(finding.best is each for each in done):
        search.progress(f"exact fit of {' + '.join(finding.best.effects)}")
        done.append(
            search.explanation(
                profile_likelihood(tight_refit(with_tone_phase(finding.best.fit)), search.each)
            )
        )
        found = [done[-1] if each is finding.best else each for each in found]
        found.sort(key=penalised)
        finding = verdict.decide(base, found, thresholds)
    return finding, found


def explain(search: Search) -> tuple[Explanation, list[Explanation]]:
    """The base model and all that was fitted beside it, best first."""
    search.progress("base model")
    base = search.base()
    found = search.singles(base.fit)
    better = search.refit_base(base, found)
    if better.fit.chi2 < MUCH * base.fit.chi2:
        found = best_of_each([*found, *search.singles(better.fit)], penalised)
    base = better
    found = _more(search, base, found)
    return search.refit_base(base, found), found


def _more(search: Search, base: Explanation, found: list[Explanation]) -> list[Explanation]:
    """All fits, best first: pairs only where no single effect will do, and all starts where no pair will."""
    if verdict.none_adequate([base]):
        found = search.around(found)
    if verdict.none_adequate([base, *found]) and search.data.tests >= verdict.FEWEST_TESTS:
        both = pairs.pairs(search, base.fit, found)
        found = found + both + pairs.component_fits(search, both)
        if verdict.none_adequate(found):
            found = found + search.multistart()
    return best_of_each(found, penalised)


def _undecided(finding: Finding, explanations: Sequence[Explanation], thresholds: Thresholds) -> list[Fit]:
    """Fits that a next test should tell apart: a cause and its rivals, or without one what comes closest."""
    if finding.cause is not None:
        return [finding.cause.fit, *(each.fit for each in finding.rivals)]
    if finding.verdict == verdict.INSUFFICIENT:
        return [each.fit for each in verdict.ranked(explanations, thresholds.gap)[:COMPARED]]
    return []
