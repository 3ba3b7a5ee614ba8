"""Transients as data of a fit: each window of a record starts from a state of its own, which is fitted.

A window is a test: errors of phase do not add up over a long record (multiple shooting with free starts). The
zero of the displacement is unknown in each.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from math import ceil
from typing import Any, Self

import numpy as np

from wedgesweep.config import Config
from wedgesweep.diagnose import work
from wedgesweep.diagnose.decorrelation import Decorrelation
from wedgesweep.diagnose.evaluation import (
    UNUSED,
    Evaluation,
    NoStart,
    NuisanceParameter,
    Point,
    Scenario,
)
from wedgesweep.diagnose.fit_data import INPUT_GAIN, Arrays, Motion
from wedgesweep.diagnose.model import TOLERANCE, Fit, Model
from wedgesweep.diagnose.next_test.sensors import Sensors, median_test
from wedgesweep.diagnose.sampled_data import SampledData, best_of_each_test, padded
from wedgesweep.diagnose.transient import arrays
from wedgesweep.diagnose.transient.beyond_jumps import best_start, places, standing_out
from wedgesweep.diagnose.transient.window import BODIES, RecordWindow, simulated_together
from wedgesweep.effects import acting
from wedgesweep.effects.channel_delay import NAME as DELAY
from wedgesweep.natural_units import NaturalUnits

# Next tests like these: free motions, and motions under an input.
RELEASE, SWEEP = "release", "sweep"
# Effects that are no candidates: of a sine as the input, or of what a recorded input contains already.
OF_INPUT = ("input_distortion", "stray_vibration", "cross_slip", "force_gain")
# Effects of sensors, and the derivative of the displacement whose sensor has each.
OF_SENSORS = {"displacement_gain": 0, "velocity_lag": 1}
# Displacement and velocity of the start, over the largest displacement (times omega_n for the velocity).
START = (NuisanceParameter(step=1e-4, max_step=0.1), NuisanceParameter(step=1e-4, max_step=0.1))
# The same of each of BODIES, in their order.
BODY_STARTS = START * len(BODIES)
# All ``places`` are tried as starts if there are at most FEW points.
FEW = 3
# Samples that are simulated at a time, at most: they take some hundred megabytes.
MOST_TOGETHER = 4_000_000
# Gain of a recorded input, as its logarithm.
GAIN = NuisanceParameter(step=1e-3, max_step=0.1)


@dataclass(frozen=True, eq=False)
class TransientData(SampledData):
    """T windows; arrays (T, m) hold the coefficients of their channels, one channel after the other.

    ``decorrelations``: combinations with independent noise of the first coefficients of each channel of each
    test; without them coefficients count as independent.
    ``gain_std``: relative standard deviation of the gain of recorded inputs, 0 for exact ones or none.
    """

    windows: tuple[RecordWindow, ...]
    uncertain: dict[str, float]
    model_error: float = 0.0
    gain_std: float = 0.0
    resampled: np.ndarray | None = None
    decorrelations: tuple[tuple[Decorrelation, ...], ...] | None = None

    kind = "transient"

    @cached_property
    def names(self) -> tuple[str, ...]:  # type: ignore[override]
        return tuple(own.name for own in self.windows)

    @property
    def numbers(self) -> np.ndarray:
        return np.array([own.number for own in self.windows])

    @property
    def model(self) -> Config:  # type: ignore[override]
        """The base model, with the numbers of the first test."""
        return self.windows[0].model

    @property
    def law(self) -> str:  # type: ignore[override]
        return self.windows[0].law

    def _padded(self, values: Sequence[np.ndarray]) -> np.ndarray:
        """Values (..., C, k) of each test as (..., T, m), with zeros at the end."""
        return padded([each.reshape(*each.shape[:-2], -1) for each in values])

    @cached_property
    def recorded(self) -> np.ndarray:
        return self._padded([own.compared for own in self.windows])

    @property
    def independent_noise(self) -> np.ndarray:
        return self._padded([own.noise for own in self.windows])

    def combinations(self) -> Iterator[tuple[int, slice, Decorrelation]]:
        for t, both in enumerate(self.decorrelations or ()):
            for channel, each in enumerate(both):
                first = channel * self.windows[t].coefficients
                yield t, slice(first, first + each.std.size), each

    def renewed(self, scenario: Scenario) -> Self:
        """The data with the noise of the input as the response of a scenario passes it on."""
        if not any(own.driven for own in self.windows):
            return self
        (values,) = self.known_values([scenario], OF_INPUT)
        starts, gains = self._states(scenario.point), self._gain(scenario)
        found = []
        for own, start, gain in zip(self.windows, starts, gains, strict=True):
            work.add(0.0)  # no part of a search, but it takes time
            found.append(own.decorrelation(values, start, gain, TOLERANCE))
        return replace(self, decorrelations=tuple(found))

    @cached_property
    def size(self) -> np.ndarray:
        """Rms (T, m) that the coefficients of each channel have if they hold all its power."""
        rms = [np.sqrt(own.spread) * own.rms for own in self.windows]
        shapes = [(each.size, own.coefficients) for each, own in zip(rms, self.windows, strict=True)]
        pairs = zip(rms, shapes, strict=True)
        return self._padded([np.broadcast_to(each[:, None], shape) for each, shape in pairs])

    @cached_property
    def shifted(self) -> np.ndarray:
        """A unit of the zero adds this to the first coefficient of the first channel, that of its mean."""
        found = np.zeros_like(self.recorded)
        found[:, 0] = [np.sqrt(own.channels.shape[1]) for own in self.windows]
        return found

    @property
    def input_gain_std(self) -> float:  # type: ignore[override]
        return self.gain_std

    @property
    def nuisance_std(self) -> np.ndarray:
        start = np.full((self.tests, len(START)), np.inf)
        if not self.gain_std:
            return start
        driven = np.array([own.driven for own in self.windows])
        return np.column_stack([start, np.where(driven, self.gain_std, 1.0)])

    @cached_property
    def units(self) -> NaturalUnits:
        largest = max(self.windows, key=lambda own: own.length)
        return self.model.natural_units(largest.length, largest.grid.omega)

    @cached_property
    def _scale(self) -> np.ndarray:
        """Units (T, 2) of the starts: the largest displacement (m), and that times omega_n (m/s)."""
        length = np.array([own.length for own in self.windows])
        return np.column_stack([length, length * np.array([own.grid.omega for own in self.windows])])

    @cached_property
    def _anywhere(self) -> np.ndarray:
        """Starts (T, n, 2) at which a test might begin, as its record does not show its zero.

        A mass may rest anywhere before the input moves it. A free motion begins with the recorded velocity,
        and may end far from where the spring alone would end it.
        """
        longest = max(self.units.length, *(own.length for own in self.windows))
        velocities = self.start()[0][:, 1]
        return np.array(
            [
                places(1.0, 0.0) if own.driven else places(longest / own.length, velocity)
                for own, velocity in zip(self.windows, velocities, strict=True)
            ]
        )

    def starts(self, point: Point) -> np.ndarray:
        """Displacement (m) and velocity (m/s) at the first sample of each test, (T, 2)."""
        return point.nuisance[:, : len(START)] * self._scale

    def _states(self, point: Point) -> np.ndarray:
        """Displacement (m) and velocity (m/s) at the first sample, of the mass, then of BODIES, (T, B, 2)."""
        mass, bodies = point.nuisance[:, : len(START)], point.nuisance[:, -len(BODY_STARTS) :]
        both = np.concatenate([mass, bodies], axis=1)
        return both.reshape(self.tests, -1, len(START)) * self._scale[:, None]

    def _gain(self, scenario: Scenario) -> np.ndarray:
        """True input over the recorded one in each test, (T,): gain common to all times that of each test."""
        common = np.full(self.tests, scenario.values.get(INPUT_GAIN, {"scale": 1.0})["scale"])
        return common * np.exp(scenario.point.nuisance[:, len(START)]) if self.gain_std else common

    def nuisances(self, effects: Iterable[str], point: Point) -> tuple[NuisanceParameter, ...]:
        known = (*START, GAIN) if self.gain_std else START
        moving = self._moving(effects)
        if not any(moving):
            return known
        return (*known, *(each if moves else UNUSED for moves in moving for each in START))

    def _moving(self, effects: Iterable[str]) -> list[bool]:
        """Which of BODIES move, by the base model or by other effects."""
        present = {*acting(self.model.effects), *effects}
        return [name in present for name in BODIES]

    def extra_nuisances(self, effects: Iterable[str]) -> np.ndarray:
        """The starts of BODIES that move, in each test."""
        return np.full(self.tests, len(START) * sum(self._moving(effects)))

    def start(self) -> tuple[np.ndarray, NoStart]:
        start = np.array([own.guess for own in self.windows]) / self._scale
        return np.pad(start, ((0, 0), (0, int(self.gain_std > 0.0) + len(BODY_STARTS)))), NoStart()

    def chosen_tests(self, rows: np.ndarray) -> Self:
        known, windows = self.decorrelations, tuple(self.windows[row] for row in rows)
        kept = None if known is None else tuple(known[row] for row in rows)
        return replace(self, windows=windows, resampled=None, decorrelations=kept)

    def candidates(self, effects: Sequence[str]) -> tuple[str, ...]:
        shown = {order for own in self.windows for order in own.shown_as_measured}
        hidden = {*OF_INPUT, *(name for name, order in OF_SENSORS.items() if order not in shown)}
        if self.gain_std:
            hidden.add(INPUT_GAIN)
        if not any(own.driven for own in self.windows):
            hidden.update((INPUT_GAIN, DELAY))
        if any(own.converted for own in self.windows):
            hidden.update(("fixture_resonance", DELAY))  # such channels show the motion against the table
        return tuple(name for name in effects if name not in hidden)

    def simulated(self, scenarios: Sequence[Scenario]) -> np.ndarray:
        values = self.known_values(scenarios, OF_INPUT)
        starts = np.array([self._states(each.point) for each in scenarios])
        gains = np.array([self._gain(each) for each in scenarios])
        work.add(len(values) * sum(own.periods for own in self.windows))
        found: list[Any] = [None] * self.tests
        for rows in self._together(len(values)):
            alike = [self.windows[row] for row in rows]
            several = simulated_together(alike, values, starts[:, rows], gains[:, rows], TOLERANCE)
            for place, row in enumerate(rows):
                found[row] = several[:, place]
        return self._padded(found)

    def _together(self, scenarios: int) -> Iterator[np.ndarray]:
        """Rows of windows that are simulated together, at most MOST_TOGETHER samples at a time."""
        keys = [own.alike for own in self.windows]
        for key in dict.fromkeys(keys):
            rows = np.array([row for row, each in enumerate(keys) if each == key])
            samples = scenarios * rows.size * self.windows[rows[0]].grid.samples
            yield from np.array_split(rows, min(ceil(samples / MOST_TOGETHER), rows.size))

    def search_nuisances(self, model: Model, points: Sequence[Point]) -> list[Evaluation]:
        """Evaluations of points, each test from the best of several starts."""
        stated, at_rest = self.start()
        starts = [stated]
        if len(points) <= FEW:
            unmoved = np.zeros((self.tests, stated.shape[1] - len(START)))
            starts += [np.hstack([each, unmoved]) for each in self._anywhere.swapaxes(0, 1)]
        moved = [[replace(each, nuisance=start, warm=at_rest) for each in points] for start in starts]
        tried = [points, *moved]
        by_try = [model.evaluate_all(each) for each in tried]
        return [best_of_each_test(evaluations) for evaluations in zip(*by_try, strict=True)]

    def other_nuisances(self, model: Model, evaluation: Evaluation) -> np.ndarray | None:
        found, stated = evaluation.point.nuisance.copy(), self.start()[0]
        for test in standing_out(evaluation.chi2_by_test, self.dof):
            rows = np.array([test])
            misfit = partial(_misfits, model.on(self.subset(rows)), evaluation.point.subset(rows))
            starts = [each[test, : len(START)] for each in (found, stated)]
            found[test, : len(START)] = best_start(misfit, starts, self._anywhere[test])
        return None if np.array_equal(found, evaluation.point.nuisance) else found

    def described(self, point: Point) -> list[dict[str, Any]]:
        return arrays.described(self, point)

    def shown(self, simulated: np.ndarray) -> Arrays:
        return arrays.arrays(self, simulated)

    def motion(self, fit: Fit) -> Motion:
        return Motion.joined(own.motion for own in self.windows)

    @property
    def offers(self) -> tuple[str, ...]:
        driven = {own.driven for own in self.windows}
        return tuple(name for name, one in ((RELEASE, False), (SWEEP, True)) if one in driven)

    def sensors(self) -> Sensors:
        own = median_test(self.windows, lambda each: each.spectra[0].std / max(float(each.rms[0]), 1e-300))
        drive = 0.0
        for each in self.windows:
            if each.driven:
                times = np.arange(each.grid.samples) * each.step
                drive = max(drive, 0.5 * float(np.ptp(each.input(times))))
        drive /= self.units.mass / self.units.time**2 if self.model.forced else 1.0
        travel = max(each.length for each in self.windows)
        return Sensors(self.model, self.law, 1.0 / own.step, own.spectra, own.rms, travel, own.orders, drive)


def _misfits(model: Model, point: Point, starts: np.ndarray) -> np.ndarray:
    """Squared misfits (n,) of one test from starts (n, 2); inf where there is no response."""
    moved = [replace(point, nuisance=np.r_[each, point.nuisance[0, len(START) :]][None]) for each in starts]
    return np.array([each.chi2 if each.found else np.inf for each in model.evaluate_all(moved)])
