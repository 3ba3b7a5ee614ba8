"""The true system: all random numbers of a synthetic measurement, drawn once."""

from collections.abc import Callable
from dataclasses import dataclass
from math import ceil, exp, pi

import numpy as np

from wedgesweep.config import Config
from wedgesweep.effects import merge
from wedgesweep.effects.thermal_drift import at_temperature
from wedgesweep.natural_units import FREQUENCY
from wedgesweep.synthesize.motion import Clock
from wedgesweep.synthesize.plan import Plan, PlannedTest
from wedgesweep.uncertain import UncertainNumbers, uncertain_numbers

# Default sampling rates: near SAMPLING_HZ for a rig like the bench (in proportion to the natural frequency of
# others), and different in each test.
SAMPLING_HZ, SAMPLING_SPREAD = 2000.0, 0.03
STRAY = "stray_vibration"


@dataclass(frozen=True)
class TrueTest:
    """One test: true amplitude, phase of the input at the first sample, offset over the rms.

    ``amplitude`` is in the unit of the plan. ``stray_phase_deg`` is the phase of a spurious tone, None
    without one; ``random`` makes the noise.
    """

    plan: PlannedTest
    amplitude: float
    phase_deg: float
    sampling_hz: float
    offset: float
    stray_phase_deg: float | None
    random: np.random.Generator

    def clock(self, periods: float, more: int) -> Clock:
        """Sample times of some periods, and ``more`` samples."""
        period = 1.0 / self.plan.frequency_hz
        count = ceil(periods * period * self.sampling_hz) + more
        return Clock(self.phase_deg / 360.0 * period, 1.0 / self.sampling_hz, count)


@dataclass(frozen=True)
class Truth:
    """The true system: a config with effects, its law, and its uncertain numbers at ``x`` (u,)."""

    config: Config
    law: str
    uncertain: UncertainNumbers
    x: np.ndarray
    tests: tuple[TrueTest, ...]

    @property
    def effects(self) -> dict[str, dict[str, float]]:
        """Effects of the config with the uncertain numbers at their true values, in SI units."""
        return merge(self.config.effects, self.uncertain.values(self.x))

    def effects_in(self, test: TrueTest) -> dict[str, dict[str, float]]:
        """The effects at the temperature of a test, in SI units."""
        return at_temperature(self.effects, test.plan.temperature_C)

    def record(self, test: TrueTest) -> np.ndarray:
        """Parameters of a test for the solver, shape (1,)."""
        amplitude = test.amplitude * self.config.amplitude_unit.factor
        omega = 2.0 * pi * test.plan.frequency_hz
        record = self.config.record_with(self.effects_in(test), self.law, amplitude, omega)
        if test.stray_phase_deg is not None:
            record[STRAY]["phase"] = np.radians(test.stray_phase_deg)
        return record


def draw(
    config: Config,
    law: str,
    plan: Plan,
    amplitude_error: float,
    sampling_hz: float | None,
    seed: int,
) -> Truth:
    """Draw all random numbers; each test has its own generator, so that it does not depend on the others."""
    seeds = np.random.SeedSequence(seed).spawn(len(plan.tests) + 1)
    random = np.random.default_rng(seeds[0])
    stated = uncertain_numbers(plan.uncertain, config.effects)
    x = stated.mean + stated.std * random.normal(size=len(stated))
    stray = STRAY in config.effects
    near = SAMPLING_HZ * config.natural_units().ratio(FREQUENCY)

    def rate(spread: float) -> float:
        return sampling_hz or round(near * (1.0 + SAMPLING_SPREAD * (2.0 * spread - 1.0)), 3)

    tests = tuple(
        _drawn(test, amplitude_error, rate, stray, np.random.default_rng(seed))
        for test, seed in zip(plan.tests, seeds[1:], strict=True)
    )
    return Truth(config, law, stated, x, tests)


def _drawn(
    test: PlannedTest,
    amplitude_error: float,
    rate: Callable[[float], float],
    stray: bool,
    random: np.random.Generator,
) -> TrueTest:
    error, offset = random.normal(size=2).tolist()
    phase, stray_phase, spread = random.random(3).tolist()
    return TrueTest(
        plan=test,
        amplitude=test.amplitude * exp((test.amplitude_std or amplitude_error) * error),
        phase_deg=360.0 * phase,
        sampling_hz=rate(spread),
        offset=offset,
        stray_phase_deg=360.0 * stray_phase if stray else None,
        random=random,
    )
