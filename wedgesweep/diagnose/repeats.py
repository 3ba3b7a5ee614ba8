"""Spread between repeats of a test: a component of variance of its own beside noise and errors of the model.

Repeats are steady tests, or loops, of one frequency and amplitude with the same numbers of the model; between
them a rig may have been taken apart, or left for a day. Their harmonics, turned to the same phase, differ by
noise and by what changes from run to run. No model takes part: the mean square of the differences less what
noise leaves is the spread (a one-way analysis of variance, by moments). What changes may have one shape in
all numbers of a run, as another level of friction has; a run therefore counts as one observation.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from math import sqrt
from typing import NamedTuple

import numpy as np
from scipy.special import chdtri

from wedgesweep.diagnose.noise_spectrum import repeat_groups
from wedgesweep.measured import Measurement, TestRecord
from wedgesweep.measured.cycles import cut
from wedgesweep.measured.declarations import LOOP, STEADY
from wedgesweep.measured.frequency import FEWEST_CYCLES

# Frequencies and amplitudes that are the same, but for this share; a stated amplitude that is known better
# than that share of it, so that responses do not differ by the input.
SAME_FREQUENCY, SAME_AMPLITUDE, KNOWN = 2e-3, 1e-2, 2e-3
# Largest spread, over the response, of tests that repeat one another: where they differ by more, so may a
# load or a pressure that the model is not told.
MOST = 0.1


@dataclass(frozen=True)
class Spread:
    """Rms of what differs between runs, over that of the response, and its 95 % interval.

    ``repeats``: names of the tests that repeat one another.
    """

    share: float
    interval: tuple[float, float]
    repeats: tuple[tuple[str, ...], ...]

    @property
    def counts(self) -> bool:
        """Whether runs differ by more than noise, and by no more than runs of one test may."""
        return self.interval[0] > 0.0 and self.share <= MOST

    def left_to_model(self, accuracy: float) -> float:
        """What an accuracy leaves to the model, once the spread is taken off."""
        return sqrt(max(accuracy**2 - self.share**2, 0.0))

    def allowed_in(self, measurement: Measurement) -> Measurement:
        """The measurement, its models allowed an error as large as runs differ: no cause is to explain it."""
        if not self.counts:
            return measurement
        return replace(measurement, model_error=float(np.hypot(measurement.model_error, self.share)))


class _Run(NamedTuple):
    """A test that others may repeat.

    ``reference`` (n,): channel whose phase is that of the input; ``amplitude``: of the input, m or that of
    the reference. ``scaled``: whether that is the input, to whose amplitude responses (C, n) belong.
    """

    test: TestRecord
    reference: np.ndarray
    amplitude: float
    scaled: bool
    responses: np.ndarray

    def repeats(self, other: "_Run") -> bool:
        one, two = self.test, other.test
        return (
            (one.kind, dict(one.model)) == (two.kind, dict(two.model))
            and abs(one.refined_frequency / two.refined_frequency - 1.0) < SAME_FREQUENCY
            and abs(self.amplitude / other.amplitude - 1.0) < SAME_AMPLITUDE
        )

    def harmonics(self) -> tuple[np.ndarray, np.ndarray]:
        """Harmonics (C, H) from phase 0 of the input, per unit of its amplitude if known, and variances."""
        time, frequency = self.test.time, self.test.refined_frequency
        turned = cut(time, self.reference, frequency).harmonics[:, 0].mean()
        cycles = np.array([cut(time, samples, frequency).harmonics for samples in self.responses])
        size = abs(turned) if self.scaled else 1.0
        turns = np.exp(-1j * np.angle(turned) * np.arange(1, cycles.shape[-1] + 1))
        variance = cycles.var(axis=1, ddof=1) / cycles.shape[1]
        return cycles.mean(axis=1) * turns / size, variance / size**2


def spread_of(measurement: Measurement) -> Spread | None:
    """Spread between the repeats of a measurement; None without any."""
    groups = [group for group in _groups(_runs(measurement)) if len(group) > 1]
    if not groups:
        return None
    squares, noise = np.sum([_squares(group) for group in groups], axis=0)
    dof = sum(len(group) - 1 for group in groups)
    low, high = (_share(squares / float(chdtri(dof, tail)), noise / dof) for tail in (0.025, 0.975))
    names = tuple(tuple(run.test.name for run in group) for group in groups)
    return Spread(_share(squares / dof, noise / dof), (low, high), names)


def _share(squares: float, noise: float) -> float:
    return sqrt(max(squares - noise, 0.0))


def _runs(measurement: Measurement) -> Iterator[_Run]:
    """Tests whose input is known; where ``repeat_of`` is stated all that differs counts as noise already."""
    in_noise = {place for group in repeat_groups(measurement.tests) for place in group}
    for place, test in enumerate(measurement.tests):
        if place not in in_noise and (run := _run(measurement, test)) is not None:
            yield run


def _run(measurement: Measurement, test: TestRecord) -> _Run | None:
    """A test as a run; None if its input is not known, or it has too few cycles."""
    if test.kind not in (LOOP, STEADY):
        return None
    if not test.duration * test.refined_frequency > FEWEST_CYCLES - 0.5:  # NaN: nothing repeats in it
        return None
    if test.kind == LOOP and test.displacement is not None and test.force is not None:
        return _Run(test, test.displacement, float(test.displacement.std()), True, test.force[None])
    responses = np.array([test.responses[name] for name in measurement.compared(test)])
    if test.input is not None:
        return _Run(test, test.input, float(test.input.std()), True, responses)
    if test.amplitude is None or test.amplitude_std > KNOWN:
        return None
    return _Run(test, responses[0], test.amplitude, False, responses)


def _groups(runs: Iterator[_Run]) -> list[list[_Run]]:
    found: list[list[_Run]] = []
    for run in runs:
        own = next((group for group in found if group[0].repeats(run)), None)
        if own is None:
            found.append([run])
        else:
            own.append(run)
    return found


def _squares(group: Sequence[_Run]) -> tuple[float, float]:
    """Sum of squares of n runs about their mean, over the square of the response, and what noise leaves."""
    both = [run.harmonics() for run in group]
    columns = min(mean.shape[1] for mean, _ in both)
    means, variances = (np.array([each[i][:, :columns] for each in both]) for i in (0, 1))
    power = (np.abs(means) ** 2).mean(axis=0).sum(axis=-1)
    about = (np.abs(means - means.mean(axis=0)) ** 2).sum(axis=(0, 2))
    noise = (1.0 - 1.0 / len(group)) * variances.sum(axis=(0, 2))
    return float((about / power).mean()), float((noise / power).mean())
