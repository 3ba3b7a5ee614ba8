"""Hysteresis loops as data of a fit.

A test is a block of whole cycles of a record, so that blocks can be left out of a fit. What is compared are
forces; each block has an unknown zero of the force, eliminated in closed form.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple, Self

import numpy as np

from wedgesweep.config import Config
from wedgesweep.diagnose import work
from wedgesweep.diagnose.fit_data import Comparison, Evaluation, FitData, NuisanceParameter, Point, Scenario
from wedgesweep.diagnose.loop.recording import Recording
from wedgesweep.natural_units import NaturalUnits

# Effects that act by how a motion comes about, or on sensors of it.
OF_MOTION = (
    *("input_distortion", "stray_vibration", "fixture_resonance", "column_compliance"),
    *("displacement_gain", "velocity_lag"),
)
# Samples whose forces are as much work as a simulated period; see work.py.
SAMPLES_PER_PERIOD = 400.0


class NoStart(NamedTuple):
    """Forces along a motion do not depend on where a simulation starts."""

    def of(self, rows: Any) -> "NoStart":
        return self

    def where(self, chosen: np.ndarray, other: Any) -> "NoStart":
        return self


@dataclass(frozen=True, eq=False)
class LoopData(FitData):
    """T blocks of recordings.

    ``chosen``: number of the recording and of its block for each test. Arrays (T, m) are as long as the
    longest block; a block that is shorter has samples of no weight.
    """

    recordings: tuple[Recording, ...]
    chosen: tuple[tuple[int, int], ...]
    uncertain: dict[str, float]
    model_error: float = 0.0
    resampled: np.ndarray | None = None

    kind = "loop"
    eliminated = 1

    @cached_property
    def names(self) -> tuple[str, ...]:  # type: ignore[override]
        return tuple(self._name(*each) for each in self.chosen)

    def _name(self, number: int, block: int) -> str:
        own = self.recordings[number]
        return own.name if len(own.blocks) == 1 else f"{own.name} {block + 1}"

    @property
    def model(self) -> Config:  # type: ignore[override]
        """The base model, with the numbers of the first test."""
        return self.recordings[0].model

    @property
    def law(self) -> str:  # type: ignore[override]
        return self.recordings[0].law

    @property
    def tests(self) -> int:
        return len(self.chosen)

    def padded(self, values: Sequence[np.ndarray], fill: float = 0.0) -> np.ndarray:
        """Values (..., k) of each recording as blocks (..., T, m)."""
        parts = [values[number][..., self.recordings[number].blocks[block]] for number, block in self.chosen]
        found = np.full((*parts[0].shape[:-1], self.tests, self._longest), fill)
        for t, part in enumerate(parts):
            found[..., t, : part.shape[-1]] = part
        return found

    @cached_property
    def _longest(self) -> int:
        spans = [self.recordings[number].blocks[block] for number, block in self.chosen]
        return max(span.stop - span.start for span in spans)

    @cached_property
    def weight(self) -> np.ndarray:
        """One where a force is compared, else 0, (T, m)."""
        return self.padded([own.known.astype(float) for own in self.recordings])

    @cached_property
    def measured(self) -> np.ndarray:
        """Measured forces (T, m) in N."""
        if self.resampled is not None:
            return self.resampled
        return self.padded([own.force for own in self.recordings])

    @cached_property
    def noise(self) -> np.ndarray:
        """Standard deviation of the noise (T,) in N."""
        return np.array([self.recordings[number].noise for number, _ in self.chosen])

    @cached_property
    def spread(self) -> np.ndarray:
        """Rms of the measured force about its mean, (T,) in N."""
        return np.sqrt((self._centred(self.measured) ** 2).sum(-1) / self.weight.sum(-1))

    @cached_property
    def std(self) -> np.ndarray:
        """Standard deviation of noise and allowed model error together, (T,) in N."""
        return np.hypot(self.noise, self.model_error * self.spread)

    @property
    def observations(self) -> np.ndarray:
        return self.weight.sum(-1).astype(int)

    @property
    def dof(self) -> np.ndarray:
        return self.observations - 1

    @property
    def power(self) -> np.ndarray:
        return self.observations * (self.spread / self.std) ** 2

    @property
    def nuisance_std(self) -> np.ndarray:
        return np.zeros((self.tests, 0))

    @property
    def model_misfit(self) -> np.ndarray:
        return self.dof * (self.model_error * self.spread / self.std) ** 2

    @property
    def noise_floor(self) -> float:
        return float(np.sqrt((self.noise**2).mean() / (self.spread**2).mean()))

    @cached_property
    def units(self) -> NaturalUnits:
        """Natural units of the model under the largest motion."""
        motions = [own.motion for own in self.recordings]
        travel = max(0.5 * float(np.ptp(each.displacement)) for each in motions)
        speed = max(float(np.abs(each.velocity).max()) for each in motions)
        return self.model.natural_units(travel, speed / travel)

    def nuisances(self, effects: Iterable[str], point: Point) -> tuple[NuisanceParameter, ...]:
        return ()

    def start(self) -> tuple[np.ndarray, NoStart]:
        return np.zeros((self.tests, 0)), NoStart()

    def subset(self, rows: np.ndarray) -> Self:
        chosen = tuple(self.chosen[row] for row in np.arange(self.tests)[rows])
        part = replace(self, chosen=chosen, resampled=None)
        if self.resampled is None:
            return part
        return replace(part, resampled=self.resampled[rows][:, : part._longest])

    def candidates(self, effects: Sequence[str]) -> tuple[str, ...]:
        return tuple(name for name in effects if name not in OF_MOTION)

    def with_undetected(self, effect: str) -> Self:
        """Effects of how a motion comes about change no force along it."""
        return self

    def simulated(self, scenarios: Sequence[Scenario]) -> np.ndarray:
        """Forces (n, T, m) in N; NaN where they are not determined."""
        if not scenarios:
            return np.zeros((0, *self.weight.shape))
        values = [
            {name: numbers for name, numbers in each.values.items() if name not in OF_MOTION}
            for each in scenarios
        ]
        needed = {number for number, _ in self.chosen}
        work.add(
            len(values) * sum(self.recordings[i].motion.velocity.size for i in needed) / SAMPLES_PER_PERIOD
        )
        nothing = np.zeros((len(values), 0))
        forces = [own.simulated(values) if i in needed else nothing for i, own in enumerate(self.recordings)]
        return self.padded(forces)

    def _centred(self, values: np.ndarray) -> np.ndarray:
        """Values (..., T, m) less their mean over what is compared, 0 elsewhere."""
        mean = (values * self.weight).sum(-1, keepdims=True) / self.weight.sum(-1, keepdims=True)
        return (values - mean) * self.weight

    def _whitened(self, values: np.ndarray) -> np.ndarray:
        """Forces (..., T, m) over their noise."""
        return values * self.weight / self.std[:, None]

    def compare(self, scenarios: Sequence[Scenario], tolerance: float) -> list[Comparison]:
        simulated = self.simulated(scenarios)
        found = np.asarray(np.isfinite(np.where(self.weight > 0.0, simulated, 0.0)).all(axis=-1))
        simulated = np.nan_to_num(simulated)
        residual = self._whitened(self._centred(self.measured - simulated))
        return [
            Comparison(response, left, there, NoStart())
            for response, left, there in zip(simulated, residual, found, strict=True)
        ]

    def with_zero(self, here: Evaluation) -> np.ndarray:
        """Simulated forces (T, m) in N, with the zero of each block's measured force."""
        zero = ((self.measured - here.response) * self.weight).sum(-1) / self.weight.sum(-1)
        return here.response + zero[:, None]

    def error(self, here: Evaluation) -> np.ndarray:
        """Rms of what an evaluation leaves over that of the measured force, (T,)."""
        left = (self._centred(self.measured - here.response) ** 2).sum(-1) / self.weight.sum(-1)
        return np.sqrt(left) / self.spread

    def with_model_error(self, size: float) -> Self:
        return replace(self, model_error=size)

    def compared_again(self, here: Evaluation) -> Evaluation:
        return replace(here, residual=self._whitened(self._centred(self.measured - here.response)))

    def changes(
        self, here: Evaluation, scenarios: Sequence[Scenario], tolerance: float
    ) -> tuple[np.ndarray, np.ndarray]:
        simulated = self.simulated(scenarios)
        found = np.asarray(np.isfinite(np.where(self.weight > 0.0, simulated, 0.0)).all(axis=-1))
        return self._whitened(here.response - np.nan_to_num(simulated)), found

    def eliminated_derivatives(self, here: Evaluation) -> np.ndarray:
        """Derivative of the residual by the zero of the force, (T, m, 1)."""
        return -self._whitened(np.ones_like(self.weight))[..., None]

    def response_change(self, here: Evaluation, there: Evaluation) -> np.ndarray:
        return self._whitened(there.response - here.response)

    def bootstrap_sample(self, truth: Evaluation, rng: np.random.Generator) -> Self:
        noise = rng.standard_normal(self.weight.shape) * self.std[:, None]
        return replace(self, resampled=truth.response + noise)

    def held_out_groups(self) -> list[tuple[str, np.ndarray]]:
        """Each recording, or each block where there is only one."""
        numbers = np.array([number for number, _ in self.chosen])
        if np.ptp(numbers) == 0:
            return [("block", np.array([t])) for t in range(self.tests)]
        return [("record", np.flatnonzero(numbers == number)) for number in np.unique(numbers)]
