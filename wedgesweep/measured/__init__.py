"""Measured vibration: a measured.toml with one CSV per test, or the same as one netCDF file."""

from pathlib import Path

from wedgesweep.kinds import NETCDF_SUFFIXES
from wedgesweep.measured import netcdf, toml_and_csv
from wedgesweep.measured.measurement import MeasuredError, Measurement, TestRecord
from wedgesweep.measured.plausibility import amplitude_faults, noise_faults

__all__ = ["MeasuredError", "Measurement", "TestRecord", "read"]


def read(path: Path, model: Path | None = None) -> Measurement:
    """Read measured data.

    Parameters
    ----------
    path : Path
        A measured.toml or a netCDF file.
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
    reader = netcdf if path.suffix in NETCDF_SUFFIXES else toml_and_csv
    measurement = reader.read(path, model)
    if faults := noise_faults(measurement) or amplitude_faults(measurement):
        raise MeasuredError([f"{path}: {fault}" for fault in faults])
    return measurement
