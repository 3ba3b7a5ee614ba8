"""What the sensors record of a test: channels with offset and noise, as in the CSV file."""

from collections.abc import Mapping
from math import pi

import numpy as np

from wedgesweep.config import Config
from wedgesweep.measured.declarations import LOOP, STEADY, TRANSIENT
from wedgesweep.sampled_input import INTEGRATED, from_samples
from wedgesweep.solvers import imposed_motion
from wedgesweep.synthesize import noise, transients
from wedgesweep.synthesize.files import Table
from wedgesweep.synthesize.motion import NoMotion, sines, steady
from wedgesweep.synthesize.options import QUANTITIES, Options
from wedgesweep.synthesize.plan import PlannedTest
from wedgesweep.synthesize.truth import STRAY, TrueTest, Truth

# A mass that moves less than this share of the input counts as stuck.
STUCK = 1e-3
# Default sampling rate over that of a steady test, which is shorter.
SAMPLING_SHARE = 0.25
# Relative noise of a loop's displacement over that of its force: a displacement sensor is far better.
DISPLACEMENT_NOISE = 0.003
# Steps of the motion for each sample, over which force and displacement are averaged.
CELLS = 10
# A second sine in the motion, so that it reverses at many places: frequency and amplitude over those of the
# first, and phase (rad).
SECOND_FREQUENCY, SECOND_AMPLITUDE, SECOND_PHASE = 0.37, 0.3, 1.0


def sampling_rate(test: TrueTest, options: Options) -> float:
    """Samples per second of a transient or a loop."""
    return options.sampling_hz or round(SAMPLING_SHARE * test.sampling_hz, 3)


def sample_count(test: TrueTest, options: Options) -> int:
    """Number of samples of a transient or a loop."""
    return round(test.plan.duration_s * sampling_rate(test, options))


def table(truth: Truth, test: TrueTest, options: Options) -> Table:
    """The channels of a test; time starts at 0.

    Raises
    ------
    CaseError
        If the solver fails.
    NoMotion
        If the true system has no answer, or the mass sticks all the time.
    """
    return TABLES[test.plan.kind](truth, test, options)


def _of_steady(truth: Truth, test: TrueTest, options: Options) -> Table:
    # Differences lose a sample at either end.
    lost = int(options.noise == "differentiated")
    record, clock = truth.record(test), test.clock(options.periods, 2 * lost)
    repeats, with_load = STRAY not in truth.config.effects, options.normal_force is not None
    motion = steady(record, clock, options.settle_periods, repeats, truth.effects_in(test), with_load)
    deflection = truth.config.deflection(2.0 * pi * test.plan.frequency_hz)
    if np.ptp(motion.displacement) < STUCK * deflection * record["input"]["amplitude"][0]:
        reason = "the mass sticks all the time and there is nothing to measure; raise the amplitude"
        raise NoMotion(reason)
    displacement, velocity = _with_noise(motion.displacement, motion.velocity, test, options, clock.step)
    time, given, load = clock.step * np.arange(displacement.size), None, None
    if options.record_input is not None:
        exact = _base_motion(record, clock.start + lost * clock.step + time, options.record_input)
        given = exact + noise.of(exact, options.input_level, test.random)
    if motion.load is not None and options.normal_force is not None:
        zero = options.normal_force * test.random.normal()
        load = motion.load[lost : motion.load.size - lost]
        load = load + zero + noise.of(load, options.level, test.random)
    return Table(
        time, 1e3 * displacement, 1e3 * velocity, given, load=load, settle_periods=motion.settle_periods
    )


def _with_noise(
    displacement: np.ndarray, velocity: np.ndarray, test: TrueTest, options: Options, step: float
) -> tuple[np.ndarray, np.ndarray]:
    """Displacement and velocity (n,), sampled at a ``step`` (s), with offset and noise of their sensors."""
    exact = displacement + test.offset * displacement.std(), velocity
    return noise.NOISES[options.noise](exact, options.level, step, test.random)


def _base_motion(record: np.ndarray, time: np.ndarray, quantity: str) -> np.ndarray:
    """Base motion of a parameter record, shape (1,), at times (n,) from phase 0, without noise (SI units).

    A force has the shape of the displacement.
    """
    given, distortion, stray = (record[each][0] for each in ("input", "input_distortion", STRAY))
    a, omega = given["amplitude"], given["omega"]
    waves = [
        (a, omega, 0.0),
        (a * distortion["second"], 2.0 * omega, distortion["second_phase"]),
        (a * distortion["third"], 3.0 * omega, distortion["third_phase"]),
    ]
    if stray["acceleration"] != 0.0:
        tone = 2.0 * pi * stray["frequency"]
        waves.append((-stray["acceleration"] / tone**2, tone, stray["phase"]))
    return sines(waves, time, INTEGRATED[quantity])


def _of_transient(truth: Truth, test: TrueTest, options: Options) -> Table:
    rate = sampling_rate(test, options)
    found = transients.transient(
        truth.config, truth.law, truth.effects_in(test), test.plan, rate, test.random
    )
    displacement, velocity = _with_noise(found.displacement, found.velocity, test, options, 1.0 / rate)
    time, given = np.arange(displacement.size) / rate, found.input
    if given is not None:
        first = (given.size - time.size) // 2
        given = _recorded(given, rate, options.record_input or QUANTITIES[0])[first : first + time.size]
        given = given + noise.of(given, options.input_level, test.random)
    return Table(time, 1e3 * displacement, 1e3 * velocity, given)


def _of_loop(truth: Truth, test: TrueTest, options: Options) -> Table:
    rate, level = sampling_rate(test, options), options.level
    displacement, force = loop(truth.config, truth.law, truth.effects_in(test), test.plan, rate)
    force = force + (level * test.random.normal(size=force.size) + test.offset) * force.std()
    displacement = displacement + noise.of(displacement, DISPLACEMENT_NOISE * level, test.random)
    return Table(np.arange(force.size) / rate, 1e3 * displacement, None, None, force)


def loop(
    config: Config,
    law: str,
    effects: Mapping[str, Mapping[str, float]],
    test: PlannedTest,
    sampling_hz: float,
) -> tuple[np.ndarray, np.ndarray]:
    """Displacement (m) and force (N), shape (n,) each, of a test; ``effects`` in SI units.

    Raises
    ------
    NoMotion
        If no force gives the mass this motion: a face would lift off, or the wedge locks.
    """
    count, step = round(test.duration_s * sampling_hz), 1.0 / sampling_hz / CELLS
    time = step * (np.arange(count * CELLS) + 0.5)
    record = config.record_with(effects, law, 0.0)
    size, rate = 1e-3 * test.amplitude, 2.0 * pi * test.frequency_hz
    waves = (size, rate, 0.0), (SECOND_AMPLITUDE * size, SECOND_FREQUENCY * rate, SECOND_PHASE)
    motion = np.array([sines(waves, time, order) for order in range(3)])
    sign = 1.0 if config.system == "oscillator" else -1.0
    force = imposed_motion.forces(record, sign * motion[0], sign * motion[1], sign * motion[2], step)[0]
    if np.isnan(force).any():
        share = f"{np.isnan(force).mean():.0%} of the motion"
        reason = f"no force drives the mass in {share}: a face lifts off there, or the wedge locks"
        raise NoMotion(f"{reason}; lower the amplitude")
    displacement, mean = (each.reshape(count, CELLS).mean(axis=1) for each in (motion[0], force))
    return displacement, mean


def _recorded(given: np.ndarray, rate: float, quantity: str) -> np.ndarray:
    """An input (m or N) as the quantity that is recorded."""
    order = INTEGRATED[quantity]
    if order == 0:
        return given
    return from_samples(given, 1.0 / rate)(np.arange(given.size) / rate, order)


TABLES = {STEADY: _of_steady, TRANSIENT: _of_transient, LOOP: _of_loop}
