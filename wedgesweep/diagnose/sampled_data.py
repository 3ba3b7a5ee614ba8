"""Tests that are compared in time or along an imposed motion; a long record is cut into several of them."""

from abc import abstractmethod
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any, NamedTuple, Self

import numpy as np

from wedgesweep.diagnose.evaluation import (
    Comparison,
    Evaluation,
    NoStart,
    Point,
    Scenario,
    best_evaluation_per_test,
)
from wedgesweep.diagnose.fit_data import INPUT_GAIN, Arrays, FitData
from wedgesweep.diagnose.model import Fit

# Largest number of samples that are decorrelated together; samples of different blocks count as independent.
LARGEST_BLOCK = 400


class Decorrelation(NamedTuple):
    """Orthogonal combinations of samples: ``matrix`` (k, k), and the standard deviation (k,) of each."""

    matrix: np.ndarray
    std: np.ndarray


def decorrelation(
    known: np.ndarray, covariance: Callable[[np.ndarray], np.ndarray], least: float
) -> Decorrelation:
    """Combinations with independent noise of the samples that are ``known`` (k,), in their places.

    Rows of the matrix and standard deviations are zero where a sample is not known.

    Parameters
    ----------
    known : ndarray of bool, shape (k,)
        Which samples are compared.
    covariance : callable
        Covariance matrix (r, r) of the samples in some rows (r,).
    least : float
        Least variance of a combination.
    """
    matrix, std = np.zeros((known.size, known.size)), np.zeros(known.size)
    rows = np.flatnonzero(known)
    for part in np.array_split(rows, max(-(-rows.size // LARGEST_BLOCK), 1)):
        variance, vectors = np.linalg.eigh(covariance(part))
        std[part] = np.sqrt(np.maximum(variance, least))
        matrix[np.ix_(part, part)] = vectors.T
    return Decorrelation(matrix, std)


# Blocks of a record that are left out in turn, at most.
MOST_BLOCKS = 12


class SampledData(FitData):
    """T tests of at most m samples, which may be of several channels.

    Each test has an unknown zero of its sensor, eliminated in closed form. A subclass is a dataclass with the
    attributes ``model_error`` and ``resampled`` (T, m), measured values of a bootstrap or None.
    """

    resampled: np.ndarray | None
    eliminated = 1

    @property
    @abstractmethod
    def recorded(self) -> np.ndarray:
        """Measured values, (T, m)."""

    @property
    @abstractmethod
    def numbers(self) -> np.ndarray:
        """Number (T,) of the record that each test is a part of."""

    @property
    @abstractmethod
    def independent_noise(self) -> np.ndarray:
        """Standard deviation (T, m) of values with independent noise; 0 where nothing is compared."""

    @abstractmethod
    def combinations(self) -> Iterator[tuple[int, slice, Decorrelation]]:
        """Test, some of its values, and their decorrelation, wherever noise is correlated."""

    @abstractmethod
    def chosen_tests(self, rows: np.ndarray) -> Self:
        """The recorded data of some of the tests."""

    @property
    @abstractmethod
    def size(self) -> np.ndarray:
        """Rms (T, m) of the response, in the channel that each value belongs to."""

    @property
    @abstractmethod
    def shifted(self) -> np.ndarray:
        """What a unit of the zero of the sensor adds to each value, (T, m)."""

    @abstractmethod
    def simulated(self, scenarios: Sequence[Scenario]) -> np.ndarray:
        """Values (n, T, m) of scenarios; NaN where they are not determined."""

    @cached_property
    def measured(self) -> np.ndarray:
        """Values (T, m) to which a model is fitted: recorded, or of a bootstrap sample."""
        return self.recorded if self.resampled is None else self.resampled

    @cached_property
    def noise(self) -> np.ndarray:
        """Standard deviation (T, m) of decorrelated values; 0 where nothing is compared."""
        noise = self.independent_noise
        for t, part, each in self.combinations():
            noise[t, part] = each.std
        return noise

    @cached_property
    def weight(self) -> np.ndarray:
        """1 where something is compared, else 0, (T, m)."""
        return (self.noise > 0.0).astype(float)

    @cached_property
    def std(self) -> np.ndarray:
        """Standard deviation of noise and allowed model error together, (T, m); 1 elsewhere."""
        return np.where(self.weight > 0.0, np.hypot(self.noise, self.model_error * self.size), 1.0)

    def subset(self, rows: np.ndarray) -> Self:
        part = self.chosen_tests(np.arange(self.tests)[rows])
        if self.resampled is None:
            return part
        resampled = self.resampled[rows][:, : part.recorded.shape[1]]
        return replace(part, resampled=resampled)  # type: ignore[type-var]

    def held_out_groups(self) -> list[tuple[str, np.ndarray]]:
        """Each record; of a single record blocks of successive tests."""
        if np.ptp(self.numbers) > 0:
            return [("record", np.flatnonzero(self.numbers == each)) for each in np.unique(self.numbers)]
        blocks = np.array_split(np.arange(self.tests), min(self.tests, MOST_BLOCKS))
        return [("block", rows) for rows in blocks]

    @property
    def tests_of_records(self) -> list[tuple[str, np.ndarray]]:
        rows = [np.flatnonzero(self.numbers == each) for each in np.unique(self.numbers)]
        return [(self.names[own[0]].removesuffix(" 1"), own) for own in rows]

    @property
    def observations(self) -> np.ndarray:
        return self.weight.sum(-1).astype(int)

    @property
    def power(self) -> np.ndarray:
        return self.power_of(self.measured)

    def power_of(self, response: np.ndarray) -> np.ndarray:
        return (self._whitened(self.without_zero(response)) ** 2).sum(-1)

    @property
    def model_misfit(self) -> np.ndarray:
        return (self.weight * (self.model_error * self.size / self.std) ** 2).sum(-1)

    @property
    def noise_floor(self) -> float:
        compared = self.weight > 0.0
        return float(np.sqrt(np.mean((self.noise[compared] / self.size[compared]) ** 2)))

    def decorrelated(self, values: np.ndarray) -> np.ndarray:
        """Orthogonal combinations of values (..., T, m) whose noise is independent."""
        found = values.copy()
        for t, part, each in self.combinations():
            found[..., t, part] = values[..., t, part] @ each.matrix.T
        return found

    def correlated(self, values: np.ndarray) -> np.ndarray:
        """What ``decorrelated`` turns into values (..., T, m)."""
        found = values.copy()
        for t, part, each in self.combinations():
            found[..., t, part] = values[..., t, part] @ each.matrix
        return found

    def zero(self, values: np.ndarray) -> np.ndarray:
        """Zero of the sensor (..., T, 1) that fits values (..., T, m) best, measured less simulated ones.

        It is 0 where nothing is compared.
        """
        left, unit = self._whitened(values), self._whitened(self.shifted)
        size = (unit**2).sum(-1, keepdims=True)
        return (left * unit).sum(-1, keepdims=True) / np.where(size > 0.0, size, 1.0)

    def without_zero(self, values: np.ndarray) -> np.ndarray:
        """Values (..., T, m) less their best zero."""
        return values - self.zero(values) * self.shifted

    def with_zero(self, here: Evaluation) -> np.ndarray:
        """Simulated values (T, m) with the zero of the sensor."""
        return here.response + self.zero(self.measured - here.response) * self.shifted

    def error(self, here: Evaluation) -> np.ndarray:
        """Rms of the residual of an evaluation over that of the response, (T,)."""
        left = self.without_zero(self.measured - here.response) / np.where(self.size > 0.0, self.size, 1.0)
        return np.sqrt((self.weight * left**2).sum(-1) / self.weight.sum(-1))

    def _whitened(self, values: np.ndarray) -> np.ndarray:
        """Independent combinations of values (..., T, m) over their standard deviation.

        They are 0 where nothing is compared.
        """
        return self.decorrelated(values) * self.weight / self.std

    def _simulated(self, scenarios: Sequence[Scenario]) -> tuple[np.ndarray, np.ndarray]:
        """Simulated values (n, T, m), and whether they exist, (n, T)."""
        if not scenarios:
            return np.zeros((0, *self.weight.shape)), np.zeros((0, self.tests), bool)
        values = self.simulated(scenarios)
        found = np.isfinite(np.where(self.weight > 0.0, values, 0.0)).all(axis=-1)
        return np.nan_to_num(values), np.asarray(found)

    def compare(self, scenarios: Sequence[Scenario], tolerance: float) -> list[Comparison]:
        simulated, found = self._simulated(scenarios)
        residual = self._whitened(self.without_zero(self.measured - simulated))
        return [
            Comparison(response, left, there, NoStart())
            for response, left, there in zip(simulated, residual, found, strict=True)
        ]

    def compared_again(self, here: Evaluation) -> Evaluation:
        return replace(here, residual=self._whitened(self.without_zero(self.measured - here.response)))

    def with_model_error(self, size: float) -> Self:
        return replace(self, model_error=size)  # type: ignore[type-var]

    def changes(
        self, here: Evaluation, scenarios: Sequence[Scenario], tolerance: float
    ) -> tuple[np.ndarray, np.ndarray]:
        simulated, found = self._simulated(scenarios)
        return self._whitened(here.response - simulated), found

    def eliminated_derivatives(self, here: Evaluation) -> np.ndarray:
        """Derivative of the residual by the zero of the sensor, (T, m, 1)."""
        return -self._whitened(self.shifted)[..., None]

    def response_change(self, here: Evaluation, there: Evaluation) -> np.ndarray:
        return self._whitened(there.response - here.response)

    def bootstrap_sample(self, truth: Evaluation, rng: np.random.Generator) -> Self:
        noise = rng.standard_normal(self.weight.shape) * self.std
        return replace(self, resampled=truth.response + self.correlated(noise))  # type: ignore[type-var]

    def with_undetected(self, effect: str) -> Self:
        """The same data: what is simulated does not depend on effects that are no candidates."""
        return self

    def known_values(self, scenarios: Sequence[Scenario], left_out: Iterable[str]) -> list[dict[str, Any]]:
        """Values of effects in each scenario, without those that this kind of record cannot show."""
        left_out = (*left_out, INPUT_GAIN)
        return [
            {name: numbers for name, numbers in each.values.items() if name not in left_out}
            for each in scenarios
        ]

    def described(self, point: Point) -> list[dict[str, Any]]:
        """Numbers of each test for diagnosis.json, at a point of the extended model."""
        return [{}] * self.tests

    def shown(self, simulated: np.ndarray) -> Arrays:
        """What is stored of the tests, with values (2, T, m) that were simulated."""
        return Arrays({}, {})

    def rows(self, base: Fit, extended: Fit) -> list[dict[str, Any]]:
        """Numbers of the tests; errors are the rms of the residual over that of the response."""
        errors = zip(*(self.error(fit.evaluation) for fit in (base, extended)), strict=True)
        own = zip(self.described(extended.point), self.observations, errors, strict=True)
        return [
            {**described, "samples": int(samples), "error_base": before, "error_extended": after}
            for described, samples, (before, after) in own
        ]

    def arrays(self, base: Fit, extended: Fit) -> Arrays:
        return self.shown(np.array([self.with_zero(fit.evaluation) for fit in (base, extended)]))


def padded(parts: Sequence[np.ndarray]) -> np.ndarray:
    """Values (..., k) of each test as (..., T, m), with zeros at the end."""
    found = np.zeros((*parts[0].shape[:-1], len(parts), max(part.shape[-1] for part in parts)))
    for t, part in enumerate(parts):
        found[..., t, : part.shape[-1]] = part
    return found


def best_of_each_test(evaluations: Sequence[Evaluation]) -> Evaluation:
    """Of evaluations with the same parameters x one in which each test is as it fits best."""
    first, best = evaluations[0], best_evaluation_per_test(evaluations)

    def chosen(values: Sequence[np.ndarray]) -> np.ndarray:
        return np.array(values)[best, np.arange(best.size)]

    return replace(
        first,
        point=replace(first.point, nuisance=chosen([each.point.nuisance for each in evaluations])),
        response=chosen([each.response for each in evaluations]),
        residual=chosen([each.residual for each in evaluations]),
        nuisance_prior=chosen([each.nuisance_prior for each in evaluations]),
        found_tests=chosen([each.found_tests for each in evaluations]),
    )
