"""Chandiramani's experiment: which changes of the model bring what was observed, and how to tell them apart.

Every suspect is searched under each friction law, both leans of the columns and each reading of the
unknown inputs: all questions briefly, the most promising laws and leans of each suspect well, and the best
one deeply.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import joblib
import numpy as np

from wedgesweep.reproduce.best import HERTZ, Case, computed
from wedgesweep.reproduce.observations import OBSERVATIONS
from wedgesweep.reproduce.search import DEEPLY, THROUGH, WELL, Effort, Found, search
from wedgesweep.reproduce.separation import Separation, separate
from wedgesweep.reproduce.suspects import AN_INPUT_EACH, LEANS, READINGS, SUSPECTS, Suspect
from wedgesweep.reproduce.trials import ROUGH, Question, described, record
from wedgesweep.sweep.backend import loky

# Pairs of law and lean of each suspect that are searched well.
PROMISING = 2
# How many observations each suspect meets. A run that finds another number has found a change.
RECORDED = {
    "small-input": 5,
    "preload": 7,
    "guide-friction": 6,
    "fixture-resonance": 6,
    "column-compliance": 6,
    "cross-slip": 6,
}

Report = Callable[[str], None]


@dataclass(frozen=True)
class Investigation:
    """Outcome: every question, each suspect's best case, the suspects left, and tests that part these."""

    questions: list[Found]
    cases: list[Case]
    rivals: list[Case]
    pairs: list[Separation]
    next_test: Separation

    @property
    def agrees(self) -> bool:
        return {each.found.question.suspect.name: each.met for each in self.cases} == RECORDED

    @property
    def survivors(self) -> list[str]:
        """Suspects that meet all observations."""
        return [each.found.question.suspect.name for each in self.cases if each.met == len(OBSERVATIONS)]


def investigate(
    n_jobs: int,
    report: Report,
    suspects: Sequence[Suspect] = SUSPECTS,
    efforts: tuple[Effort, Effort, Effort] = (THROUGH, WELL, DEEPLY),
) -> Investigation:
    """Search all suspects; takes minutes, and the same numbers come out each time."""
    _compile(suspects)
    through, well, deeply = efforts
    questions = [_questions(suspect) for suspect in suspects]
    briefly = _search(((q, through, None) for each in questions for q in each), n_jobs)
    report(f"{len(briefly)} searches of {len(suspects)} suspects: laws, leans, readings of the inputs")
    promising = [each for suspect in suspects for each in _promising(_best_of(briefly, suspect))]
    found = _search(((question, well, start) for question, start in promising), n_jobs)
    report(f"{len(found)} of them searched well; the best of each suspect next")
    best = [_widest(_best_of(found, suspect)[0]) for suspect in suspects]
    # From anew: points that are known to be good would all lead to where these are.
    found += _search(((question, deeply, None) for question in best), n_jobs)
    cases = [_closest(_best_of(found, suspect)) for suspect in suspects]
    for case in cases:
        report(f"{case.met} of {len(OBSERVATIONS)}: {case.found.question.suspect.words}")
    rivals = _rivals(cases)
    pairs, next_test = separate([each.found for each in rivals])
    return Investigation(_merged(briefly, found), cases, rivals, pairs, next_test)


def _questions(suspect: Suspect) -> list[Question]:
    return [
        Question(suspect, law, lean, reading)
        for law in suspect.laws
        for lean in LEANS
        for reading in READINGS
    ]


def _compile(suspects: Sequence[Suspect]) -> None:
    """Fill numba's cache here, so that the jobs do not all compile the same."""
    question = _questions(suspects[0])[0]
    point = np.full((1, question.free), 0.5)
    record(question.records(point), question.inputs(point, HERTZ)[0], ROUGH)


def _search(asked: Iterable[tuple[Question, Effort, np.ndarray | None]], n_jobs: int) -> list[Found]:
    """Outcomes in the order of the questions, whichever job is first."""
    tasks = [joblib.delayed(partial(_numbered, k))(*each) for k, each in enumerate(asked)]
    with loky(n_jobs, dict) as pool:
        return [found for _, found in sorted(pool(tasks), key=lambda pair: pair[0])]


def _numbered(k: int, question: Question, effort: Effort, start: np.ndarray | None) -> tuple[int, Found]:
    return k, search(question, effort, start)


def _best_of(found: Iterable[Found], suspect: Suspect) -> list[Found]:
    """Outcomes for a suspect, the best first: what meets as much with fewer inputs says more."""
    own = [each for each in found if each.question.suspect.name == suspect.name]
    return sorted(own, key=lambda each: (-each.met, each.question.reading.inputs, each.loss))


def _closest(outcomes: Sequence[Found]) -> Case:
    """The best of a suspect's outcomes once they are computed finely."""
    cases = map(computed, outcomes)
    return max(cases, key=lambda case: (case.met, -case.found.question.reading.inputs, -case.loss))


def _widest(best: Found) -> Question:
    """The question with the same law and lean that holds all readings of the inputs."""
    return replace(best.question, reading=AN_INPUT_EACH)


def _promising(ordered: Sequence[Found]) -> Iterator[tuple[Question, np.ndarray]]:
    """Questions to search well and where to start: best pairs of law and lean, best and widest readings."""
    pairs = list(dict.fromkeys((each.question.law.name, each.question.lean) for each in ordered))
    for pair in pairs[:PROMISING]:
        alike = [each for each in ordered if (each.question.law.name, each.question.lean) == pair]
        single = next(each for each in alike if each.question.reading != AN_INPUT_EACH)
        yield single.question, single.point[None]
        starts = [each.question.reading.as_an_input_each(each.point[None]) for each in alike]
        yield _widest(single), np.concatenate(starts)


def _merged(briefly: Sequence[Found], later: Sequence[Found]) -> list[Found]:
    """One outcome per question, the last one where there are several."""
    again = {_name(each.question): each for each in later}
    return [again.get(_name(each.question), each) for each in briefly]


def _rivals(cases: Sequence[Case]) -> list[Case]:
    """The suspects that meet the most; with the next best where it is only one."""
    ordered = sorted(cases, key=lambda case: (-case.met, case.loss))
    return [case for case in ordered if case.met >= ordered[1].met]


def document(outcome: Investigation) -> dict[str, Any]:
    """Everything that the page says and the figure shows, in plain data."""
    return {
        "observations": [vars(each) for each in OBSERVATIONS],
        "survivors": outcome.survivors,
        "suspects": [_told(case) for case in outcome.cases],
        "rivals": [case.found.question.suspect.name for case in outcome.rivals],
        "pairs": [vars(each) for each in outcome.pairs],
        "next_test": vars(outcome.next_test),
        "hertz": HERTZ.tolist(),
        "questions": [_outcome(each) for each in outcome.questions],
    }


def _name(question: Question) -> tuple[Any, ...]:
    return tuple(_asked(question).values())


def _asked(question: Question) -> dict[str, Any]:
    return {
        "suspect": question.suspect.name,
        "law": question.law.name,
        "column_angle_deg": question.lean,
        "reading": question.reading.name,
    }


def _outcome(found: Found) -> dict[str, Any]:
    return {**_asked(found.question), "met": found.met, "loss": found.loss}


def _told(case: Case) -> dict[str, Any]:
    question = case.found.question
    names = [each.name for each in OBSERVATIONS]
    return {
        **_asked(question),
        "words": question.suspect.words,
        "met": case.met,
        "values": described(question, case.point.tolist()),
        "distances": dict(zip(names, case.distances.tolist(), strict=True)),
        "slow": {name: float(values[0]) for name, values in case.slow._asdict().items()},
        "fast": {name: float(values[0]) for name, values in case.fast._asdict().items()},
        "peak_to_peak_mm": case.sweep.tolist(),
    }
