"""Tables of tests that are not steady: what the sensors record of transients and loops."""

import numpy as np

from wedgesweep.measured.declarations import LOOP
from wedgesweep.sampled_input import from_samples
from wedgesweep.synthesize import loops, noise, transients
from wedgesweep.synthesize.files import Table
from wedgesweep.synthesize.options import FORCE, QUANTITIES, Options
from wedgesweep.synthesize.truth import TrueTest, Truth

# Default sampling rate over that of a steady test, which is shorter.
SAMPLING_SHARE = 0.25
# Relative noise of a loop's displacement over that of its force: a displacement sensor is far better.
DISPLACEMENT_NOISE = 0.003


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
    displacement, force = loops.loop(truth.config, truth.law, truth.effects, test.plan, rate)
    force = force + (level * test.random.normal(size=force.size) + test.offset) * force.std()
    displacement = displacement + DISPLACEMENT_NOISE * level * displacement.std() * test.random.normal(
        size=force.size
    )
    return Table(np.arange(force.size) / rate, 1e3 * displacement, None, None, force)


def _recorded(given: np.ndarray, rate: float, quantity: str) -> np.ndarray:
    """An input (m or N) as the quantity that is recorded."""
    order = 0 if quantity == FORCE else QUANTITIES.index(quantity)
    if order == 0:
        return given
    return from_samples(given, 1.0 / rate)(np.arange(given.size) / rate, order)
