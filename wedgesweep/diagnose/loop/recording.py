"""A recorded loop as it is compared: smoothed motion, force at independent samples, and blocks of cycles."""

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from math import hypot

import numpy as np

from wedgesweep import systems
from wedgesweep.config import Config
from wedgesweep.diagnose.fit_parameters import Values
from wedgesweep.diagnose.smoothing import LowPass, Motion, highest_cutoff, motion, white_noise
from wedgesweep.effects import merge
from wedgesweep.errors import InputError
from wedgesweep.solvers import imposed_motion

# Below so many standard deviations of its noise the velocity has no sign, and friction is not known.
AT_REST = 3.0
# Compared samples to either side that the filter lets such a sample spoil.
REACH = 2
# A reversal counts if the velocity goes beyond this share of its peak on both sides.
REVERSAL = 0.1
# Blocks of a record that are left out in turn, at most.
MOST_BLOCKS = 12


@dataclass(frozen=True, eq=False)
class Recording:
    """One test.

    ``model``: the base model with the numbers of the test; ``places`` (k,): samples of the motion at which
    the ``force`` (k,) is compared; ``noise``: its std (N); ``blocks``: slices of the k samples, whole cycles
    of the motion each.
    """

    name: str
    model: Config
    law: str
    low_pass: LowPass
    motion: Motion
    places: np.ndarray
    force: np.ndarray
    noise: float
    blocks: tuple[slice, ...]

    @cached_property
    def known(self) -> np.ndarray:
        """Whether friction is known at each compared sample, (k,): not where the mass rests or turns.

        Noise shifts the time of a turn, and dry friction jumps there.
        """
        own = self.motion
        within = AT_REST * own.velocity_noise + 0.5 * np.abs(own.acceleration) / self.low_pass.rate
        slow = np.abs(own.velocity) <= within
        near = np.convolve(slow, np.ones(2 * REACH * self.low_pass.stride + 1), mode="same") > 0.5
        return ~near[self.places]

    def simulated(self, scenarios: list[Values]) -> np.ndarray:
        """Forces (n, k) under the values of n scenarios; NaN where they are not determined."""
        rows = np.concatenate(
            [self.model.record_with(merge(self.model.effects, each), self.law, 0.0) for each in scenarios]
        )
        own = self.motion
        sign = 1.0 if self.model.system == "oscillator" else -1.0
        forces = imposed_motion.forces(
            rows,
            sign * own.displacement,
            sign * own.velocity,
            sign * own.acceleration,
            1.0 / self.low_pass.rate,
        )
        return self._compared(forces)

    def _compared(self, forces: np.ndarray) -> np.ndarray:
        """Forces (n, N) along the motion as they are compared."""
        lost = np.isnan(forces)
        found = self.low_pass(np.where(lost, 0.0, forces))[:, self.places]
        if lost.any():
            reach = np.ones(2 * self.low_pass.settling + 1)
            near = np.array([np.convolve(row, reach, mode="same") > 0.5 for row in lost])
            found[near[:, self.places]] = np.nan
        return found


def recording(
    name: str,
    model: Config,
    law: str,
    rate: float,
    samples: tuple[np.ndarray, np.ndarray],
    cutoff: float | None,
) -> Recording:
    """Prepare a test.

    Parameters
    ----------
    name, model, law
        See ``Recording``.
    rate : float
        Sampling rate (Hz).
    samples : tuple of ndarray, shape (n,) each
        Displacement (m) and force (N).
    cutoff : float, optional
        Cut-off frequency (Hz); by default as high as the noise of the displacement allows.
    """
    displacement, force = samples
    mass = float(systems.moving_mass(model.record_with(model.effects, law))[0])
    noise = white_noise(displacement, rate)
    low_pass = LowPass(cutoff or highest_cutoff(noise, float(force.std()), mass, rate), rate)
    own = motion(displacement, noise, low_pass)
    ends = low_pass.settling
    places = np.arange(ends, displacement.size - ends, low_pass.stride)
    if not places.size:
        told = f"{displacement.size} samples are too few for a low-pass of {low_pass.cutoff:.3g} Hz"
        raise InputError([f"{name}: {told}; record for longer, or raise lowpass_hz"])
    std = hypot(low_pass.noise(white_noise(force, rate)), mass * own.acceleration_noise)
    blocks = _blocks(own.velocity[places])
    return Recording(name, model, law, low_pass, own, places, low_pass(force)[places], std, blocks)


def _blocks(velocity: np.ndarray) -> tuple[slice, ...]:
    """Slices of the samples (k,) with whole cycles of the motion each."""
    clear = np.flatnonzero(np.abs(velocity) > REVERSAL * np.abs(velocity).max())
    turns = clear[1:][np.diff(np.sign(velocity[clear])) != 0.0]
    cycles = turns[1::2]
    per_block = max(-(-cycles.size // MOST_BLOCKS), 1)
    edges = [0, *cycles[per_block - 1 :: per_block].tolist(), velocity.size]
    # What is left after the last whole cycle belongs to the last block.
    if len(edges) > 2 and edges[-1] - edges[-2] < 0.5 * (edges[-2] - edges[-3]):
        del edges[-2]
    return tuple(slice(first, last) for first, last in pairwise(edges))
