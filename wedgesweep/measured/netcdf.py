"""Measured data as one netCDF file.

Layout: the attributes of the file are ``title``, ``model_error`` and ``model`` (the text of the model's
config, not its path). The group ``uncertain``, if there is one, has an attribute for each uncertain number.
The group ``tests`` holds a group per test with the attributes ``file``, ``frequency_hz``,
``amplitude_mm`` and ``amplitude_std`` as in measured.toml, and variables ``time``, ``displacement`` and,
optionally, ``velocity`` over the dimension ``sample``, with ``units`` as in measured.toml. A velocity that is
computed from displacement has the attribute ``derived`` = 1.
"""

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from wedgesweep.config import Config
from wedgesweep.config.keys import Number, hint, show
from wedgesweep.config.tables import Table
from wedgesweep.measured.build import Channels, build_record
from wedgesweep.measured.declarations import MODEL_ERROR, TEST, UNCERTAIN, UNITS
from wedgesweep.measured.measurement import MeasuredError, Measurement, TestRecord
from wedgesweep.measured.model import load_model, parse_model

SUFFIXES = (".nc", ".nc4")
ROOT_NAMES = ("title", "model", "model_error")
SI_UNITS = {"time": "s", "displacement": "m", "velocity": "m/s"}
LONG_NAMES = {"time": "time", "displacement": "side frame minus bolster", "velocity": "rate of displacement"}


def write_netcdf(measurement: Measurement, path: Path) -> None:
    """Write a measurement as one netCDF file, in SI units; a failed write leaves no file."""
    import netCDF4

    partial = path.with_name(path.name + ".partial")
    try:
        with netCDF4.Dataset(partial, "w") as root:
            root.setncatts({"title": measurement.title, "model": measurement.model.to_toml()})
            root.setncattr("model_error", measurement.model_error)
            root.createGroup("uncertain").setncatts(dict(measurement.uncertain))
            tests = root.createGroup("tests")
            for i, test in enumerate(measurement.tests):
                _write_test(tests.createGroup(f"{i:04d}"), test, measurement.derived_velocity)
        os.replace(partial, path)
    finally:
        partial.unlink(missing_ok=True)


def _write_test(group: Any, test: TestRecord, derived: bool) -> None:
    millimetres = None if test.amplitude is None else float(f"{test.amplitude * 1e3:.15g}")
    given = {
        "file": test.file,
        "frequency_hz": test.frequency,
        "amplitude_mm": millimetres,
        "amplitude_std": None if test.amplitude is None else test.amplitude_std,
    }
    group.setncatts({name: value for name, value in given.items() if value is not None})
    group.createDimension("sample", test.time.size)
    for channel, unit in SI_UNITS.items():
        samples = getattr(test, channel)
        if samples is not None:
            variable = group.createVariable(channel, "f8", ("sample",), compression="zlib")
            variable.setncatts({"units": unit, "long_name": LONG_NAMES[channel]})
            variable[:] = samples
            if channel == "velocity":
                variable.setncattr("derived", int(derived))


def read(path: Path, model: Path | None = None) -> Measurement:
    """Read a file of the layout above; raises MeasuredError with everything that is wrong."""
    import netCDF4

    try:
        root = netCDF4.Dataset(path)
    except OSError as error:
        problem = f"{path}: {error.strerror}; give the path of a netCDF file"
        raise MeasuredError([problem]) from error
    with root:
        return _read(root, path, model)


def _read(root: Any, path: Path, model: Path | None) -> Measurement:
    groups = list(root.groups["tests"].groups.values()) if "tests" in root.groups else []
    if not groups:
        told = "no measured data; each test must be a group within the group tests"
        raise MeasuredError([f"{path}: {told}"])
    problems: list[str] = []
    attributes = _attributes(root)
    unknown = [name for name in attributes if name not in ROOT_NAMES]
    problems.extend(f"{path}: {name}: unknown attribute; {hint(name, ROOT_NAMES)}" for name in unknown)
    config, law = _model(attributes, path, model, problems)
    uncertain = _uncertain(root, path, problems)
    model_error = _model_error(attributes, path, problems)
    tests = [_test(group, path, problems) for group in groups]
    complete = tuple(test for test in tests if test)
    velocities = [each.variables["velocity"] for each in groups if "velocity" in each.variables]
    derived = {bool(getattr(variable, "derived", 0)) for variable in velocities}
    if len(derived) > 1:
        problems.append(
            f"{path}: tests: velocity is derived in some and measured in others; leave out the derived ones"
        )
    if problems or config is None:
        raise MeasuredError(problems)
    variables = [groups[0].variables[name] for name in UNITS if name in groups[0].variables]
    return Measurement(
        path=path,
        title=attributes.get("title", "measurement"),
        model=config,
        law=law,
        uncertain=uncertain,
        tests=complete,
        derived_velocity=derived == {True},
        columns={each.name: {"column": each.name, "unit": each.units} for each in variables},
        model_error=model_error,
    )


def _model(
    attributes: Mapping[str, Any], path: Path, model: Path | None, problems: list[str]
) -> tuple[Config | None, str]:
    if model is not None:
        return load_model(model, problems)
    if not isinstance(attributes.get("model"), str):
        problems.append(f"{path}: model: missing; it is the text of a config")
        return None, ""
    return parse_model(attributes["model"], f"{path}: model", problems)


def _model_error(attributes: Mapping[str, Any], path: Path, problems: list[str]) -> float:
    found: list[str] = []
    value = Number.of(MODEL_ERROR).read(attributes.get("model_error", 0.0), "model_error", found)
    problems.extend(f"{path}: {problem}" for problem in found)
    return 0.0 if value is None else float(value)


def _uncertain(root: Any, path: Path, problems: list[str]) -> dict[str, float]:
    group = root.groups.get("uncertain")
    return _checked(UNCERTAIN, _attributes(group), f"{path}: uncertain", problems) if group else {}


def _attributes(group: Any) -> dict[str, Any]:
    """Attributes as plain numbers and strings."""
    found = {name: group.getncattr(name) for name in group.ncattrs()}
    return {name: each.item() if isinstance(each, np.generic) else each for name, each in found.items()}


def _checked(table: Table, given: Mapping[str, Any], at: str, problems: list[str]) -> dict[str, Any]:
    """Check attributes as the table of measured.toml with the same keys."""
    found: list[str] = []
    read = table.read(dict(given), "", found)
    problems.extend(f"{at}: {problem}" for problem in found)
    return read


def _test(group: Any, path: Path, problems: list[str]) -> TestRecord | None:
    at = f"{path}: {group.path.lstrip('/')}"
    before = len(problems)
    given = _checked(TEST, {"file": group.name, **_attributes(group)}, at, problems)
    columns = {
        name: np.ma.filled(variable[:].astype(float), np.nan) for name, variable in group.variables.items()
    }
    units = {name: getattr(variable, "units", "none") for name, variable in group.variables.items()}
    problems.extend(f"{at}: {fault}" for fault in _variable_faults(columns, units))
    if len(problems) > before:
        return None
    channels = Channels(columns, units, at, lambda sample: f"{at}: sample {sample}")
    return build_record(Path(given["file"]).stem, given, channels, at, problems)


def _variable_faults(columns: Mapping[str, np.ndarray], units: Mapping[str, str]) -> list[str]:
    faults = [f"no variable {name}" for name in ("time", "displacement") if name not in columns]
    for name, samples in columns.items():
        if name not in UNITS:
            faults.append(f"{name}: unknown variable; {hint(name, UNITS)}")
            continue
        if units[name] not in UNITS[name]:
            faults.append(f"{name}: unknown units {show(units[name])}; valid here: {', '.join(UNITS[name])}")
        if samples.ndim != 1 or samples.size != columns.get("time", samples).size:
            faults.append(f"{name}: shape {samples.shape}; it has one dimension, that of time")
        elif not np.isfinite(samples).all():
            place = int(np.flatnonzero(~np.isfinite(samples))[0])
            faults.append(f"{name}: sample {place} is not a finite number")
    return faults
