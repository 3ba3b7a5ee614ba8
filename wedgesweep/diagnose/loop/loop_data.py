"""Hysteresis loops as data of a fit.

A test is a block of whole cycles of a record, so that blocks can be left out of a fit. What is compared are
forces; each block has an unknown zero of the force, and an oscillator's one of the displacement: play and
springs that are not linear act by their place. A wedge's displacement counts from rest, as its friction does.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Self

import numpy as np

from wedgesweep.config import Config
from wedgesweep.diagnose import work
from wedgesweep.diagnose.evaluation import NoStart, NuisanceParameter, Point, Scenario
from wedgesweep.diagnose.fit_data import BY_TEST, Arrays, Motion
from wedgesweep.diagnose.loop.recording import Recording, recording
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.next_test.sensors import Sensors, median_test
from wedgesweep.diagnose.noise_spectrum import NoiseSpectrum, repeat_differences, repeat_groups
from wedgesweep.diagnose.sampled_data import Decorrelation, SampledData, padded
from wedgesweep.errors import InputError
from wedgesweep.measured import Measurement, TestRecord
from wedgesweep.measured.declarations import LOOP
from wedgesweep.natural_units import NaturalUnits

# Effects on how a motion comes about, or on its sensors: where the motion is imposed, no force shows them.
OF_MOTION = (
    *("input_distortion", "stray_vibration", "fixture_resonance", "column_compliance"),
    *("displacement_gain", "velocity_lag", "input_gain", "cross_slip", "lift_off"),
)
# Zero of the displacement over half the range of the motion, and its standard deviation.
ZERO, ZERO_STD = NuisanceParameter(step=1e-3, max_step=0.1), 0.3
# Samples whose forces are as much work as a simulated period; see work.py.
SAMPLES_PER_PERIOD = 400.0


@dataclass(frozen=True, eq=False)
class LoopData(SampledData):
    """T blocks of recordings.

    ``chosen``: number of the recording and of its block for each test. Arrays (T, m) are as long as the
    longest block.
    """

    recordings: tuple[Recording, ...]
    chosen: tuple[tuple[int, int], ...]
    uncertain: dict[str, float]
    model_error: float = 0.0
    resampled: np.ndarray | None = None

    kind = LOOP
    offers = (LOOP,)

    @cached_property
    def names(self) -> tuple[str, ...]:  # type: ignore[override]
        return tuple(self._name(*each) for each in self.chosen)

    def _name(self, number: int, block: int) -> str:
        own = self.recordings[number]
        return own.name if len(own.blocks) == 1 else f"{own.name} {block + 1}"

    @property
    def numbers(self) -> np.ndarray:
        return np.array([number for number, _ in self.chosen])

    @property
    def model(self) -> Config:  # type: ignore[override]
        """The base model, with the numbers of the first test."""
        return self.recordings[0].model

    @property
    def law(self) -> str:  # type: ignore[override]
        return self.recordings[0].law

    def combinations(self) -> Iterator[tuple[int, slice, Decorrelation]]:
        for t, (number, block) in enumerate(self.chosen):
            each = self.recordings[number].decorrelated[block]
            yield t, slice(0, each.std.size), each

    @property
    def independent_noise(self) -> np.ndarray:
        return np.zeros_like(self.recorded)

    def chosen_tests(self, rows: np.ndarray) -> Self:
        return replace(self, chosen=tuple(self.chosen[row] for row in rows), resampled=None)

    def renewed(self, scenario: Scenario) -> Self:
        """The data with the noise of the motion as the force in a scenario passes it on."""
        (values,), zeros = self.known_values([scenario], OF_MOTION), self._zeros([scenario])
        needed = {number for number, _ in self.chosen}
        found = tuple(
            own.renewed(values, zeros[i][0]) if i in needed else own for i, own in enumerate(self.recordings)
        )
        return replace(self, recordings=found)

    def padded(self, values: Sequence[np.ndarray]) -> np.ndarray:
        """Values (..., k) of each recording as blocks (..., T, m), zeros after the end of a block."""
        return padded(
            [values[number][..., self.recordings[number].blocks[block]] for number, block in self.chosen]
        )

    @cached_property
    def recorded(self) -> np.ndarray:
        return np.where(self.seen, self.padded([own.force for own in self.recordings]), 0.0)

    @cached_property
    def size(self) -> np.ndarray:
        """Rms (T, m) of the measured force of a block about its mean, in N; 0 if the mass rests all along."""
        count = np.maximum(self.seen.sum(axis=-1, keepdims=True), 1)
        about = self.seen * (self.recorded - self.recorded.sum(axis=-1, keepdims=True) / count)
        rms = np.sqrt((about**2).sum(axis=-1, keepdims=True) / count)
        return np.broadcast_to(rms, self.seen.shape)

    @cached_property
    def seen(self) -> np.ndarray:
        """Whether a sample (T, m) of each block is compared."""
        return self.padded([own.known.astype(float) for own in self.recordings]) > 0.5

    @cached_property
    def shifted(self) -> np.ndarray:
        return self.seen.astype(float)

    @property
    def _zeros_are_free(self) -> bool:
        """Whether the zero of the displacement is unknown."""
        return self.model.system == "oscillator"

    @property
    def nuisance_std(self) -> np.ndarray:
        return np.full((self.tests, int(self._zeros_are_free)), ZERO_STD)

    @cached_property
    def units(self) -> NaturalUnits:
        """Natural units: travel, time and force of the largest loops; no mass need matter in them.

        A wedge has those of its suspension.
        """
        motions = [own.motion for own in self.recordings]
        travel = max(0.5 * float(np.ptp(each.displacement)) for each in motions)
        time = travel / max(float(np.abs(each.velocity).max()) for each in motions)
        if self.model.system != "oscillator":
            return self.model.natural_units(travel, 1.0 / time)
        force = max(float(own.force.std()) for own in self.recordings)
        return NaturalUnits(force * time**2 / travel, travel, time)

    def nuisances(self, effects: Iterable[str]) -> tuple[NuisanceParameter, ...]:
        return (ZERO,) if self._zeros_are_free else ()

    def start(self) -> tuple[np.ndarray, NoStart]:
        return np.zeros((self.tests, int(self._zeros_are_free))), NoStart()

    def candidates(self, effects: Sequence[str]) -> tuple[str, ...]:
        return tuple(name for name in effects if name not in OF_MOTION)

    def simulated(self, scenarios: Sequence[Scenario]) -> np.ndarray:
        values = self.known_values(scenarios, OF_MOTION)
        needed = {number for number, _ in self.chosen}
        samples = sum(self.recordings[number].motion.velocity.size for number in needed)
        work.add(len(values) * samples / SAMPLES_PER_PERIOD)
        nothing, zeros = np.zeros((len(values), 0)), self._zeros(scenarios)
        forces = [
            own.simulated(values, zeros[i]) if i in needed else nothing
            for i, own in enumerate(self.recordings)
        ]
        return self.padded(forces)

    def _zeros(self, scenarios: Sequence[Scenario]) -> list[np.ndarray]:
        """What to add to the displacement (m) in each block of each recording, (n, blocks) each."""
        found = [np.zeros((len(scenarios), len(own.blocks))) for own in self.recordings]
        if self._zeros_are_free:
            for t, (number, block) in enumerate(self.chosen):
                size = self.recordings[number].half_range
                found[number][:, block] = [size * each.point.nuisance[t, 0] for each in scenarios]
        return found

    def described(self, point: Point) -> list[dict[str, Any]]:
        recordings = [self.recordings[number] for number, _ in self.chosen]
        return [
            {
                "lowpass_hz": own.low_pass.cutoff,
                "noise_force_N": own.noise_as_stated,
                "noise_force_fitted_N": own.noise,
                "noise_from": own.spectrum.source,
                "noise_correlation": own.spectrum.correlation,
                "noise_velocity_mm_per_s": 1e3 * own.motion.noise[1],
            }
            for own in recordings
        ]

    def shown(self, simulated: np.ndarray) -> Arrays:
        """Forces along the imposed motion, NaN where nothing is compared."""
        seen = np.where(self.seen, 1.0, np.nan)
        position, velocity = (
            self.padded([getattr(own.motion, name)[own.places] for own in self.recordings]) * seen
            for name in ("displacement", "velocity")
        )
        noise = np.array([self.recordings[number].noise for number, _ in self.chosen])
        by_sample, meaning = ("test", "sample"), "simulated, with the fitted zero"
        variables = {
            "displacement": (by_sample, position, "m", "imposed displacement"),
            "velocity": (by_sample, velocity, "m/s", "imposed velocity"),
            "measured_force": (by_sample, self.measured * seen, "N", "measured force"),
            "simulated_force": (("model", *by_sample), simulated * seen, "N", meaning),
            "force_noise": (BY_TEST, noise, "N", "noise of a compared force"),
        }
        return Arrays(variables, {})

    def motion(self, fit: Fit) -> Motion:
        moved = (self.recordings[number].motion for number in np.unique(self.numbers))
        return Motion.joined(Motion(each.displacement, each.velocity) for each in moved)

    @property
    def recorded_forces(self) -> tuple[np.ndarray, ...]:
        return tuple(own.force for own in self.recordings)

    def sensors(self) -> Sensors:
        own = median_test(
            self.recordings, lambda each: each.noise_of_displacement / float(each.motion.displacement.std())
        )
        rms = np.array([own.motion.displacement.std()])
        travel = max(each.half_range for each in self.recordings)
        noise = NoiseSpectrum(0.0, 0.0, max(own.noise_of_displacement, 1e-9 * travel) ** 2)
        return Sensors(self.model, self.law, own.low_pass.rate, (noise,), rms, travel, (0,))


def loop_data(measurement: Measurement) -> LoopData:
    """Loops of all tests, in blocks."""
    left: dict[int, list[np.ndarray]] = {}
    for rows in repeat_groups(measurement.tests):
        forces = [each for row in rows if (each := measurement.tests[row].force) is not None]
        left |= dict.fromkeys(rows, repeat_differences(forces))
    recordings = tuple(
        _recording(measurement, test, left.get(i, [])) for i, test in enumerate(measurement.tests)
    )
    chosen = tuple((i, block) for i, own in enumerate(recordings) for block in range(len(own.blocks)))
    return LoopData(recordings, chosen, measurement.uncertain_of_records, measurement.model_error)


def _recording(measurement: Measurement, test: TestRecord, differences: list[np.ndarray]) -> Recording:
    try:
        return recording(test, measurement.model_of(test), measurement.law, differences)
    except InputError as error:
        raise InputError([f"{test.file}: {problem}" for problem in error.problems]) from error
