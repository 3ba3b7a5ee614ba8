"""Transients as data of a fit: each window of a record starts from a state of its own, which is fitted.

A window is a test: errors of phase do not add up over a long record (multiple shooting with free starts). The
zero of the displacement is unknown in each.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import ceil
from typing import Any, Self

import numpy as np

from wedgesweep.config import Config
from wedgesweep.diagnose import work
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
from wedgesweep.diagnose.sampled_data import Decorrelation, SampledData, best_of_each_test, padded
from wedgesweep.diagnose.transient.cutting import FEWEST_COMPARED, SHORTEST
from wedgesweep.diagnose.transient.noise import noise_of_channels
from wedgesweep.diagnose.transient.window import BODIES, RecordWindow, simulated_together
from wedgesweep.effects import acting
from wedgesweep.effects.channel_delay import NAME as DELAY
from wedgesweep.measured.declarations import MOTIONS
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
# Places that are tried as starts, as shares of their range, if there are at most FEW points.
SHARES, FEW = np.linspace(-1.0, 1.0, 101), 3
# Samples that are simulated at a time, at most: they take some hundred megabytes.
MOST_TOGETHER = 4_000_000
# Dimensions and unit of stored motions.
BY_SAMPLE, BY_CHANNEL = ("test", "sample"), ("test", "channel", "sample")
CHANNEL_UNIT = "m, m/s or m/s^2"
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
        """The data with no more noise than a scenario leaves, and that of the input as it passes it on."""
        return self._with_noise_left_by(scenario).with_input_noise(scenario)

    def with_input_noise(self, scenario: Scenario) -> Self:
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

    def _with_noise_left_by(self, scenario: Scenario) -> Self:
        """The data with no more noise than a scenario leaves, which is noise and misfit.

        The skirts of a motion look like red noise in its record. Those of what an explanation leaves are far
        smaller.
        """
        simulated = self.simulated([scenario])[0]
        if not np.isfinite(simulated).all():
            return self
        left = self.without_zero(self.recorded - simulated)
        residuals = [own.residual(each) for own, each in zip(self.windows, left, strict=True)]
        motions = {order: str(order) for order in range(len(MOTIONS))}  # what is left of two may differ
        spectra = noise_of_channels(residuals, motions, [1.0 / own.step for own in self.windows])
        windows = [
            own.with_less_noise([spectra[t, order] for order in own.orders])
            for t, own in enumerate(self.windows)
        ]
        return replace(self, windows=tuple(windows))

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

    @property
    def _anywhere(self) -> np.ndarray:
        """Starts (n, T, N) at which a test might begin, as its record does not show its zero.

        A mass may rest anywhere before the input moves it. A free motion begins with the recorded velocity,
        and may end far from where the spring alone would end it.
        """
        stated, _ = self.start()
        driven, length = (np.array([getattr(own, n) for own in self.windows]) for n in ("driven", "length"))
        reach = np.where(driven, 1.0, max(self.units.length, length.max()) / length)
        found = np.zeros((SHARES.size, *stated.shape))
        found[..., 0], found[..., 1] = np.multiply.outer(SHARES, reach), np.where(driven, 0.0, stated[:, 1])
        return found

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

    def nuisances(self, effects: Iterable[str]) -> tuple[NuisanceParameter, ...]:
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

    def beginning(self, share: float) -> Self:
        """A recorded input keeps motions in step with the record; free ones go their own ways.

        A larger share is returned where this one would be too short to be fitted.
        """
        fewest = [max(SHORTEST / own.natural, FEWEST_COMPARED / own.coefficients) for own in self.windows]
        share = max(share, *fewest)
        if share >= 1.0 or any(own.driven for own in self.windows):
            return self
        return replace(self, windows=tuple(own.beginning(share) for own in self.windows), resampled=None)

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
        starts = [stated, *(self._anywhere if len(points) <= FEW else ())]
        moved = [[replace(each, nuisance=start, warm=at_rest) for each in points] for start in starts]
        tried = [points, *moved]
        by_try = [model.evaluate_all(each) for each in tried]
        return [best_of_each_test(evaluations) for evaluations in zip(*by_try, strict=True)]

    def described(self, point: Point) -> list[dict[str, Any]]:
        starts = 1e3 * self.starts(point)
        return [
            {
                "begins_s": own.begins,
                "duration_s": own.step * own.channels.shape[1],
                "highest_hz": 0.5 * own.coefficients / (own.step * own.channels.shape[1]),
                "noise_from": own.spectra[0].source,
                "noise_correlation": own.spectra[0].correlation,
                "natural_periods": own.natural,
                "start_s": own.starts_at,
                "start_mm": start[0],
                "start_mm_per_s": start[1],
                **_noise(own),
            }
            for own, start in zip(self.windows, starts, strict=True)
        ]

    def shown(self, simulated: np.ndarray) -> Arrays:
        """Motions in time; simulated coefficients (2, T, m) have the frequencies that are compared."""
        channels = max(len(own.channels) for own in self.windows)
        longest = max(own.channels.shape[1] for own in self.windows)
        measured = np.full((self.tests, channels, longest), np.nan)
        in_time = np.full((len(simulated), *measured.shape), np.nan)
        for t, own in enumerate(self.windows):
            size, count = own.channels.shape
            measured[t, :size, :count] = own.channels
            part = simulated[:, t, : size * own.coefficients]
            in_time[:, t, :size, :count] = own.in_time(part.reshape(-1, size, own.coefficients))
        time = np.array([own.begins + own.step * np.arange(longest) for own in self.windows])
        noise = np.array([[each.std for each in own.spectra] for own in self.windows])
        meaning = "simulated motion, with the fitted zero"
        variables = {
            "time": (BY_SAMPLE, time, "s", "time from the first sample of the record"),
            "measured": (BY_CHANNEL, measured, CHANNEL_UNIT, "measured motion"),
            "simulated": (("model", *BY_CHANNEL), in_time, CHANNEL_UNIT, meaning),
            "sample_noise": (BY_CHANNEL[:2], noise, CHANNEL_UNIT, "noise of a sample"),
        }
        orders = max((own.orders for own in self.windows), key=len)
        return Arrays(variables, {"channel": [MOTIONS[order] for order in orders]})

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


def _noise(own: RecordWindow) -> dict[str, Any]:
    """Noise of a sample of each channel; null where it was not recorded."""
    keys = ("noise_displacement_mm", "noise_velocity_mm_per_s", "noise_acceleration_m_per_s2")
    std = {order: each.std for order, each in zip(own.orders, own.spectra, strict=True)}
    sizes = enumerate(zip(keys, (1e3, 1e3, 1.0), strict=True))
    return {key: size * std[order] if order in std else None for order, (key, size) in sizes}
