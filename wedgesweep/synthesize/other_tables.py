"""Tables of tests that are not steady: what the sensors record of transients and loops."""

from collections.abc import Mapping
from math import pi

import numpy as np

from wedgesweep.config import Config
from wedgesweep.measured.declarations import LOOP
from wedgesweep.sampled_input import from_samples
from wedgesweep.solvers import imposed_motion
from wedgesweep.synthesize import noise, transients
from wedgesweep.synthesize.files import Table
from wedgesweep.synthesize.motion import NoMotion, sines
from wedgesweep.synthesize.options import FORCE, QUANTITIES, Options
from wedgesweep.synthesize.plan import PlannedTest
from wedgesweep.synthesize.truth import TrueTest, Truth

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
    """Channels with offset and noise, as in the CSV file."""
    rate = sampling_rate(test, options)
    if test.plan.kind == LOOP:
        return _of_loop(truth, test, rate, options.level)
    found = transients.transient(truth.config, truth.law, truth.effects, test.plan, rate, test.random)
    displacement = found.displacement + test.offset * found.displacement.std()
    exact = displacement, found.velocity
    displacement, velocity = noise.NOISES[options.noise](exact, options.level, 1.0 / rate, test.random)
    time = np.arange(displacement.size) / rate
    given = found.input
    if given is not None:
        first = (given.size - time.size) // 2
        given = _recorded(given, rate, options.record_input or QUANTITIES[0])[first : first + time.size]
        given = given + options.input_level * given.std() * test.random.normal(size=given.size)
    return Table(time, 1e3 * displacement, 1e3 * velocity, given)


def _of_loop(truth: Truth, test: TrueTest, rate: float, level: float) -> Table:
    displacement, force = loop(truth.config, truth.law, truth.effects, test.plan, rate)
    force = force + (level * test.random.normal(size=force.size) + test.offset) * force.std()
    displacement = displacement + DISPLACEMENT_NOISE * level * displacement.std() * test.random.normal(
        size=force.size
    )
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
        message = f"{reason}; lower the amplitude"
        raise NoMotion(message)
    displacement, mean = (each.reshape(count, CELLS).mean(axis=1) for each in (motion[0], force))
    return displacement, mean


def _recorded(given: np.ndarray, rate: float, quantity: str) -> np.ndarray:
    """An input (m or N) as the quantity that is recorded."""
    order = 0 if quantity == FORCE else QUANTITIES.index(quantity)
    if order == 0:
        return given
    return from_samples(given, 1.0 / rate)(np.arange(given.size) / rate, order)
