"""A recorded loop as it is compared: smoothed motion, force at independent samples, and blocks of cycles."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from wedgesweep import systems
from wedgesweep.config import Config
from wedgesweep.diagnose.decorrelation import Decorrelation, decorrelation
from wedgesweep.diagnose.fit_parameters import Values
from wedgesweep.diagnose.loop.force_noise import MotionNoise, impedance, of_force
from wedgesweep.diagnose.noise_spectrum import FROM_REPEATS, NoiseSpectrum, of_noise
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
    the ``force`` (k,) is compared; ``spectrum`` of its noise there, beside what noise of the motion has
    ``passed_on``; ``known`` (k,): whether friction is; it is not where the mass rests or turns; ``blocks``:
    slices of the k samples, whole cycles each; ``least``: variance (N^2) of a compared number.
    """

    name: str
    model: Config
    law: str
    low_pass: LowPass
    motion: Motion
    places: np.ndarray
    force: np.ndarray
    spectrum: NoiseSpectrum
    passed_on: MotionNoise
    least: float
    known: np.ndarray
    blocks: tuple[slice, ...]

    @property
    def noise(self) -> float:
        """Standard deviation (N) of a compared force."""
        return float(np.sqrt(self._covariance(np.zeros(1, int))[0]))

    def _covariance(self, distance: np.ndarray) -> np.ndarray:
        """Covariance (N^2) of two compared forces by their distance."""
        return self.spectrum.covariance(distance) + self.passed_on.covariance(distance)

    @cached_property
    def decorrelated(self) -> tuple[Decorrelation, ...]:
        """Independent combinations of the compared forces of each block."""
        return tuple(decorrelation(self.known[block], self._covariance, self.least) for block in self.blocks)

    @property
    def half_range(self) -> float:
        """Half the range (m) of the motion."""
        return 0.5 * float(np.ptp(self.motion.displacement))

    def simulated(self, scenarios: list[Values], zeros: np.ndarray) -> np.ndarray:
        """Forces (n, k) under the values of n scenarios; NaN where they are not determined.

        ``zeros`` (n, blocks): what to add to the displacement (m) in each block.
        """
        rows = np.concatenate(
            [self.model.record_with(merge(self.model.effects, each), self.law, 0.0) for each in scenarios]
        )
        own = self.motion
        sign = _sign(self.model)
        forces = imposed_motion.forces(
            rows,
            sign * (own.displacement + zeros[:, self._block]),
            sign * own.velocity,
            sign * own.acceleration,
            1.0 / self.low_pass.rate,
        )
        return self._compared(forces)

    @cached_property
    def _block(self) -> np.ndarray:
        """The block of each sample, (N,); what lies before or after all blocks belongs to the nearest."""
        first = [self.places[block.start] for block in self.blocks[1:]]
        return np.searchsorted(first, np.arange(self.motion.velocity.size), side="right")

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
    differences: Sequence[np.ndarray] = (),
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
    differences : sequence of ndarray
        What repeats of the test leave of its force (N), which is noise; without them it is what no smooth
        function of the motion explains.
    """
    displacement, force = samples
    mass = moving_mass(model, law)
    noise = white_noise(displacement, rate)
    low_pass = LowPass(cutoff or highest_cutoff(noise, float(force.std()), mass, rate), rate)
    own = motion(displacement, noise, low_pass)
    ends = low_pass.settling
    places = np.arange(ends, displacement.size - ends, low_pass.stride)
    if not places.size:
        told = f"{displacement.size} samples are too few for a low-pass of {low_pass.cutoff:.3g} Hz"
        raise InputError([f"{name}: {told}; record for longer, or raise lowpass_hz"])
    smooth, clear = low_pass(force), ~slow(own, low_pass)[places]
    compared = smooth[places]
    passed_on = MotionNoise(low_pass, impedance(own, smooth, _sign(model) * mass), noise)
    if differences:
        left = [low_pass(each)[ends : -ends : low_pass.stride] for each in differences]
        found = of_noise(left, FROM_REPEATS, passed_on.power)
    else:
        found = of_force(own, compared, places, clear, passed_on)
    # White noise of the force; errors at reversals have a wide spectrum.
    least = low_pass.noise(white_noise(force, rate)) ** 2 + (mass * own.acceleration_noise) ** 2
    blocks = _blocks(own.velocity[places])
    noises = found, passed_on, least
    return Recording(name, model, law, low_pass, own, places, compared, *noises, clear, blocks)


def moving_mass(model: Config, law: str) -> float:
    """Mass (kg) that an imposed motion accelerates."""
    return float(systems.moving_mass(model.record_with(model.effects, law))[0])


def _sign(model: Config) -> float:
    """Sign of the simulated motion over that of the recorded one."""
    return 1.0 if model.system == "oscillator" else -1.0


def slow(motion: Motion, low_pass: LowPass) -> np.ndarray:
    """Whether (n,) the mass rests or turns at or near a sample: noise shifts the time of a turn."""
    within = AT_REST * motion.velocity_noise + 0.5 * np.abs(motion.acceleration) / low_pass.rate
    slow = np.abs(motion.velocity) <= within
    return np.convolve(slow, np.ones(2 * REACH * low_pass.stride + 1), mode="same") > 0.5


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
