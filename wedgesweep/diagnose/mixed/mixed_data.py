"""Tests of several kinds as data of a fit: each kind compares its own tests, all share the parameters.

Tests of one kind follow those of another. A kind without tests in a subset keeps its columns of nuisance
parameters.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple, Self

import numpy as np

from wedgesweep.config import Config
from wedgesweep.diagnose.evaluation import (
    UNUSED,
    Comparison,
    Evaluation,
    NuisanceParameter,
    Point,
    Scenario,
)
from wedgesweep.diagnose.fit_data import Evaluator, FitData
from wedgesweep.diagnose.mixed.layout import Layout, MixedStart
from wedgesweep.diagnose.model import Fit
from wedgesweep.natural_units import NaturalUnits


class MixedResponse(NamedTuple):
    """What was simulated of each kind, and the number m of its residuals; None and 0 without tests."""

    parts: tuple[Any, ...]
    sizes: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class MixedData(FitData):
    """Tests of several kinds; ``parts`` holds None for a kind without tests."""

    parts: tuple[FitData | None, ...]
    layout: Layout

    kind = "mixed"

    @classmethod
    def of(cls, parts: Sequence[FitData]) -> "MixedData":
        return cls(tuple(parts), Layout.of(parts))

    @property
    def present(self) -> list[FitData]:
        """The kinds that have tests."""
        return [part for part in self.parts if part is not None]

    def _each(self, function: Callable[..., Any], *lists: Sequence[Any]) -> list[Any]:
        """Results for the kinds that have tests, None for others; ``lists`` have an element for each kind."""
        return [
            None if part is None else function(part, *each)
            for part, *each in zip(self.parts, *lists, strict=True)
        ]

    def _of_present(self, function: Callable[[FitData], Any]) -> list[Any]:
        return [function(part) for part in self.present]

    def _with(self, parts: Sequence[FitData | None]) -> Self:
        same = all(one is other for one, other in zip(parts, self.parts, strict=True))
        return self if same else replace(self, parts=tuple(parts))

    @property
    def model(self) -> Config:  # type: ignore[override]
        return self.present[0].model

    @property
    def law(self) -> str:  # type: ignore[override]
        return self.present[0].law

    @cached_property
    def names(self) -> tuple[str, ...]:  # type: ignore[override]
        return tuple(name for part in self.present for name in part.names)

    @property
    def model_error(self) -> float:  # type: ignore[override]
        return self.present[0].model_error

    @property
    def uncertain(self) -> dict[str, float]:  # type: ignore[override]
        return self.present[0].uncertain

    @property
    def input_gain_std(self) -> float:  # type: ignore[override]
        return max(part.input_gain_std for part in self.present)

    @property
    def eliminated(self) -> int:  # type: ignore[override]
        return max(part.eliminated for part in self.present)

    @property
    def tests(self) -> int:
        return sum(self.layout.tests)

    @property
    def measured_tests(self) -> int:
        return sum(part.measured_tests for part in self.present)

    @property
    def observations(self) -> np.ndarray:
        return np.concatenate(self._of_present(lambda part: part.observations))

    @property
    def dof(self) -> np.ndarray:
        return np.concatenate(self._of_present(lambda part: part.dof))

    @property
    def power(self) -> np.ndarray:
        return np.concatenate(self._of_present(lambda part: part.power))

    @property
    def nuisance_std(self) -> np.ndarray:
        """Those of a test's own kind; nuisance parameters of other kinds have the prior 1, and stay at 0."""
        return self.layout.joined_columns(self._each(lambda part: part.nuisance_std), 1.0, priors=True)

    @property
    def model_misfit(self) -> np.ndarray:
        return np.concatenate(self._of_present(lambda part: part.model_misfit))

    @property
    def noise_floor(self) -> float:
        weight = [float(part.observations.sum()) for part in self.present]
        floors = np.array([part.noise_floor for part in self.present])
        return float(np.sqrt(np.average(floors**2, weights=weight)))

    @property
    def known(self) -> dict[str, tuple[float, float]]:
        return {name: value for part in self.present for name, value in part.known.items()}

    @cached_property
    def units(self) -> NaturalUnits:
        """Natural units of the kind whose tests have the largest travel."""
        return max((part.units for part in self.present), key=lambda units: units.length)

    def nuisances(self, effects: Iterable[str], point: Point) -> tuple[NuisanceParameter, ...]:
        effects = tuple(effects)
        own = self._each(lambda part, its: part.nuisances(effects, its), self.points(point))
        full = [
            ((each or ()) + (UNUSED,) * size)[:size]
            for each, size in zip(own, self.layout.nuisances, strict=True)
        ]
        pairs = list(zip(full, self.layout.priors, strict=True))
        first = [one for each, size in pairs for one in each[:size]]
        rest = [one for each, size in pairs for one in each[size:]]
        while rest and rest[-1] is UNUSED:
            rest.pop()
        return (*first, *rest)

    def start(self) -> tuple[np.ndarray, MixedStart]:
        starts = [(None, None) if part is None else part.start() for part in self.parts]
        nuisance = self._joined([each[0] for each in starts])
        return nuisance, MixedStart(tuple(each[1] for each in starts), self.layout)

    def _joined(self, nuisances: Sequence[np.ndarray | None]) -> np.ndarray:
        """Nuisance parameters (t, N) of each kind as those of all tests; 0 where they are another kind's."""
        return self.layout.joined_columns(nuisances, 0.0)

    def points(self, point: Point) -> list[Any]:
        """The point of each kind, None without tests."""
        pairs = zip(self.layout.rows, self.layout.columns, point.warm.parts, strict=True)
        return [
            None if warm is None else Point(point.x, point.nuisance[rows][:, columns], warm)
            for rows, columns, warm in pairs
        ]

    def _whole(self, points: Sequence[Any]) -> Point:
        """The point of all tests from those of each kind."""
        x = next(each.x for each in points if each is not None)
        nuisance = self._joined([each and each.nuisance for each in points])
        return Point(x, nuisance, MixedStart(tuple(each and each.warm for each in points), self.layout))

    def evaluations(self, here: Evaluation) -> list[Any]:
        """The part of an evaluation of each kind, None without tests."""
        found: list[Evaluation | None] = []
        for i, (point, rows) in enumerate(zip(self.points(here.point), self.layout.rows, strict=True)):
            if point is None:
                found.append(None)
                continue
            size = self.layout.priors[i]
            prior = here.nuisance_prior[rows][:, self.layout.columns[i][:size]]
            found.append(
                Evaluation(
                    point,
                    here.response.parts[i],
                    here.residual[rows, : here.response.sizes[i]],
                    np.r_[prior.ravel(), here.uncertain_prior],
                    here.found_tests[rows],
                    size,
                )
            )
        return found

    def fits(self, fit: Fit) -> dict[str, Fit]:
        """A fit as that of each kind of test."""
        own = zip(self.parts, self.evaluations(fit.evaluation), strict=True)
        return {
            part.kind: replace(fit, model=fit.model.on(part), evaluation=each)
            for part, each in own
            if part is not None and each is not None
        }

    def subset(self, rows: np.ndarray) -> Self:
        own = self.layout.split(rows)
        parts = self._each(lambda part, its: part.subset(its) if its.size else None, own)
        return replace(self, parts=tuple(parts), layout=self.layout.subset(rows))

    def _scenarios(self, scenarios: Sequence[Scenario]) -> list[list[Scenario]]:
        """The scenarios of each kind."""
        points = [self.points(each.point) for each in scenarios]
        return [
            [Scenario(each.values, own[i]) for each, own in zip(scenarios, points, strict=True)]
            for i in range(len(self.parts))
        ]

    def compare(self, scenarios: Sequence[Scenario], tolerance: float) -> list[Comparison]:
        by_kind = self._each(lambda part, its: part.compare(its, tolerance), self._scenarios(scenarios))
        return [self._comparison([each and each[i] for each in by_kind]) for i in range(len(scenarios))]

    def _comparison(self, own: Sequence[Comparison | None]) -> Comparison:
        there = [each for each in own if each is not None]
        return Comparison(
            self._response(
                [each and each.response for each in own], [each and each.residual for each in own]
            ),
            self.layout.joined_rows([each.residual for each in there]),
            np.concatenate([each.found for each in there]),
            MixedStart(tuple(each and each.warm for each in own), self.layout),
        )

    @staticmethod
    def _response(responses: Sequence[Any], residuals: Sequence[np.ndarray | None]) -> MixedResponse:
        sizes = tuple(0 if each is None else each.shape[-1] for each in residuals)
        return MixedResponse(tuple(responses), sizes)

    def with_model_error(self, size: float) -> Self:
        return self._with(self._each(lambda part: part.with_model_error(size)))

    def compared_again(self, here: Evaluation) -> Evaluation:
        own = self._each(lambda part, its: part.compared_again(its), self.evaluations(here))
        response = self._response(
            [each and each.response for each in own], [each and each.residual for each in own]
        )
        residual = self.layout.joined_rows([each.residual for each in own if each is not None])
        return replace(here, response=response, residual=residual)

    def changes(
        self, here: Evaluation, scenarios: Sequence[Scenario], tolerance: float
    ) -> tuple[np.ndarray, np.ndarray]:
        own = zip(self.parts, self.evaluations(here), self._scenarios(scenarios), strict=True)
        done = [_changes(part, it, its, tolerance) for part, it, its in own if part is not None]
        change = self.layout.joined_rows([each[0] for each in done])
        return change, np.concatenate([each[1] for each in done], axis=1)

    def eliminated_derivatives(self, here: Evaluation) -> np.ndarray:
        own = self._each(lambda part, its: part.eliminated_derivatives(its), self.evaluations(here))
        padded = [
            np.moveaxis(np.pad(each, ((0, 0), (0, 0), (0, self.eliminated - each.shape[-1]))), -1, 0)
            for each in own
            if each is not None
        ]
        return np.moveaxis(self.layout.joined_rows(padded), 0, -1)

    def response_change(self, here: Evaluation, there: Evaluation) -> np.ndarray:
        both = self.evaluations(here), self.evaluations(there)
        own = self._each(lambda part, mine, its: part.response_change(mine, its), *both)
        return self.layout.joined_rows([each for each in own if each is not None])

    def bootstrap_sample(self, truth: Evaluation, rng: np.random.Generator) -> Self:
        own = self.evaluations(truth)
        return self._with(self._each(lambda part, its: part.bootstrap_sample(its, rng), own))

    def held_out_groups(self) -> list[tuple[str, np.ndarray]]:
        """The groups of each kind in turn: a model must predict tests of every kind."""
        found: list[tuple[str, np.ndarray]] = []
        for part, rows in zip(self.parts, self.layout.rows, strict=True):
            if part is not None:
                found += [(scheme, rows.start + own) for scheme, own in part.held_out_groups()]
        return found

    def candidates(self, effects: Sequence[str]) -> tuple[str, ...]:
        """Effects that any of the kinds can show."""
        shown = {name for part in self.present for name in part.candidates(effects)}
        return tuple(name for name in effects if name in shown)

    def with_undetected(self, effect: str) -> Self:
        return self._with(self._each(lambda part: part.with_undetected(effect)))

    def extra_nuisances(self, effects: Iterable[str]) -> np.ndarray:
        effects = tuple(effects)
        return np.concatenate(self._of_present(lambda part: part.extra_nuisances(effects)))

    def brings_nuisances(self, effect: str) -> bool:
        return any(part.brings_nuisances(effect) for part in self.present)

    @property
    def shares_nuisances(self) -> bool:
        return any(part.shares_nuisances for part in self.present)

    def other_nuisances(self, model: Evaluator, evaluation: Evaluation) -> np.ndarray | None:
        points = self.points(evaluation.point)
        own = self._each(
            lambda part, its: part.other_nuisances(model.on(part), its), self.evaluations(evaluation)
        )
        if all(each is None for each in own):
            return None
        moved = [
            point if nuisance is None else replace(point, nuisance=nuisance)
            for point, nuisance in zip(points, own, strict=True)
        ]
        return self._whole(moved).nuisance

    def gained_by_other_nuisances(self, evaluation: Evaluation) -> float:
        own = self._each(lambda part, its: part.gained_by_other_nuisances(its), self.evaluations(evaluation))
        return float(sum(each for each in own if each is not None))

    def aligned_to(self, evaluation: Evaluation) -> Self:
        return self._with(self._each(lambda part, its: part.aligned_to(its), self.evaluations(evaluation)))

    def renewed(self, scenario: Scenario) -> Self:
        own = [each[0] for each in self._scenarios([scenario])]
        return self._with(self._each(lambda part, its: part.renewed(its), own))

    def needs_alignment(self, effects: Iterable[str]) -> bool:
        effects = tuple(effects)
        return any(part.needs_alignment(effects) for part in self.present)

    def insensitive(self, evaluation: Evaluation) -> np.ndarray:
        own = self._each(lambda part, its: part.insensitive(its), self.evaluations(evaluation))
        return np.concatenate([each for each in own if each is not None])

    def never_steady(self, scenario: Scenario) -> np.ndarray:
        own = [each[0] for each in self._scenarios([scenario])]
        found = self._each(lambda part, its: part.never_steady(its), own)
        return np.concatenate([each for each in found if each is not None])

    def search_nuisances(self, model: Evaluator, points: Sequence[Point]) -> list[Evaluation]:
        by_point = [self.points(each) for each in points]
        for i, part in enumerate(self.parts):
            if part is None or np.isfinite(part.nuisance_std).all() or not len(points):
                continue
            own = part.search_nuisances(model.on(part), [each[i] for each in by_point])
            for each, found in zip(by_point, own, strict=True):
                each[i] = found.point
        return model.evaluate_all([self._whole(each) for each in by_point])

    def representative(self, evaluation: Evaluation) -> np.ndarray:
        own = self._each(lambda part, its: part.representative(its), self.evaluations(evaluation))
        pairs = zip(self.layout.rows, own, strict=True)
        return np.concatenate([rows.start + its for rows, its in pairs if its is not None])

    def held_as_stated(self) -> Self:
        return self._with(self._each(lambda part: part.held_as_stated()))

    def implausible(self, point: Point) -> bool:
        return any(self._each(lambda part, its: part.implausible(its), self.points(point)))

    def predicted_nuisances(self, evaluation: Evaluation, step: np.ndarray) -> np.ndarray:
        step = step.copy()
        own = zip(
            self.parts, self.evaluations(evaluation), self.layout.rows, self.layout.columns, strict=True
        )
        for part, its, rows, columns in own:
            if part is not None:
                fitted = columns[columns < step.shape[1]]
                step[rows, fitted] = part.predicted_nuisances(its, step[rows][:, fitted])
        return step


def _changes(
    part: FitData, here: Evaluation | None, scenarios: Sequence[Scenario], tolerance: float
) -> tuple[np.ndarray, np.ndarray]:
    """``FitData.changes`` of one kind; scenarios that differ in other kinds only are not simulated."""
    assert here is not None
    moved = [i for i, each in enumerate(scenarios) if not _same(here.point, each.point)]
    change = np.zeros((len(scenarios), *here.residual.shape))
    found = np.ones((len(scenarios), part.tests), bool)
    if moved:
        change[moved], found[moved] = part.changes(here, [scenarios[i] for i in moved], tolerance)
    return change, found


def _same(one: Point, other: Point) -> bool:
    return np.array_equal(one.x, other.x) and np.array_equal(one.nuisance, other.nuisance, equal_nan=True)
