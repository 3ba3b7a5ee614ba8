"""Parts of several kinds as data of one fit: each part compares its own tests, all share the parameters.

Tests of a part follow those of the part before. Nuisance parameters of each part have columns of their own,
as a step of one must not move another: first come those with a prior, part by part, then all others. A subset
keeps all columns, and only the parts that it has tests of.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import pairwise
from typing import Any, NamedTuple, Self, cast

import numpy as np

from wedgesweep.diagnose.evaluation import (
    UNUSED,
    Comparison,
    Evaluation,
    NuisanceParameter,
    Point,
    Scenario,
    WarmStart,
)
from wedgesweep.diagnose.fit_data import FitData, Motion
from wedgesweep.diagnose.model import Fit, Model
from wedgesweep.natural_units import NaturalUnits


class Layout(NamedTuple):
    """Number of ``tests`` of each part, and its nuisance parameters among all.

    ``columns``: columns of each part, the ones with a prior first (as many as its ``priors``);
    ``size``: numbers P and N of all parts.
    """

    tests: tuple[int, ...]
    columns: tuple[np.ndarray, ...]
    priors: tuple[int, ...]
    size: tuple[int, int]

    @classmethod
    def of(cls, parts: Sequence[FitData]) -> "Layout":
        priors = [part.nuisance_std.shape[1] for part in parts]
        others = [part.start()[0].shape[1] - prior for part, prior in zip(parts, priors, strict=True)]
        first, size = np.cumsum([0, *priors, *others]), len(parts)
        columns = [np.r_[first[i] : first[i + 1], first[size + i] : first[size + i + 1]] for i in range(size)]
        tests = tuple(part.tests for part in parts)
        return cls(
            tests, tuple(each.astype(int) for each in columns), tuple(priors), (first[size], first[-1])
        )

    @property
    def rows(self) -> list[slice]:
        """Tests of each part among all."""
        return [slice(first, last) for first, last in pairwise([0, *np.cumsum(self.tests).tolist()])]

    def subset(self, rows: Any) -> "tuple[Layout, dict[int, np.ndarray]]":
        """The layout of some tests, and which they are of each part that has any, by its place."""
        places = np.arange(sum(self.tests))[rows]
        split = [places[(places >= own.start) & (places < own.stop)] - own.start for own in self.rows]
        kept = {i: some for i, some in enumerate(split) if some.size}
        columns, priors = tuple(self.columns[i] for i in kept), tuple(self.priors[i] for i in kept)
        return Layout(tuple(each.size for each in kept.values()), columns, priors, self.size), kept

    def joined(self, nuisances: Sequence[np.ndarray], elsewhere: float, priors: bool = False) -> np.ndarray:
        """Nuisance parameters (t, N) of each part as (T, N) of all parts, ``elsewhere`` those of other parts.

        ``priors``: only those with a prior, P in place of N.
        """
        found = np.full((sum(self.tests), self.size[0 if priors else 1]), elsewhere)
        for rows, columns, values in zip(self.rows, self.columns, nuisances, strict=True):
            found[rows, columns[: values.shape[1]]] = values
        return found


class Starts(NamedTuple):
    """Warm starts of the parts."""

    parts: tuple[WarmStart, ...]
    layout: Layout

    def of(self, rows: Any) -> "Starts":
        layout, kept = self.layout.subset(rows)
        return Starts(tuple(self.parts[i].of(some) for i, some in kept.items()), layout)


class Responses(NamedTuple):
    """What was simulated of each part, and the number m of residuals of its tests."""

    parts: tuple[Any, ...]
    sizes: tuple[int, ...]


def _of_parts(name: str, combined: Callable[[list], Any]) -> Any:
    """A property of all parts, combined from that of each."""
    return property(lambda self: combined(self._each(name)))


def _by_parts(name: str, combined: Callable[[list], Any]) -> Any:
    """A method of all parts, its result combined from that of each."""
    return lambda self, *arguments: combined(self._each(name, *arguments))


def _renewing(name: str) -> Any:
    """A method that returns the data with the parts that it returns of each."""
    return lambda self, *arguments: self._with(self._each(name, *arguments))


def _joined(parts: Sequence[np.ndarray]) -> np.ndarray:
    """Values (..., t, m) of the parts as (..., T, m), with zeros at the end."""
    shape = sum(each.shape[-2] for each in parts), max(each.shape[-1] for each in parts)
    found, first = np.zeros((*parts[0].shape[:-2], *shape)), 0
    for each in parts:
        last = first + each.shape[-2]
        found[..., first:last, : each.shape[-1]] = each
        first = last
    return found


class Concatenation(FitData):
    """Tests of several parts."""

    kind = "mixed"
    observations = _of_parts("observations", np.concatenate)
    dof = _of_parts("dof", np.concatenate)
    power = _of_parts("power", np.concatenate)
    model_misfit = _of_parts("model_misfit", np.concatenate)
    input_gain_std = _of_parts("input_gain_std", max)
    recorded_forces = _of_parts("recorded_forces", lambda found: sum(found, ()))
    power_of = _by_parts("power_of", np.concatenate)
    response_change = _by_parts("response_change", _joined)
    extra_nuisances = _by_parts("extra_nuisances", np.concatenate)
    never_steady = _by_parts("never_steady", np.concatenate)
    needs_alignment = _by_parts("needs_alignment", any)
    implausible = _by_parts("implausible", any)
    with_model_error = _renewing("with_model_error")
    bootstrap_sample = _renewing("bootstrap_sample")
    with_undetected = _renewing("with_undetected")
    aligned_to = _renewing("aligned_to")
    beginning = _renewing("beginning")
    renewed = _renewing("renewed")
    held_as_stated = _renewing("held_as_stated")

    def __init__(self, parts: Sequence[FitData], layout: Layout | None = None) -> None:
        self._parts, self.layout = tuple(parts), layout or Layout.of(parts)
        self.model, self.law, self.uncertain = parts[0].model, parts[0].law, parts[0].uncertain
        self.model_error, self.names = parts[0].model_error, tuple(n for part in parts for n in part.names)
        self.eliminated = max(part.eliminated for part in parts)

    @property
    def parts(self) -> tuple[FitData, ...]:
        return self._parts

    def _each(self, name: str, *arguments: Any) -> list[Any]:
        """Results of a method, or values of a property, of the parts."""
        own = zip(*map(self._split, arguments), strict=True) if arguments else [()] * len(self.parts)
        found = [getattr(part, name) for part in self.parts]
        return [one(*each) if callable(one) else one for one, each in zip(found, own, strict=True)]

    def _split(self, argument: Any) -> Sequence[Any]:
        """An argument as the parts see it: those about tests are about their own."""
        match argument:
            case Evaluation():
                return self._evaluations(argument)
            case Fit():
                return self.fits(argument)
            case Point():
                return self._points(argument)
            case Scenario():
                return [own for (own,) in self._scenarios([argument])]
            case Responses():
                return argument.parts
        return [argument] * len(self.parts)

    def _with(self, parts: Sequence[FitData]) -> Self:
        same = all(one is other for one, other in zip(parts, self.parts, strict=True))
        return self if same else type(self)(parts, self.layout)

    @property
    def nuisance_std(self) -> np.ndarray:
        """Nuisance parameters of other parts have the prior 1, and stay at 0."""
        return self.layout.joined(self._each("nuisance_std"), 1.0, priors=True)

    @property
    def noise_floor(self) -> float:
        weight = [float(part.observations.sum()) for part in self.parts]
        return float(np.sqrt(np.average(np.square(self._each("noise_floor")), weights=weight)))

    @property
    def known(self) -> dict[str, tuple[float, float]]:
        return {name: value for part in self.parts for name, value in part.known.items()}

    @cached_property
    def units(self) -> NaturalUnits:
        """Natural units of the part whose tests have the largest travel."""
        return max(self._each("units"), key=lambda units: units.length)

    def nuisances(self, effects: Iterable[str]) -> tuple[NuisanceParameter, ...]:
        effects, found = tuple(effects), [UNUSED] * self.layout.size[1]
        for part, columns in zip(self.parts, self.layout.columns, strict=True):
            for column, nuisance in zip(columns, part.nuisances(effects), strict=False):
                found[column] = nuisance
        while len(found) > self.layout.size[0] and found[-1] is UNUSED:
            found.pop()
        return tuple(found)

    def start(self) -> tuple[np.ndarray, Starts]:
        nuisances, warm = zip(*self._each("start"), strict=True)
        return self.layout.joined(nuisances, 0.0), Starts(warm, self.layout)

    def _points(self, point: Point) -> list[Point]:
        """The point of each part."""
        own = zip(self.layout.rows, self.layout.columns, point.warm.parts, strict=True)
        return [Point(point.x, point.nuisance[rows][:, columns], warm) for rows, columns, warm in own]

    def _whole(self, points: Sequence[Point]) -> Point:
        """The point of all tests from those of the parts."""
        nuisance = self.layout.joined([each.nuisance for each in points], 0.0)
        return Point(points[0].x, nuisance, Starts(tuple(each.warm for each in points), self.layout))

    def _evaluations(self, here: Evaluation) -> list[Evaluation]:
        """An evaluation as evaluations of the parts."""
        responses, layout = here.response, self.layout
        points, sizes = self._points(here.point), responses.sizes
        own = zip(points, responses.parts, sizes, layout.columns, layout.priors, layout.rows, strict=True)
        return [
            replace(
                here,
                point=point,
                response=response,
                residual=here.residual[rows, :size],
                nuisance_prior=here.nuisance_prior[rows][:, columns[:priors]],
                found_tests=here.found_tests[rows],
            )
            for point, response, size, columns, priors, rows in own
        ]

    def _scenarios(self, scenarios: Sequence[Scenario]) -> list[list[Scenario]]:
        """The scenarios of each part."""
        points = [self._points(each.point) for each in scenarios]
        return [
            [Scenario(each.values, own[i]) for each, own in zip(scenarios, points, strict=True)]
            for i in range(len(self.parts))
        ]

    def fits(self, fit: Fit) -> list[Fit]:
        own = zip(self.parts, self._evaluations(fit.evaluation), strict=True)
        return [replace(fit, model=fit.model.on(part), evaluation=each) for part, each in own]

    def subset(self, rows: np.ndarray) -> Self:
        layout, kept = self.layout.subset(rows)
        return type(self)([self.parts[i].subset(some) for i, some in kept.items()], layout)

    def compare(self, scenarios: Sequence[Scenario], tolerance: float) -> list[Comparison]:
        own = zip(self.parts, self._scenarios(scenarios), strict=True)
        by_part = [part.compare(each, tolerance) for part, each in own]
        return [self._comparison(own) for own in zip(*by_part, strict=True)]

    def _comparison(self, own: Sequence[Comparison]) -> Comparison:
        responses, residuals, found, warm = zip(*own, strict=True)
        response = Responses(responses, tuple(each.shape[-1] for each in residuals))
        return Comparison(response, _joined(residuals), np.concatenate(found), Starts(warm, self.layout))

    def compared_again(self, here: Evaluation) -> Evaluation:
        own = self._each("compared_again", here)
        response = here.response._replace(parts=tuple(each.response for each in own))
        return replace(here, response=response, residual=_joined([each.residual for each in own]))

    def changes(
        self, here: Evaluation, scenarios: Sequence[Scenario], tolerance: float
    ) -> tuple[np.ndarray, np.ndarray]:
        own = zip(self.parts, self._evaluations(here), self._scenarios(scenarios), strict=True)
        changes, found = zip(*(_changes(*each, tolerance) for each in own), strict=True)
        return _joined(changes), np.concatenate(found, axis=1)

    def eliminated_derivatives(self, here: Evaluation) -> np.ndarray:
        own = self._each("eliminated_derivatives", here)
        size = self.eliminated
        padded = [np.pad(each, ((0, 0), (0, 0), (0, size - each.shape[-1]))) for each in own]
        return np.moveaxis(_joined([np.moveaxis(each, -1, 0) for each in padded]), 0, -1)

    def held_out_groups(self) -> list[tuple[str, np.ndarray]]:
        """The groups of each part in turn: a model must predict tests of every kind."""
        own = zip(self.layout.rows, self._each("held_out_groups"), strict=True)
        return [(scheme, rows.start + some) for rows, groups in own for scheme, some in groups]

    @property
    def tests_of_records(self) -> list[tuple[str, np.ndarray]]:
        own = zip(self.layout.rows, self.parts, strict=True)
        return [(name, rows.start + some) for rows, part in own for name, some in part.tests_of_records]

    def candidates(self, effects: Sequence[str]) -> tuple[str, ...]:
        """Effects that any of the parts can show."""
        shown = {name for own in self._each("candidates", effects) for name in own}
        return tuple(name for name in effects if name in shown)

    def search_nuisances(self, model: Model, points: Sequence[Point]) -> list[Evaluation]:
        by_point = [self._points(each) for each in points]
        for i, part in enumerate(self.parts):
            if points and not np.isfinite(part.nuisance_std).all():
                found = part.search_nuisances(model.on(part), [each[i] for each in by_point])
                for each, evaluation in zip(by_point, found, strict=True):
                    each[i] = evaluation.point
        return model.evaluate_all([self._whole(each) for each in by_point])

    def predicted_nuisances(self, evaluation: Evaluation, step: np.ndarray) -> np.ndarray:
        step, evaluations = step.copy(), self._evaluations(evaluation)
        for part, own, rows, columns in zip(
            self.parts, evaluations, self.layout.rows, self.layout.columns, strict=True
        ):
            fitted = columns[columns < step.shape[1]]
            step[rows, fitted] = part.predicted_nuisances(own, step[rows][:, fitted])
        return step

    def rows(self, base: Fit, extended: Fit) -> list[dict[str, Any]]:
        own = zip(self.parts, self._each("rows", base, extended), strict=True)
        return [{"kind": part.kind, **row} for part, rows in own for row in rows]

    def motion(self, fit: Fit) -> Motion | None:
        found = self._each("motion", fit)
        return None if None in found else Motion.joined(found)


def joined(parts: Sequence[Any]) -> FitData:
    """The data of one part, or of several."""
    if len(parts) == 1:
        return cast("FitData", parts[0])
    # Only steady tests have the gain of the input among the uncertain numbers; all parts have the same ones.
    uncertain = {name: std for part in parts for name, std in part.uncertain.items()}
    return Concatenation([replace(part, uncertain=uncertain) for part in parts])


def _changes(
    part: FitData, here: Evaluation, scenarios: Sequence[Scenario], tolerance: float
) -> tuple[np.ndarray, np.ndarray]:
    """``FitData.changes`` of one part; scenarios that differ in other parts only are not simulated."""
    moved = [i for i, each in enumerate(scenarios) if not _same(here.point, each.point)]
    change = np.zeros((len(scenarios), *here.residual.shape))
    found = np.ones((len(scenarios), part.tests), bool)
    if moved:
        change[moved], found[moved] = part.changes(here, [scenarios[i] for i in moved], tolerance)
    return change, found


def _same(one: Point, other: Point) -> bool:
    return np.array_equal(one.x, other.x) and np.array_equal(one.nuisance, other.nuisance)
