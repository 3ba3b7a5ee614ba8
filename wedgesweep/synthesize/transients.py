"""Transients of the true system by Radau: releases, and motion under a sweep, a bump or a random input."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import pi

import numpy as np

from wedgesweep import excitation
from wedgesweep.config import Config
from wedgesweep.sampled_input import from_samples, set_sampled
from wedgesweep.solvers import radau
from wedgesweep.solvers.trajectory import CaseError, TimedWindow
from wedgesweep.synthesize.motion import RTOL, TIME_LIMIT, NoMotion, lag_steps, lagged
from wedgesweep.synthesize.plan import PlannedTest

RELEASE, SWEEP, RANDOM, BUMP = "release", "sweep", "random", "bump"
# Samples of an input for each that is recorded.
FINER = 4
# Frequencies over which a random input rises, and falls, as a share of its lowest and highest one.
FLANK = 0.1


@dataclass(frozen=True, eq=False)
class Transient:
    """Displacement (m), velocity (m/s), acceleration (m/s^2) and input (m or N), shape (n,) each.

    ``input`` is None without one.
    """

    displacement: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    input: np.ndarray | None


def input_of(test: PlannedTest, time: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """Input (n,) of a test at even times (s), in the unit of its amplitude."""
    low, high = test.frequency_hz, test.to_hz or test.frequency_hz
    if test.motion == SWEEP:
        turns = low * time + (high - low) * time**2 / (2.0 * test.duration_s)
        return test.amplitude * np.sin(2.0 * pi * turns)
    if test.motion == BUMP:
        # A half wave, squared, so that it begins and ends without a kink.
        share = np.clip((time - 0.5 / low) * low, 0.0, 1.0)
        return test.amplitude * np.sin(pi * share) ** 2
    frequency = np.fft.rfftfreq(time.size, time[1] - time[0])
    flank = np.clip((frequency - low) / (FLANK * low), 0.0, 1.0)
    flank *= np.clip((high - frequency) / (FLANK * high), 0.0, 1.0)
    spectrum = flank * np.exp(2j * pi * random.random(frequency.size))
    shape = np.fft.irfft(spectrum, time.size)
    return test.amplitude * shape / shape.std()


def transient(
    config: Config,
    law: str,
    effects: Mapping[str, Mapping[str, float]],
    test: PlannedTest,
    sampling_hz: float,
    random: np.random.Generator,
) -> Transient:
    """Simulate a test; ``effects`` in SI units. Raises NoMotion if there is no response."""
    count, factor = round(test.duration_s * sampling_hz), config.amplitude_unit.factor
    omega = 1.0 / config.natural_units(1e-3 * max(abs(test.release_mm), test.amplitude, 1e-6)).time
    record = config.record_with(effects, law, 1.0, omega)
    sign, given = 1.0 if config.system == "oscillator" else -1.0, None
    if test.motion == RELEASE:
        excitation.set_no_motion(record, 1e-3 * abs(test.release_mm))
    else:
        fine = np.arange(count * FINER + 1) / (sampling_hz * FINER)
        given = factor * input_of(test, fine, random)
        sampled = from_samples(given, float(fine[1]), "force" if config.forced else "displacement")
        set_sampled(record, sampled, factor * test.amplitude, omega, test.duration_s)
    lag = effects.get("velocity_lag", {}).get("time", 0.0)
    finer = lag_steps(1.0 / sampling_hz, 2.0 * pi / omega, lag)
    step = 1.0 / (sampling_hz * finer)
    window = TimedWindow(2.0 * pi / test.duration_s, 0, 1, 0, step * np.arange(count * finer))
    start = (sign * 1e-3 * test.release_mm, sign * 1e-3 * test.release_mm_per_s)
    try:
        samples = radau.solve(record, window, RTOL, TIME_LIMIT, start=start).samples
    except CaseError as error:
        raise NoMotion(str(error)) from error
    velocity = lagged(-samples.velocity, step, lag) if lag > 0.0 else -samples.velocity
    gain = effects.get("displacement_gain", {}).get("scale", 1.0)
    recorded = None if given is None else given[: count * FINER : FINER]
    x, acceleration = samples.x[::finer], samples.acceleration[::finer]
    return Transient(-gain * x, velocity[::finer], -acceleration, recorded)
