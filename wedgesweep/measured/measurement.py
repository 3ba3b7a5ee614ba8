"""What measured data consist of, in SI units."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from wedgesweep.config import Config
from wedgesweep.errors import InputError
from wedgesweep.measured.frequency import refined_frequency


class MeasuredError(InputError):
    """Measured data that cannot be used."""


@dataclass(frozen=True, eq=False)
class TestRecord:
    """One record of steady vibration under a sinusoidal input.

    ``frequency`` (Hz) and ``amplitude`` (m, of the side frame) are None where they are not known;
    ``amplitude_std`` is relative. ``time`` (s) is the even grid that the file's stamps round, shape (n,);
    ``displacement`` (m, x - y with the sensor's constant part) and ``velocity`` (m/s, x' - y', or None) are
    samples at these times.
    """

    __test__ = False  # not a test of pytest

    name: str
    file: str
    frequency: float | None
    amplitude: float | None
    amplitude_std: float
    time: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray | None

    @cached_property
    def refined_frequency(self) -> float:
        """Frequency (Hz): the stated one, unless none is stated or the record excludes it."""
        return refined_frequency(self.time, self.displacement, self.frequency)

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
    """Tests of one suspension, and the base model.

    ``law`` is the model's friction law; ``uncertain`` holds the relative std of numbers of the model by
    the name of the effect that scales them; ``columns`` the CSV header name and unit of each channel;
    ``model_error`` the relative error that a model may have.
    """

    path: Path
    title: str
    model: Config
    law: str
    uncertain: Mapping[str, float]
    tests: tuple[TestRecord, ...]
    derived_velocity: bool
    columns: Mapping[str, Mapping[str, str]]
    model_error: float = 0.0
