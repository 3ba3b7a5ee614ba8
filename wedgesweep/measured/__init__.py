"""Measured vibration: a measured.toml and the files of its tests."""

from pathlib import Path

from wedgesweep.measured import document
from wedgesweep.measured.measurement import MeasuredError, Measurement, TestRecord
from wedgesweep.measured.plausibility import amplitude_faults, noise_faults

__all__ = ["MeasuredError", "Measurement", "TestRecord", "read"]


def read(path: Path, model: Path | None = None) -> Measurement:
    """Read measured data.

    Parameters
    ----------
    path : Path
        A measured.toml.
    model : Path, optional
        Config of the base model, instead of the one that the data name.

    Returns
    -------
    Measurement
        The base model and the tests, in SI units.

    Raises
    ------
    MeasuredError
        Lists everything that is wrong: in the file, in the data of each test and in the model.
    """
    measurement = document.read(path, model)
    if faults := noise_faults(measurement) or amplitude_faults(measurement):
        raise MeasuredError([f"{path}: {fault}" for fault in faults])
    return measurement
