"""A recorded loop as it is compared: smoothed motion, force at independent samples, and blocks of cycles."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from math import ceil, sqrt
from typing import Self

import numpy as np
from scipy.ndimage import shift

from wedgesweep import systems
from wedgesweep.config import Config
from wedgesweep.diagnose.fit_parameters import Values
from wedgesweep.diagnose.loop import motion_noise
from wedgesweep.diagnose.loop.force_noise import of_force
from wedgesweep.diagnose.loop.motion_noise import Derivatives
from wedgesweep.diagnose.noise_spectrum import FROM_REPEATS, NoiseSpectrum, of_noise, white_noise
from wedgesweep.diagnose.sampled_data import MOST_BLOCKS, Decorrelation, decorrelation
from wedgesweep.diagnose.smoothing import LowPass, Motion, chosen_cutoff, continuous, motion, noise_of_motion
from wedgesweep.effects import channel_delay, force_gain, merge
from wedgesweep.errors import InputError
from wedgesweep.measured import TestRecord, quality
from wedgesweep.measured.signals import marked_runs
from wedgesweep.solvers import imposed_motion

# Below AT_REST standard deviations of its noise the velocity has no sign. Where it stays there for more than
# one compared sample the mass may rest, and friction is not known.
AT_REST = 3.0
# The same over the largest velocity: however exact the displacement, a low-pass rings on after a stop.
RESTS = 3e-3
# Change of a part of the motion for its derivative, over its largest value, where it has no noise.
LEAST_CHANGE = 1e-9
# Fewest samples with a known friction that make a loop.
FEWEST_KNOWN = 24
# A reversal counts if the velocity goes beyond this share of its peak on both sides.
REVERSAL = 0.1
# Standard deviation of the deflection of bristles at the start of a record, which nobody knows, as a share of
# the largest one: anything between both ends is as likely.
DEFLECTED = 1.0 / sqrt(3.0)
# Error of a simulation over the rms of the force, which counts as noise.
SIMULATED = 1e-4
# Effects of the channels, and their numbers where they are off.
FORCE_GAIN, CHANNEL_DELAY = force_gain.EFFECT.name, channel_delay.NAME
NO_GAIN, NO_DELAY = force_gain.EFFECT.off, channel_delay.EFFECT.off
NO_NOISE = NoiseSpectrum(0.0, 0.0, 0.0)


@dataclass(frozen=True, eq=False)
class StartError:
    """Error (k,) (N) of compared forces, as nobody knows how far bristles are deflected at the start.

    ``in_proportion``: what one number tells of all of them, in Dahl's model throughout, and as long as no
    spring's slider slips; ``bent``: beside it, as a slider forgets the start when it slips.
    """

    in_proportion: np.ndarray
    bent: np.ndarray

    def covariance(self, rows: np.ndarray) -> np.ndarray:
        """Covariance (N^2) of some forces (r,), (r, r)."""
        own = self.in_proportion[rows]
        return np.outer(own, own) + np.diag(self.bent[rows] ** 2)


@dataclass(frozen=True, eq=False)
class Recording:
    """One test.

    ``model``: the base model with the numbers of the test; ``noise_of_displacement`` (m); ``places`` (k,):
    samples of the motion at which the ``force`` (k,) is compared; ``spectrum`` of its noise there, beside
    what noise of the motion has ``passed_on`` (L, k), see ``motion_noise.covariance``; ``known`` (k,):
    whether friction is, which it is not where the mass may rest; ``blocks``: slices of the k samples, whole
    cycles each; ``white`` (N): noise of the force at the places as frequencies above the filter show it;
    ``differences``: what repeats leave of the force at the places; ``error_of_start``: by bristles whose
    deflection at the start of the record is not known, None without bristles; ``noise_as_stated`` (N): of a
    compared force under the base model as stated.
    """

    name: str
    model: Config
    law: str
    low_pass: LowPass
    motion: Motion
    noise_of_displacement: float
    places: np.ndarray
    force: np.ndarray
    known: np.ndarray
    blocks: tuple[slice, ...]
    passed_on: np.ndarray
    white: float = 0.0
    differences: tuple[np.ndarray, ...] = ()
    spectrum: NoiseSpectrum = NO_NOISE
    error_of_start: StartError | None = None
    noise_as_stated: float = 0.0

    @property
    def noise(self) -> float:
        """Standard deviation (N) of a compared force."""
        own = self.passed_on[0][self.known]
        return float(np.sqrt(self.spectrum.covariance(np.zeros(1, int))[0] + own.mean()))

    @property
    def noise_share(self) -> float:
        """Noise over the rms of the force, both where friction is known."""
        return self.noise / float(self.force[self.known].std())

    def _covariance(self, rows: np.ndarray) -> np.ndarray:
        """Covariance (N^2) of some compared forces (r,) with one another, (r, r)."""
        distance = np.abs(rows[:, None] - rows)
        found = self.spectrum.covariance(distance) + motion_noise.between(self.passed_on, rows)
        return found if self.error_of_start is None else found + self.error_of_start.covariance(rows)

    @cached_property
    def decorrelated(self) -> tuple[Decorrelation, ...]:
        """Independent combinations of the compared forces of each block."""
        return tuple(self._decorrelated(block) for block in self.blocks)

    def _decorrelated(self, block: slice) -> Decorrelation:
        least = (SIMULATED * float(self.force.std())) ** 2
        return decorrelation(self.known[block], lambda rows: self._covariance(block.start + rows), least)

    @property
    def half_range(self) -> float:
        """Half the range (m) of the motion."""
        return 0.5 * float(np.ptp(self.motion.displacement))

    def renewed(self, values: Values, zeros: np.ndarray) -> Self:
        """The test with the noise that its force has beside that of a scenario.

        ``zeros`` (blocks,): what to add to the displacement (m) in each block.
        """
        found = self.with_noise_of_motion(values, zeros)
        if self.differences:
            return replace(found, spectrum=of_noise(self.differences, FROM_REPEATS))
        model = np.nan_to_num(self._forces([values], zeros[None], self.motion.parts)[0])
        return replace(found, spectrum=of_force(found, model))

    def with_noise_of_motion(self, values: Values, zeros: np.ndarray) -> Self:
        """The test with the errors of the force of a scenario: by noise of the motion, and by its start."""
        derivatives = self._derivatives(values, zeros[None])
        passed_on = motion_noise.covariance(
            self.low_pass, self.places, self.noise_of_displacement, derivatives
        )
        error = self._error_of_start(values, zeros[None])
        return replace(self, passed_on=passed_on, error_of_start=error)

    def _error_of_start(self, values: Values, zeros: np.ndarray) -> StartError | None:
        """Error of compared forces by bristles' deflection at the start; None if there are no bristles."""

        def compared(deflected: float) -> np.ndarray:
            forces = self._forces([values], zeros, self.motion.parts, deflected)
            return np.nan_to_num(self._compared(forces)[0])

        half, half_back = compared(0.5), compared(-0.5)
        if np.array_equal(half, half_back):
            return None
        none = compared(0.0)
        bent = [compared(1.0) + none - 2.0 * half, compared(-1.0) + none - 2.0 * half_back]
        return StartError(DEFLECTED * (half - half_back), np.abs(bent).max(axis=0))

    def _derivatives(self, values: Values, zeros: np.ndarray) -> Derivatives:
        """Derivatives of the force of a scenario, over as much as noise changes each part of the motion.

        Bristles follow noise of the displacement, and begin where they reversed, which noise misplaces as
        much; that of the velocity moves them to and fro.
        """
        parts = self.motion.parts
        force = self._forces([values], zeros, parts)[0]
        changes = [
            max(noise, LEAST_CHANGE * float(np.abs(own).max()))
            for noise, own in zip(self.motion.noise, parts, strict=True)
        ]
        further = self._forces([values], zeros, parts, ahead=changes[0])[0]
        by_bristles = sqrt(2.0) * np.nan_to_num(further - force) / changes[0] * np.sign(parts[1])
        to_and_fro = _to_and_fro(parts[1], changes[1]) if by_bristles.any() else 1.0
        found = []
        for order, own in enumerate(parts):
            step = changes[order] * (to_and_fro if order == 1 else 1.0)
            above, below = (
                self._forces([values], zeros, (*parts[:order], moved, *parts[order + 1 :]))[0]
                for moved in (own + step, own - step)
            )
            found.append(np.nan_to_num((above - below) / (2.0 * step)))
        jumps = motion_noise.jumps(np.nan_to_num(force))
        return Derivatives((found[0] + by_bristles, found[1], found[2]), jumps)

    def simulated(self, scenarios: list[Values], zeros: np.ndarray) -> np.ndarray:
        """Forces (n, k) under the values of n scenarios; NaN where they are not determined.

        ``zeros`` (n, blocks): what to add to the displacement (m) in each block.
        """
        forces = self._forces(scenarios, zeros, self.motion.parts)
        delays = [values.get(CHANNEL_DELAY, NO_DELAY)["time"] for values in scenarios]
        gains = np.array([values.get(FORCE_GAIN, NO_GAIN)["scale"] for values in scenarios])
        return gains[:, None] * self._compared(forces, delays)

    def _forces(
        self,
        scenarios: list[Values],
        zeros: np.ndarray,
        parts: tuple[np.ndarray, ...],
        deflected: float = 0.0,
        ahead: float = 0.0,
    ) -> np.ndarray:
        """Forces (n, N) along a motion of some displacement, velocity and acceleration (N,).

        ``deflected`` and ``ahead``: see ``imposed_motion.forces``.
        """
        rows = np.concatenate(
            [self.model.record_with(merge(self.model.effects, each), self.law, 0.0) for each in scenarios]
        )
        sign, (displacement, velocity, acceleration) = _sign(self.model), parts
        places = sign * (displacement + zeros[:, self._block])
        step = 1.0 / self.low_pass.rate
        motion = sign * velocity, sign * acceleration
        return imposed_motion.forces(rows, places, *motion, step, deflected, ahead)

    @cached_property
    def _block(self) -> np.ndarray:
        """The block of each sample, (N,); what lies before or after all blocks belongs to the nearest."""
        first = [self.places[block.start] for block in self.blocks[1:]]
        return np.searchsorted(first, np.arange(self.motion.velocity.size), side="right")

    def _compared(self, forces: np.ndarray, delays: Sequence[float] = ()) -> np.ndarray:
        """Forces (n, N) along the motion as they are compared, some time (s) late each."""
        lost = np.isnan(forces)
        if lost.any():
            forces = _without_short_gaps(forces, self.low_pass.stride)
            lost = np.isnan(forces)
        found, samples = self.low_pass(np.where(lost, 0.0, forces)), self.low_pass.rate * np.array(delays)
        for row in np.flatnonzero(samples):
            found[row] = shift(found[row], samples[row], order=5, mode="nearest")
        found = found[:, self.places]
        if lost.any():
            late = ceil(np.abs(samples).max(initial=0.0))
            reach = np.ones(2 * (self.low_pass.settling + late) + 1)
            near = np.array([np.convolve(row, reach, mode="same") > 0.5 for row in lost])
            found[near[:, self.places]] = np.nan
        return found


def recording(test: TestRecord, model: Config, law: str, differences: Sequence[np.ndarray] = ()) -> Recording:
    """Prepare a test, whose filter is as high as the noise of the displacement allows, unless it is stated.

    ``differences``: what repeats of the test leave of its force (N), which is noise; without them it is what
    no smooth function of the motion explains. Raises InputError for a record that is too short, hardly moves,
    or is nothing but noise.
    """
    assert test.displacement is not None
    assert test.force is not None
    displacement, force, rate = test.displacement, test.force, test.sampling_rate
    mass = moving_mass(model, law)
    noise = white_noise(displacement)
    low_pass = LowPass(
        test.cutoff or chosen_cutoff(displacement, noise, float(force.std()), mass, rate), rate
    )
    if test.velocity is not None:  # it was integrated: what white noise of a place makes of the velocity
        of_velocity, _, _ = noise_of_motion(white_noise(test.velocity), low_pass)
        noise = of_velocity / noise_of_motion(1.0, low_pass)[1]
    ends = low_pass.settling
    places = np.arange(ends, displacement.size - ends, low_pass.stride)
    if not places.size:
        problem = f"{displacement.size} samples are too few for a low-pass of {low_pass.cutoff:.3g} Hz"
        raise InputError([f"{problem}; record for longer, or raise lowpass_hz"])
    own = motion(displacement, noise, low_pass)
    compared = low_pass(force)[places]
    known = ~(at_rest(own, low_pass) | _spread(quality.clipped(force), low_pass.stride))[places]
    if known.sum() < FEWEST_KNOWN:
        problem = f"its motion is no faster than its noise ({1e3 * own.noise[1]:.3g} mm/s) for long"
        raise InputError([f"{problem}; move it faster, or measure it with less noise"])
    blocks = _blocks(own.velocity[places])
    white = low_pass.noise(white_noise(continuous(force)))
    left = tuple(low_pass(each)[ends : -ends : low_pass.stride] for each in differences)
    exact = np.zeros((1, places.size))
    found = Recording(
        test.name, model, law, low_pass, own, noise, places, compared, known, blocks, exact, white, left
    ).renewed({}, np.zeros(len(blocks)))
    if found.noise_share > 1.0:
        problem = f"its noise is {100.0 * found.noise_share:.0f} % of the force, so that it shows nothing"
        raise InputError([f"{problem}; measure a larger force, lower lowpass_hz, or correct the columns"])
    return replace(found, noise_as_stated=found.noise)


def _without_short_gaps(forces: np.ndarray, longest: int) -> np.ndarray:
    """Forces (n, N), interpolated where they are not determined for at most some samples in a row.

    Where a contact force is about zero, noise of the motion makes it negative in single samples. A face that
    lifts off, or a mass that rests, is there for more than one compared sample.
    """
    found = forces.copy()
    for row in np.flatnonzero(np.isnan(found).any(axis=1)).tolist():
        own = found[row]
        for first, last in marked_runs(np.isnan(own)).tolist():
            if last - first <= longest and first > 0 and last < own.size:
                own[first:last] = np.interp(range(first, last), [first - 1, last], own[[first - 1, last]])
    return found


def _spread(marked: np.ndarray, reach: int) -> np.ndarray:
    """Samples (n,) within a reach of marked ones."""
    return np.convolve(marked, np.ones(2 * reach + 1), mode="same") > 0.5


def moving_mass(model: Config, law: str) -> float:
    """Mass (kg) that an imposed motion accelerates."""
    return float(systems.moving_mass(model.record_with(model.effects, law))[0])


def _to_and_fro(velocity: np.ndarray, change: float) -> np.ndarray:
    """Signs (n,) from sample to sample of a change of the velocity (n,), whose mean moves nothing elastic.

    Where the change moves a reversal, it keeps its sign.
    """
    before, after = velocity[:-1], velocity[1:]
    reverses = (before * after <= 0.0) | (np.minimum(np.abs(before), np.abs(after)) <= change)
    return np.cumprod(np.r_[1.0, np.where(reverses, 1.0, -1.0)])


def _sign(model: Config) -> float:
    """Sign of the simulated motion over that of the recorded one."""
    return 1.0 if model.system == "oscillator" else -1.0


def at_rest(motion: Motion, low_pass: LowPass) -> np.ndarray:
    """Whether (n,) the mass may rest at or near a sample: its velocity has no sign for a while."""
    speed = np.abs(motion.velocity)
    slow = speed <= max(AT_REST * motion.noise[1], RESTS * float(speed.max()))
    found = np.zeros(slow.size, bool)
    for first, last in marked_runs(slow).tolist():
        if last - first > low_pass.stride:
            found[max(first - low_pass.stride, 0) : last + low_pass.stride] = True
    return found


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
