"""``FitData``, the interface through which a diagnosis sees measured tests; a part implements it.

A part holds the tests of one kind of record (steady harmonics, transients, loops). It defines how its tests
are simulated and compared with the measurement, their nuisance parameters, their noise, and what is reported
of them. Tests of several kinds are parts behind one another (``concatenation.py``). Everything else in this
package (least squares, score tests, search, verdict, cross-validation, result, next test) sees ``FitData``
only. A new kind is a subclass, and its name in ``diagnosis.DATA``; the methods with a body are optional.

Shapes: T tests, m numbers compared in each, N nuisance parameters of each, of which the first P have a prior
and the first L are fitted by simulation.
"""

from abc import abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol, Self

import numpy as np

from wedgesweep.config import Config
from wedgesweep.diagnose.evaluation import (
    Comparison,
    Evaluation,
    NuisanceParameter,
    Point,
    Scenario,
    WarmStart,
)
from wedgesweep.natural_units import BENCH, NaturalUnits

if TYPE_CHECKING:
    from wedgesweep.diagnose.model import Fit, Model
    from wedgesweep.diagnose.next_test.sensors import Sensors

# An uncertain number of the measurement, not of the model: the gain of the sensor that recorded all inputs.
INPUT_GAIN = "input_gain"


# Dimensions, values, unit and meaning of a variable of a dataset.
Variables = dict[str, tuple[tuple[str, ...], np.ndarray, str, str]]
BY_TEST, BY_MODEL = ("test",), ("model", "test")


class Arrays(NamedTuple):
    """Arrays of measured and simulated tests for figures and notebooks, with coordinates, in SI units."""

    variables: Variables
    coordinates: Mapping[str, Any]


class Motion(NamedTuple):
    """Samples (n,) of displacement (m) and velocity (m/s)."""

    displacement: np.ndarray
    velocity: np.ndarray

    @classmethod
    def joined(cls, parts: "Iterable[Motion]") -> "Motion":
        """All samples of several motions."""
        return cls(*(np.concatenate(each) for each in zip(*parts, strict=True)))


class FitData(Protocol):
    """T measured tests of one ``kind`` of record, or of several.

    ``model``: the base model with its friction ``law``; ``model_error``: relative error that it may have.
    ``eliminated``: number of nuisance parameters of each test whose best value has a closed form (start
    phase). ``known``: numbers that the records show directly, "effect.key" to value and standard deviation
    in key units. ``uncertain``: effects that scale parameters of the base model, and INPUT_GAIN, with their
    relative standard deviations.
    """

    kind: str
    model: Config
    law: str
    names: tuple[str, ...]
    model_error: float
    uncertain: dict[str, float]
    eliminated: int

    @property
    def input_gain_std(self) -> float:
        """Relative standard deviation of the gain of recorded inputs; 0 where it is exact, or none is."""
        return self.uncertain.get(INPUT_GAIN, 0.0)

    @property
    def tests(self) -> int:
        """Number of tests T."""
        return len(self.names)

    @property
    def parts(self) -> "tuple[FitData, ...]":
        """The tests of each kind."""
        return (self,)

    def fits(self, fit: "Fit") -> "list[Fit]":
        """A fit of all tests as fits of the parts."""
        return [fit]

    @property
    @abstractmethod
    def observations(self) -> np.ndarray:
        """Real numbers that each test contributes, (T,)."""

    @property
    def dof(self) -> np.ndarray:
        """Observations of each test less its nuisance parameters without a prior, (T,)."""
        return self.observations - self.eliminated - np.isinf(self.nuisance_std).sum(axis=1)

    @property
    @abstractmethod
    def power(self) -> np.ndarray:
        """Squared misfit of a simulation of nothing at all, (T,)."""

    @abstractmethod
    def power_of(self, response: Any) -> np.ndarray:
        """The same (T,) if a response had been measured."""

    @property
    @abstractmethod
    def nuisance_std(self) -> np.ndarray:
        """Prior standard deviation of the first P nuisance parameters (T, P): 0 exact, inf unknown."""

    @property
    @abstractmethod
    def model_misfit(self) -> np.ndarray:
        """Squared misfit (T,) that model errors of the allowed size would leave on average; 0 for none."""

    @property
    @abstractmethod
    def noise_floor(self) -> float:
        """Rms of the noise over that of the response."""

    @property
    def known(self) -> Mapping[str, tuple[float, float]]:
        return {}

    @property
    def units(self) -> NaturalUnits:
        """Natural units of the model on trial, in which effects are searched."""
        return BENCH

    @abstractmethod
    def nuisances(self, effects: Iterable[str]) -> tuple[NuisanceParameter, ...]:
        """The first L nuisance parameters: those that are fitted by simulation beside some effects."""

    @abstractmethod
    def start(self) -> tuple[np.ndarray, WarmStart]:
        """Nuisance parameters (T, N) as stated, and a start at rest."""

    @abstractmethod
    def subset(self, rows: np.ndarray) -> Self:
        """The same data with some of the tests."""

    def beginning(self, share: float) -> Self:
        """The first part of each test, a share of it; all of it where fits find their way without that."""
        return self

    @abstractmethod
    def compare(self, scenarios: Sequence[Scenario], tolerance: float) -> list[Comparison]:
        """Simulate scenarios and compare each with the measurement, eliminated nuisances at their best.

        What the simulations take is counted by ``work.add``, or no budget ends a search.
        """

    @abstractmethod
    def with_model_error(self, size: float) -> Self:
        """The data under a model that may be wrong by some relative ``size``.

        The variance of each compared number grows by that of an error of ``size`` times the rms of the
        response in its channel and test.
        """

    @abstractmethod
    def compared_again(self, here: Evaluation) -> Evaluation:
        """An evaluation of the same tests under another covariance, with the residuals of these data."""

    @abstractmethod
    def changes(
        self, here: Evaluation, scenarios: Sequence[Scenario], tolerance: float
    ) -> tuple[np.ndarray, np.ndarray]:
        """Changes of the residual (n, T, m) from an evaluation to n scenarios, and whether they exist (n, T).

        Eliminated nuisance parameters stay as they are in the evaluation.
        """

    @abstractmethod
    def eliminated_derivatives(self, here: Evaluation) -> np.ndarray:
        """Derivatives of the residual by the eliminated nuisance parameters, (T, m, eliminated)."""

    @abstractmethod
    def response_change(self, here: Evaluation, there: Evaluation) -> np.ndarray:
        """Whitened response there less that here, (T, m), with the eliminated nuisances of the latter."""

    @abstractmethod
    def bootstrap_sample(self, truth: Evaluation, rng: np.random.Generator) -> Self:
        """The data with a simulation and new noise in place of what was measured."""

    @abstractmethod
    def held_out_groups(self) -> list[tuple[str, np.ndarray]]:
        """Groups of tests to leave out in cross-validation: name of the scheme, and rows."""

    @property
    def tests_of_records(self) -> list[tuple[str, np.ndarray]]:
        """Name of each record, and rows of its tests, which may be windows or blocks of it."""
        return [(name, np.array([row])) for row, name in enumerate(self.names)]

    def candidates(self, effects: Sequence[str]) -> tuple[str, ...]:
        """Of some effects, those that the records can show at all."""
        return tuple(effects)

    def with_undetected(self, effect: str) -> Self:
        """The data as if one of the other effects had been looked for, and only noise been found."""
        raise NotImplementedError(effect)

    def extra_nuisances(self, effects: Iterable[str]) -> np.ndarray:
        """Number of nuisance parameters (T,) without a prior that these effects add to each test."""
        return np.zeros(self.tests, int)

    def aligned_to(self, evaluation: Evaluation) -> Self:
        """The data, with what an evaluation tells of the records' start (the phase of the input there)."""
        return self

    def renewed(self, scenario: Scenario) -> Self:
        """The data with the covariance that their residuals have in a scenario, if it differs there."""
        return self

    def needs_alignment(self, effects: Iterable[str]) -> bool:
        """Whether responses under these effects depend on what ``aligned_to`` tells of the records' start."""
        return False

    def never_steady(self, scenario: Scenario) -> np.ndarray:
        """Whether (T,) the response depends on how long the rig had run, which the records do not tell."""
        return np.zeros(self.tests, bool)

    def search_nuisances(self, model: "Model", points: Sequence[Point]) -> list[Evaluation]:
        """Evaluations of points, each test's nuisance parameters without a prior searched globally."""
        return model.evaluate_all(points)

    def held_as_stated(self) -> Self:
        """The data with narrow priors: nuisance parameters that have any stay as stated."""
        return self

    def implausible(self, point: Point) -> bool:
        """Whether nuisance parameters are so far from stated that they make up for a wrong model."""
        return False

    def predicted_nuisances(self, evaluation: Evaluation, step: np.ndarray) -> np.ndarray:
        """The step (T, L) of the nuisance parameters of a held-out test, which must remain a prediction."""
        return step

    def rows(self, base: "Fit", extended: "Fit") -> list[dict[str, Any]]:
        """Numbers of each test for diagnosis.json beside its name and misfit; units are part of the keys."""
        return [{}] * self.tests

    def arrays(self, base: "Fit", extended: "Fit") -> Arrays:
        """What is stored of the tests for figures and notebooks."""
        return Arrays({}, {})

    @property
    def method(self) -> dict[str, Any]:
        """Numbers of the comparison for diagnosis.json that all tests share."""
        return {}

    def cases(self, fit: "Fit") -> list[dict[str, float]]:
        """Frequency (``frequency_hz``) and input amplitude of each test as fitted, to run in a sweep."""
        return []

    def motion(self, fit: "Fit") -> Motion | None:
        """The measured motion of all tests as sensors show it; None where it was not recorded."""
        return None

    @property
    def recorded_forces(self) -> tuple[np.ndarray, ...]:
        """Forces (N) that were recorded, (n,) each."""
        return ()

    @property
    def offers(self) -> tuple[str, ...]:
        """Next tests that are like these, by their names in ``next_test.recommend.DESIGNS``."""
        return ()

    def sensors(self) -> "Sensors | None":
        """The sensors of these tests; None if they tell nothing of tests to come."""
        return None
