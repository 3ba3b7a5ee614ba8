"""Hysteresis loops of the true system: the force under a motion that is imposed on the mass."""

from collections.abc import Mapping
from math import pi

import numpy as np

from wedgesweep.config import Config
from wedgesweep.solvers import imposed_motion
from wedgesweep.synthesize.motion import NoMotion, sines
from wedgesweep.synthesize.plan import PlannedTest

# Steps of the motion for each sample, over which force and displacement are averaged.
CELLS = 10
# A second sine in the motion, so that it reverses at many places: frequency and amplitude over those of the
# first, and phase (rad).
SECOND_FREQUENCY, SECOND_AMPLITUDE, SECOND_PHASE = 0.37, 0.3, 1.0


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
