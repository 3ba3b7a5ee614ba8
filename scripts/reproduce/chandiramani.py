"""Chandiramani's experiment: which changes of the model explain it, and which test would decide.

Every hypothesis is searched under each friction law, both signs of the column angle and each interpretation
of the unknown inputs: all scenarios with a coarse budget, the most promising laws and column angles of each
hypothesis with a medium one, and its best with a fine one.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import joblib
import numpy as np

from reproduce import observations
from reproduce.discrimination import Discrimination, discriminate
from reproduce.hypotheses import (
    COLUMN_ANGLES,
    HYPOTHESES,
    INDEPENDENT_INPUTS,
    INTERPRETATIONS,
    Hypothesis,
)
from reproduce.observations import OBSERVATIONS, Recording
from reproduce.scenarios import (
    LOOSE,
    TIGHT,
    EvaluatedPoint,
    Scenario,
    loss,
    recordings,
    satisfied,
    sweep,
)
from reproduce.search import COARSE, FINE, MEDIUM, Budget, SearchResult, search
from wedgesweep.solvers.periodic import Accuracy
from wedgesweep.sweep.backend import in_order

HERTZ = np.arange(20.0, 41.0)
# Points of a search that are compared again: the search used every second frequency of the sweep only.
COMPARED = 50
# Pairs of law and column angle of each hypothesis that get the medium budget.
PROMISING = 2
# Number of observations that each hypothesis satisfies. If a run finds another number, something has changed.
RECORDED = {
    "small-input": 5,
    "jamming": 5,
    "preload": 7,
    "guide-friction": 6,
    "fixture-resonance": 6,
    "column-compliance": 6,
    "cross-slip": 6,
}

Report = Callable[[str], None]


@dataclass(frozen=True)
class Best(EvaluatedPoint):
    """The best point of a search, with recordings and sweep (peak-to-peak in mm over HERTZ)."""

    result: SearchResult
    slow: Recording
    fast: Recording
    sweep: np.ndarray


def _computed(result: SearchResult) -> Best:
    """Compute the best point of a search accurately, at all frequencies of the sweep."""
    points = result.equally_good[:COMPARED]
    *_, distances = _simulated(result.scenario, points, LOOSE)
    best = points[np.lexsort((loss(distances), -satisfied(distances)))[:1]]
    slow, fast, levels, distances = _simulated(result.scenario, best, TIGHT)
    return Best(result.scenario, best[0], distances[0], result, slow, fast, levels[0])


def _simulated(
    scenario: Scenario, points: np.ndarray, accuracy: Accuracy
) -> tuple[Recording, Recording, np.ndarray, np.ndarray]:
    """Recordings, sweep (mm) and distances at points (n, free)."""
    records = scenario.records(points)
    recorded, swept = scenario.inputs(points, HERTZ)
    slow, fast = recordings(records, recorded, accuracy)
    levels = sweep(records, swept, HERTZ, accuracy)
    parts = [observations.of_tests(slow, fast), observations.of_sweep(HERTZ, levels)]
    return slow, fast, levels, np.concatenate(parts, axis=1)


@dataclass(frozen=True)
class Investigation:
    """Result of every scenario, each hypothesis at its best, the best hypotheses and tests between them."""

    scenarios: list[SearchResult]
    best: list[Best]
    rivals: list[Best]
    pairs: list[Discrimination]
    next_test: Discrimination

    @property
    def agrees(self) -> bool:
        """Whether every hypothesis satisfies as many observations as on record."""
        return {each.scenario.hypothesis.name: each.satisfied for each in self.best} == RECORDED


def investigate(
    n_jobs: int,
    report: Report,
    hypotheses: Sequence[Hypothesis] = HYPOTHESES,
    budgets: tuple[Budget, Budget, Budget] = (COARSE, MEDIUM, FINE),
) -> Investigation:
    """Search all hypotheses; takes minutes, and finds the same numbers every time."""
    _compile(hypotheses)
    coarse, medium, fine = budgets
    scenarios = [scenario for hypothesis in hypotheses for scenario in _scenarios(hypothesis)]
    first = _search(((scenario, coarse, None) for scenario in scenarios), n_jobs)
    report(f"{len(first)} coarse searches of {len(hypotheses)} hypotheses: laws, column angles and inputs")
    promising = [each for hypothesis in hypotheses for each in _promising(_ordered(first, hypothesis))]
    found = _search(((scenario, medium, start) for scenario, start in promising), n_jobs)
    report(f"{len(found)} medium searches; next the best of each hypothesis")
    widest = [_with_independent_inputs(_ordered(found, hypothesis)[0]) for hypothesis in hypotheses]
    # Without start points: known good points would lead to the same minima again.
    found += _search(((scenario, fine, None) for scenario in widest), n_jobs)
    # The best of each hypothesis once all its results are computed accurately.
    best = [min(map(_computed, _ordered(found, hypothesis)), key=_rank) for hypothesis in hypotheses]
    for each in best:
        report(f"{each.satisfied} of {len(OBSERVATIONS)}: {each.scenario.hypothesis.description}")
    rivals = _rivals(best)
    pairs, next_test = discriminate([each.result for each in rivals])
    return Investigation(_merged(first, found), best, rivals, pairs, next_test)


def _scenarios(hypothesis: Hypothesis) -> list[Scenario]:
    return [Scenario(hypothesis, *each) for each in product(hypothesis.laws, COLUMN_ANGLES, INTERPRETATIONS)]


def _compile(hypotheses: Sequence[Hypothesis]) -> None:
    """Fill numba's cache here, so that the jobs do not all compile the same functions."""
    scenario = _scenarios(hypotheses[0])[0]
    point = np.full((1, scenario.free), 0.5)
    recordings(scenario.records(point), scenario.inputs(point, HERTZ)[0], LOOSE)


def _search(
    searches: Iterable[tuple[Scenario, Budget, np.ndarray | None]], n_jobs: int
) -> list[SearchResult]:
    """Results in the order of the searches."""
    return in_order((joblib.delayed(search)(*each) for each in searches), n_jobs)


def _rank(result: EvaluatedPoint) -> tuple[int, int, float]:
    """Order of results, best first: of two that satisfy as much, the one with fewer inputs."""
    return -result.satisfied, result.scenario.interpretation.inputs, result.loss


def _ordered(results: Iterable[SearchResult], hypothesis: Hypothesis) -> list[SearchResult]:
    """Results of a hypothesis, best first."""
    return sorted((each for each in results if each.scenario.hypothesis.name == hypothesis.name), key=_rank)


def _with_independent_inputs(best: SearchResult) -> Scenario:
    """The scenario with the same law and column angle that includes all interpretations of the inputs."""
    return replace(best.scenario, interpretation=INDEPENDENT_INPUTS)


def _promising(ordered: Sequence[SearchResult]) -> Iterator[tuple[Scenario, np.ndarray]]:
    """Scenarios for the medium budget, with start points.

    The best pairs of law and column angle, each with its best interpretation and with independent inputs.
    """
    pairs = list(dict.fromkeys((each.scenario.law.name, each.scenario.column_angle_deg) for each in ordered))
    for pair in pairs[:PROMISING]:
        own = [each for each in ordered if (each.scenario.law.name, each.scenario.column_angle_deg) == pair]
        single = next(each for each in own if each.scenario.interpretation != INDEPENDENT_INPUTS)
        yield single.scenario, single.point[None]
        starts = [each.scenario.interpretation.as_independent_inputs(each.point[None]) for each in own]
        yield _with_independent_inputs(single), np.concatenate(starts)


def _merged(first: Sequence[SearchResult], later: Sequence[SearchResult]) -> list[SearchResult]:
    """One result per scenario, the last one if there are several."""
    return list({tuple(each.scenario.labels().values()): each for each in (*first, *later)}.values())


def _rivals(best: Sequence[Best]) -> list[Best]:
    """The hypotheses that satisfy the most; with the next best if there is only one."""
    ordered = sorted(best, key=lambda each: (-each.satisfied, each.loss))
    return [each for each in ordered if each.satisfied >= ordered[1].satisfied]


def document(found: Investigation) -> dict[str, Any]:
    """Everything that the report says and the figure shows, in plain data."""
    return {
        "observations": [vars(each) for each in OBSERVATIONS],
        "hypotheses": [_entry(each) for each in found.best],
        "rivals": [each.scenario.hypothesis.name for each in found.rivals],
        "pairs": [vars(each) for each in found.pairs],
        "next_test": vars(found.next_test),
        "hertz": HERTZ.tolist(),
        "scenarios": [
            {**each.scenario.labels(), "satisfied": each.satisfied, "loss": each.loss}
            for each in found.scenarios
        ],
    }


def _entry(best: Best) -> dict[str, Any]:
    names = [each.name for each in OBSERVATIONS]
    return {
        **best.scenario.labels(),
        "description": best.scenario.hypothesis.description,
        "satisfied": best.satisfied,
        "values": best.scenario.parameters(best.point.tolist()),
        "distances": dict(zip(names, best.distances.tolist(), strict=True)),
        "slow": _numbers(best.slow),
        "fast": _numbers(best.fast),
        "peak_to_peak_mm": best.sweep.tolist(),
    }


def _numbers(recording: Recording) -> dict[str, float]:
    return {name: float(values[0]) for name, values in recording._asdict().items()}
