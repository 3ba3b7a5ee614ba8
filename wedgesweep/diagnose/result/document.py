"""The content of diagnosis.json."""

from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from math import isfinite
from signal import SIGINT
from typing import Any

import numpy as np

from wedgesweep import __version__, rotation
from wedgesweep.config import Config
from wedgesweep.diagnose.cross_validation import Gain
from wedgesweep.diagnose.diagnosis import Diagnosis, excluded_effects
from wedgesweep.diagnose.explanation import ADEQUATE, POSSIBLE, parameter_penalty
from wedgesweep.diagnose.ladder import REFINED, ByRecord, Level, Rated
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.next_test.recommend import SEPARATED, NextTest
from wedgesweep.diagnose.repeats import Spread
from wedgesweep.diagnose.result import missing_force
from wedgesweep.diagnose.result.estimates import finite, parameters, uncertain, widen
from wedgesweep.diagnose.verdict import GAP, LARGER, Finding, p_where_it_shows
from wedgesweep.diagnose.work import SLIGHT, TIME_LIMIT, OutOfTime, summary
from wedgesweep.diagnosis_result import FAILED, NO_BETTER
from wedgesweep.effects import EFFECTS


def document(found: Diagnosis) -> dict[str, Any]:
    """The content of diagnosis.json."""
    finding, data = found.finding, found.data
    best = finding.best or found.base
    hidden = _not_testable(found)
    content = {
        "verdict": finding.verdict,
        "reason": {"code": finding.reason.code, **finding.numbers},
        "causes": _causes(finding),
        "rivals": [
            {"effects": list(each.effects), "gap": each.penalised - best.penalised}
            for each in finding.alternatives
        ],
        "misfit": _misfit(found, best),
        "gain": _gain(found.gain),
        "detectable": {
            score.effect: {score.key: score.detectable} for score in found.scores if score.testable
        },
        "not_testable": hidden,
        "excluded": excluded_effects(found.measurement),
        "next_test": _next_test(found.next_test),
        "ladder": [_level(each, found.spread) for each in found.ladder],
        "repeats": _repeats(found.spread),
        "record_by_record": [_of_records(each) for each in found.by_record],
        "empirical_force": missing_force.document(found.empirical),
        "extended": list(best.effects),
        "never_steady": _never_steady(best),
        "untried": [
            {"what": each.what, "left_out": each.left_out, "of": each.of, "ended_by": each.ended_by}
            for each in found.untried
        ],
        "never_tried": [list(each) for each in found.never_tried],
        "unfinished": [{"step": step, "reason": why} for step, why in found.unfinished.items()],
        "stages": summary(found.changes),
        "without": list(found.without),
        "failed": [{"effect": effect, "reason": why} for effect, why in found.failed.items()],
        "ended": _ended(found),
        "title": found.measurement.title,
        "kind": data.kind,
        "model": {
            "system": data.model.system,
            "law": data.law,
            "title": data.model.title,
            **_surface(data.model),
        },
        "uncertain": uncertain(best),
        "version": __version__,
        "created": datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ"),
        "method": _method(found),
        "candidates": _candidates(found, hidden),
    }
    return finite(rotation.written(content) if data.model.turns else content)


def _ended(found: Diagnosis) -> dict[str, Any] | None:
    """What ended the diagnosis, or its search, early: the time limit, or a signal by its number."""
    if found.ended is not None and not isinstance(found.ended, OutOfTime):
        return {"by": "interrupt", "signal": int(getattr(found.ended, "number", SIGINT))}
    return {"by": TIME_LIMIT, "signal": None} if TIME_LIMIT in found.unfinished.values() else None


def _surface(model: Config) -> dict[str, Any]:
    """What an oscillator rubs on, and what drives it."""
    if model.system != "oscillator":
        return {}
    about = {"contact": model.oscillator["contact"], "excitation": model.excitation}
    return about | ({"motion": rotation.ROTATION} if model.turns else {})


def _never_steady(fit: Fit) -> list[str]:
    """Tests whose simulation depends on how long the rig had run before they were recorded."""
    data = fit.model.data
    if not fit.evaluation.found:
        return []
    never = data.never_steady(fit.model.scenario(fit.point))
    return [name for name, one in zip(data.names, never, strict=True) if one]


def _not_testable(found: Diagnosis) -> list[str]:
    """Effects that the tests cannot show, unless they explain the tests and so do show."""
    finding = found.finding
    explaining = {
        effect
        for each in (finding.cause, *finding.alternatives)
        if each is not None
        for effect in each.effects
    }
    return [score.effect for score in found.scores if not score.testable and score.effect not in explaining]


def _causes(finding: Finding) -> list[dict[str, Any]]:
    """The effects of the cause with their parameters."""
    if finding.cause is None:
        return []
    numbers = parameters(finding.cause)
    for each in finding.larger:
        widen(numbers, parameters(each))
    return [
        {
            "effect": name,
            "family": EFFECTS[name].family,
            "branch": EFFECTS[name].branch,
            "parameters": numbers[name],
        }
        for name in finding.cause.effects
    ]


def _misfit(found: Diagnosis, best: Fit) -> dict[str, Any]:
    base = found.base
    return {
        "chi2_base": base.chi2,
        "chi2_extended": best.chi2,
        "dof": base.dof,
        "dof_extended": best.dof,
        "excess_base": base.excess,
        "p_base": base.p,
        "implausible": list(base.implausible),
        "p_extended": best.p,
        "p_where_it_shows": p_where_it_shows(base, best),
        **_constancy(best),
        "tests": _tests(found),
    }


def _constancy(best: Fit) -> dict[str, Any]:
    """Whether parameters are the same in all tests; null where the misfit alone rules the fit out."""
    p, parameter = best.constancy if best.p >= POSSIBLE else (None, None)
    return {"p_constant": p, "least_constant": parameter}


def _tests(found: Diagnosis) -> list[dict[str, Any]]:
    data, base, best = found.data, found.base, found.extended
    misfits = base.evaluation.chi2_by_test, best.evaluation.chi2_by_test
    rows = zip(data.names, data.rows(base, best), *misfits, data.dof, strict=True)
    return [
        {"name": name, **row, "q_base": before, "q_extended": after, "dof": int(dof)}
        for name, row, before, after, dof in rows
    ]


def _gain(gain: Gain | None) -> dict[str, Any]:
    """The gain, with null for every number where nothing was held out."""
    if gain is None:
        numbers = ("scheme", "rmse_base", "rmse_extended", "rmse_noise", "gain", "excess_removed", "ci95")
        return {**dict.fromkeys(numbers), "held_out": []}
    base, extended, noise = np.sqrt(gain.mean_squares())
    own = zip(gain.tests.tolist(), gain.schemes, gain.rmse.tolist(), strict=True)
    return {
        "scheme": " and ".join(f"leave-one-{scheme}-out" for scheme in dict.fromkeys(gain.schemes)),
        "rmse_base": base,
        "rmse_extended": extended,
        "rmse_noise": noise,
        "gain": 1.0 - extended / base,
        "excess_removed": gain.excess_removed,
        "ci95": gain.interval,
        "held_out": [
            {"test": test, "scheme": scheme, "rmse_base": before, "rmse_extended": after, "rmse_noise": floor}
            for test, scheme, (before, after, floor) in own
        ],
    }


def _next_test(test: NextTest | None) -> dict[str, Any] | None:
    if test is None:
        return None
    return {
        "kind": test.kind,
        **({} if test.motion is None else {"motion": test.motion}),
        **test.numbers,
        "separates": list(test.closest.names),
        "distance": test.closest.distance,
        "pairs": [{"separates": list(each.names), "distance": each.distance} for each in test.pairs],
    }


def _repeats(spread: Spread | None) -> dict[str, Any] | None:
    """How much repeats of a test differ; 0.01 is 1 % of the response."""
    if spread is None:
        return None
    tests = [list(names) for names in spread.repeats]
    numbers = {"share": spread.share, "ci95": list(spread.interval), "counts": spread.counts}
    return {**numbers, "tests": tests}


def _level(level: Level, spread: Spread | None) -> dict[str, Any]:
    """The most accurate explanation of a number of effects, with its rivals; 0.01 is 1 % of the response."""
    left = (
        {}
        if spread is None or not spread.counts
        else {"model_share": spread.left_to_model(level.best.accuracy)}
    )
    return {
        **left,
        **_rated(level.best),
        "accuracy_held_out": level.best.held_out,
        "distinct": level.distinct,
        "rivals": [_rated(each) for each in level.rivals[: REFINED - 1]],
    }


def _rated(each: Rated) -> dict[str, Any]:
    return {"effects": list(each.effects), "accuracy": each.accuracy}


def _of_records(each: ByRecord) -> dict[str, Any]:
    """An explanation whose numbers differ from record to record."""
    records = [{"record": name, "parameters": _by_name(parameters(fit))} for name, fit in each.fits]
    return {"effects": list(each.effects), "accuracy": each.accuracy, "records": records}


def _by_name(numbers: Mapping[str, Mapping[str, Any]]) -> dict[str, Any]:
    """Estimates by "effect.key"."""
    return {f"{name}.{key}": value for name, own in numbers.items() for key, value in own.items()}


def _method(found: Diagnosis) -> dict[str, Any]:
    return {
        "penalty_per_parameter": parameter_penalty(found.data),
        "gap": GAP,
        "enough_distance": SEPARATED,
        "strong_excess": found.thresholds.strong,
        "adequate_p": ADEQUATE,
        "model_error": found.data.model_error,
        "larger_model_error": LARGER * found.data.model_error,
        "noise_floor": found.data.noise_floor,
        "least_gain": found.thresholds.least_gain,
        "dof": found.base.dof,
        **found.data.method,
        "calibrated": found.calibration,
    }


def _candidates(found: Diagnosis, hidden: Sequence[str]) -> list[dict[str, Any]]:
    scores = {score.effect: score for score in found.scores}
    accuracies = {each.effects: each.accuracy for level in found.ladder for each in level.rated}
    rows = []
    for each in sorted([found.base, *found.explanations], key=lambda one: one.penalised):
        score = scores.get(each.effects[0]) if len(each.effects) == 1 else None
        status = _status(found, each, hidden)
        numbers = parameters(each) if status not in (FAILED, NO_BETTER) else {}
        rows.append(
            {
                "effects": list(each.effects),
                "q": each.chi2,
                "dof": each.dof,
                "p": each.p,
                "penalised": each.penalised,
                "accuracy": accuracies.get(each.effects),
                "parameters": _by_name(numbers),
                "score": None if score is None else score.t2,
                "retention": None if score is None else score.retention,
                "status": status,
            }
        )
    return rows


def _status(found: Diagnosis, each: Fit, hidden: Sequence[str]) -> str:
    """How a fit ended; one worse than the base model that it contains has not found its minimum."""
    if not isfinite(each.chi2):
        return FAILED
    if each.chi2 > found.base.chi2 + SLIGHT:
        return NO_BETTER
    return "not testable" if len(each.effects) == 1 and each.effects[0] in hidden else "fitted"
