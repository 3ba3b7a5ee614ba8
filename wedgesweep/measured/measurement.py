"""What measured data consist of, in SI units."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from wedgesweep.config import Config
from wedgesweep.effects import channel_delay
from wedgesweep.errors import InputError
from wedgesweep.measured.declarations import MIXED, MOTIONS, RELATIVE, columns_of
from wedgesweep.measured.frequency import refined_frequency
from wedgesweep.measured.model import with_numbers


class MeasuredError(InputError):
    """Measured data that cannot be used."""


@dataclass(frozen=True, eq=False)
class TestRecord:
    """One record: of steady vibration, of a free motion, or of the force under an imposed motion.

    ``frequency`` (Hz) and ``amplitude`` (m of the base, N of a force) are None where they are not known;
    ``amplitude_std`` is relative. ``time`` (s) is the even grid that the file's stamps round, shape (n,);
    ``displacement`` (m, with the sensor's constant part; for a suspension x - y) and ``velocity`` (m/s) are
    samples at these times, and so are ``acceleration`` (m/s^2) and the recorded ``input`` (SI); None where
    not measured. ``model``: numbers of the base model in this test, by "section.key", in its units.
    ``kind``: of test; ``force`` (N) and ``cutoff`` (Hz, of a low-pass filter; None: chosen) are a loop's.
    ``normal_force`` (N): of a column, whose zero has the standard deviation ``zero_std`` (N).
    ``recorded_s``: length (s) of the file's record, None if all of it is used. ``repeat_of``: file of the
    test that this one repeats.
    """

    __test__ = False  # not a test of pytest

    name: str
    file: str
    frequency: float | None
    amplitude: float | None
    amplitude_std: float
    time: np.ndarray
    displacement: np.ndarray | None
    velocity: np.ndarray | None
    acceleration: np.ndarray | None = None
    input: np.ndarray | None = None
    model: Mapping[str, float] = field(default_factory=dict)
    kind: str = "steady"
    force: np.ndarray | None = None
    cutoff: float | None = None
    recorded_s: float | None = None
    repeat_of: str | None = None
    normal_force: np.ndarray | None = None
    zero_std: float = 0.0
    remarks: tuple[str, ...] = ()

    @cached_property
    def refined_frequency(self) -> float:
        """Frequency (Hz): the stated one, unless none is stated or the record excludes it."""
        return refined_frequency(self.time, self.leading, self.frequency)

    @property
    def leading(self) -> np.ndarray:
        """The channel (n,) that tells the frequency: the recorded input, or the first response."""
        return next(iter(self.channels.values()))

    @property
    def responses(self) -> dict[str, np.ndarray]:
        """The measured responses (n,) by name."""
        named = {name: getattr(self, name) for name in MOTIONS}
        return {name: samples for name, samples in named.items() if samples is not None}

    @property
    def channels(self) -> dict[str, np.ndarray]:
        """The measured channels (n,) by name: a recorded input, then the responses."""
        return ({} if self.input is None else {"input": self.input}) | self.responses

    @property
    def sampling_rate(self) -> float:
        """Samples per second."""
        return float((self.time.size - 1) / (self.time[-1] - self.time[0]))

    @property
    def duration(self) -> float:
        """Time (s) that the samples stand for, one sampling interval each."""
        return self.time.size / self.sampling_rate


@dataclass(frozen=True, eq=False)
class Measurement:
    """Tests of one rig, and the base model.

    ``law`` is the model's friction law; ``uncertain`` holds the relative std of numbers of the model by
    the name of the effect that scales them; ``columns`` the CSV header name and unit of each channel, with
    ``of`` of responses and ``quantity`` of the input. ``input_gain_std``: of a recorded input, relative.
    ``input_harmonics_std``: of each harmonic of a stated input, over its amplitude. ``model_error``: the
    relative error that a model may have. ``delay_std`` (s): of the delay between channels; 0 if it is known.
    """

    path: Path
    title: str
    model: Config
    law: str
    uncertain: Mapping[str, float]
    tests: tuple[TestRecord, ...]
    derived_velocity: bool
    columns: Mapping[str, Mapping[str, str]]
    input_gain_std: float = 0.0
    input_harmonics_std: float = 0.0
    model_error: float = 0.0
    delay_std: float = 0.0

    @property
    def uncertain_of_records(self) -> dict[str, float]:
        """Standard deviations of uncertain numbers of the model, and of the delay (s) between channels."""
        return dict(self.uncertain) | ({channel_delay.NAME: self.delay_std} if self.delay_std else {})

    @property
    def kinds(self) -> tuple[str, ...]:
        """Kinds of the tests, in the order of their first ones."""
        return tuple(dict.fromkeys(test.kind for test in self.tests))

    @property
    def kind(self) -> str:
        """Kind of all tests, or MIXED."""
        return self.kinds[0] if len(self.kinds) == 1 else MIXED

    def of_kind(self, kind: str) -> "Measurement":
        """The tests of one kind, with the channels that they have."""
        tests = tuple(test for test in self.tests if test.kind == kind)
        columns = columns_of(self.columns, kind, len(self.kinds) == 1)
        return replace(self, tests=tests, columns=columns)

    @property
    def recorded_input(self) -> str | None:
        """What was recorded of the input, None if its amplitude is stated instead."""
        return self.columns["input"]["quantity"] if "input" in self.columns else None

    def compared(self, test: TestRecord) -> list[str]:
        """Names of the responses of a test that are measurements of their own."""
        return [name for name in test.responses if name != "velocity" or not self.derived_velocity]

    def motion_of(self, channel: str) -> str:
        """The motion that a channel shows: RELATIVE to the base, or ABSOLUTE."""
        column = self.columns.get(channel) or self.columns["velocity"]  # of which it is the integral
        return column.get("of", RELATIVE)

    def factors_of(self, channel: str) -> tuple[float, float]:
        """Factors of a channel and of the input's displacement in the motion that is simulated.

        Their sum is base less mass for the suspension. For the oscillator it is mass less base, or the mass's
        own motion where its contact or a force does not move with the base.
        """
        of, model = self.motion_of(channel), self.model
        if model.system == "suspension":
            return (1.0, 0.0) if of == RELATIVE else (-1.0, 1.0)
        if of in model.simulated_motion:
            return 1.0, 0.0
        return 1.0, 1.0 if of == RELATIVE else -1.0

    def model_of(self, test: TestRecord) -> Config:
        """The base model with the numbers of a test."""
        return with_numbers(self.model, test.model) if test.model else self.model
