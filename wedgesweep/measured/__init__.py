"""Measured vibration: a measured.toml and the files of its tests."""

from wedgesweep.measured.document import read
from wedgesweep.measured.measurement import MeasuredError, Measurement, TestRecord

__all__ = ["MeasuredError", "Measurement", "TestRecord", "read"]
