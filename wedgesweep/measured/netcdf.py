"""Measured data as one netCDF file.

Layout:

- Attributes of the file: ``title``, ``model_error``, ``input_gain_std``, ``input_harmonics_std``, and
  ``model``, which is the text of the model's config, not its path.
- Group ``uncertain``, if there is one: an attribute for each uncertain number.
- Group ``tests``: a group per test. Its attributes are the keys of ``[[measurement.test]]`` in measured.toml;
  flags (``detrend``, ``undriven``) are 0 or 1, and ``model`` is a JSON object.
- Variables of a test, over the dimension ``sample``: ``time``, and what was recorded of ``displacement``,
  ``velocity``, ``acceleration``, ``force`` and ``input``, with ``units`` as in measured.toml. Responses may
  have the attribute ``of``, an input has ``quantity``, and a velocity that was computed from the displacement
  has ``derived`` = 1.
"""

import json
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from wedgesweep.config import Config
from wedgesweep.config.keys import Number
from wedgesweep.config.tables import Table
from wedgesweep.files import json_object, regular, written
from wedgesweep.hints import hint, show
from wedgesweep.measured import channels, overrides, repeated
from wedgesweep.measured.build import Channels, build_record
from wedgesweep.measured.declarations import (
    DETREND,
    INPUT,
    INPUT_GAIN_STD,
    INPUT_HARMONICS_STD,
    INPUT_STDS,
    KINDS,
    MODEL_ERROR,
    QUANTITIES,
    STEADY,
    TEST,
    TRANSIENT,
    UNCERTAIN,
    UNDRIVEN,
)
from wedgesweep.measured.declarations import units as units_of
from wedgesweep.measured.measurement import MeasuredError, Measurement, TestRecord
from wedgesweep.measured.model import load_model, parse_model
from wedgesweep.quantity import Quantity
from wedgesweep.units import UNITS, usual

NUMBERS = (MODEL_ERROR, INPUT_GAIN_STD, INPUT_HARMONICS_STD)
ROOT_NAMES = ("title", "model", *(each.key for each in NUMBERS))
SI_UNITS = {"time": "s", "displacement": "m", "velocity": "m/s", "acceleration": "m/s^2", "force": "N"}
LONG_NAMES = {
    "time": "time",
    "displacement": "side frame minus bolster",
    "velocity": "rate of displacement",
    "acceleration": "rate of velocity",
    "force": "force on the mass",
    "input": "recorded input",
}


def write_netcdf(measurement: Measurement, path: Path) -> None:
    """Write a measurement as one netCDF file, in SI units; a failed write leaves no file."""
    import netCDF4

    with written(path) as temporary, netCDF4.Dataset(temporary, "w") as root:
        root.setncatts({"title": measurement.title, "model": measurement.model.to_toml()})
        root.setncattr("model_error", measurement.model_error)
        for name in INPUT_STDS:
            if std := getattr(measurement, name):
                root.setncattr(name, std)
        root.createGroup("uncertain").setncatts(dict(measurement.uncertain))
        tests = root.createGroup("tests")
        for i, test in enumerate(measurement.tests):
            _write_test(tests.createGroup(f"{i:04d}"), test, measurement)


def _write_test(group: Any, test: TestRecord, measurement: Measurement) -> None:
    key, factor = measurement.model.amplitude_unit.key, measurement.model.amplitude_unit.factor
    given = {
        "file": test.file,
        "frequency_hz": test.frequency,
        key: None if test.amplitude is None else float(f"{test.amplitude / factor:.15g}"),
        "amplitude_std": None if test.amplitude is None else test.amplitude_std,
        "model": json.dumps(dict(test.model)) if test.model else None,
        "kind": test.kind,
        "lowpass_hz": test.cutoff,
        "undriven": 1 if test.kind == TRANSIENT and test.input is None else None,
        "repeat_of": test.repeat_of,
    }
    group.setncatts({name: value for name, value in given.items() if value is not None})
    group.createDimension("sample", test.time.size)
    for channel, long_name in LONG_NAMES.items():
        samples = getattr(test, channel)
        if samples is not None:
            kept = {key: measurement.columns.get(channel, {}).get(key) for key in ("of", "quantity")}
            variable = group.createVariable(channel, "f8", ("sample",), compression="zlib")
            variable.setncatts({"units": SI_UNITS[kept["quantity"] or channel], "long_name": long_name})
            variable.setncatts({key: value for key, value in kept.items() if value is not None})
            variable[:] = samples
            if channel == "velocity":
                variable.setncattr("derived", int(measurement.derived_velocity))


def read(path: Path, model: Path | None = None) -> Measurement:
    """Read a file of the layout above; raises MeasuredError with everything that is wrong."""
    import netCDF4

    try:
        root = netCDF4.Dataset(regular(path))
    except (OSError, RuntimeError, ValueError, AttributeError) as error:  # netCDF4 raises any of them
        problem = f"{path}: {getattr(error, 'strerror', error)}; give the path of a netCDF file"
        raise MeasuredError([problem]) from error
    with root:
        try:
            return _read(root, path, model)
        except (RuntimeError, OSError) as error:  # of netCDF4, where content is damaged
            raise MeasuredError([f"{path}: damaged ({error})"]) from error


def _read(root: Any, path: Path, model: Path | None) -> Measurement:
    groups = list(root.groups["tests"].groups.values()) if "tests" in root.groups else []
    if not groups:
        fault = "no measured data; each test must be a group within the group tests"
        raise MeasuredError([f"{path}: {fault}"])
    problems: list[str] = []
    attributes = _attributes(root)
    unknown = [name for name in attributes if name not in ROOT_NAMES]
    problems.extend(f"{path}: {name}: unknown attribute; {hint(name, ROOT_NAMES)}" for name in unknown)
    config, law = _model(attributes, path, model, problems)
    uncertain = _uncertain(root, path, problems)
    numbers = {each.key: _number(each, attributes, path, problems) for each in NUMBERS}
    tests = [_test(group, path, config, problems) for group in groups]
    problems += _repeat_faults(groups, path)
    complete = tuple(test for test in tests if test)
    derived = _derived_velocity(groups, path, problems)
    by_kind, different = _columns_by_kind(groups)
    if different:
        problems.append(
            f"{path}: tests: they have different variables, units, of or quantity; make them alike"
        )
    columns = {name: each for own in by_kind.values() for name, each in own.items()}
    faults = channels.faults(by_kind, {**numbers, UNCERTAIN.key: uncertain}, None if problems else config)
    problems += [f"{path}: tests: {fault}" for fault in faults]
    if config is not None:
        problems += _model_faults(config, path, columns, by_kind, complete)
    if problems or config is None:
        raise MeasuredError(problems)
    return Measurement(
        path=path,
        title=attributes.get("title", "measurement"),
        model=config,
        law=law,
        uncertain=uncertain,
        tests=complete,
        derived_velocity=derived,
        columns=columns,
        **numbers,
    )


def _repeat_faults(groups: Sequence[Any], path: Path) -> list[str]:
    given = [{"file": group.name, **_attributes(group)} for group in groups]
    return [
        f"{path}: {group.path.lstrip('/')}: {fault}"
        for i, group in enumerate(groups)
        for fault in repeated.faults(given[i], given[:i])
    ]


def _model_faults(
    config: Config,
    path: Path,
    columns: Mapping[str, Mapping[str, str]],
    kinds: Iterable[str],
    tests: Iterable[TestRecord],
) -> list[str]:
    """Faults of the base model beside the channels, the kinds and the own numbers of the tests."""
    problems = [f"{path}: model: {fault}" for fault in channels.model_faults(config, columns, kinds)]
    for test in tests:
        problems += overrides.faults(config, {"model": test.model}, f"{path}: {test.name}.model")
    return problems


def _derived_velocity(groups: Sequence[Any], path: Path, problems: list[str]) -> bool:
    """Whether the velocity of the tests was derived from their displacement."""
    velocities = [each.variables["velocity"] for each in groups if "velocity" in each.variables]
    derived = {_is_marked(variable, "derived") for variable in velocities}
    if len(derived) > 1:
        problems.append(
            f"{path}: tests: velocity is derived in some and measured in others; leave out the derived ones"
        )
    return derived == {True}


def _columns_by_kind(groups: Sequence[Any]) -> tuple[dict[str, dict[str, dict[str, str]]], bool]:
    """Variables of the tests of each kind, and whether they differ between tests or kinds."""
    found: dict[str, dict[str, dict[str, str]]] = {}
    different = False
    for group in groups:
        own = _columns(group)
        kind = str(getattr(group, "kind", STEADY))
        known = found.setdefault(kind if kind in KINDS else STEADY, own)
        shared = {name: each for other in found.values() for name, each in other.items()}
        undriven = _is_marked(group, "undriven")
        same = known == own or (undriven and {**own, INPUT: known.get(INPUT)} == known)
        different = different or not same or any(own[name] != shared[name] for name in own)
    return found, different


def _is_marked(owner: Any, name: str) -> bool:
    """Whether a group or variable has an attribute other than 0, a number or an array of them."""
    return bool(np.any(getattr(owner, name, 0)))


def _unit(variable: Any) -> str:
    return usual(str(getattr(variable, "units", "none")))


def _columns(group: Any) -> dict[str, dict[str, str]]:
    """Name, unit, ``of`` and ``quantity`` of the variables of a test."""
    found = {}
    for name in (*UNITS, INPUT):
        if name in group.variables:
            own = group.variables[name]
            more = {key: str(getattr(own, key)) for key in ("of", "quantity") if hasattr(own, key)}
            found[name] = {"column": name, "unit": _unit(own)} | more
    return found


def _model(
    attributes: Mapping[str, Any], path: Path, model: Path | None, problems: list[str]
) -> tuple[Config | None, str]:
    if model is not None:
        return load_model(model, problems)
    if not isinstance(attributes.get("model"), str):
        problems.append(f"{path}: model: missing; it is the text of a config")
        return None, ""
    return parse_model(attributes["model"], f"{path}: model", problems)


def _number(quantity: Quantity, attributes: Mapping[str, Any], path: Path, problems: list[str]) -> float:
    """The number of the file with the name of a key of measured.toml; its default where it is not given."""
    found: list[str] = []
    value = Number.of(quantity).read(attributes.get(quantity.key, quantity.default), quantity.key, found)
    problems.extend(f"{path}: {problem}" for problem in found)
    return quantity.default if value is None else value


def _uncertain(root: Any, path: Path, problems: list[str]) -> dict[str, float]:
    group = root.groups.get("uncertain")
    return _checked(UNCERTAIN, _attributes(group), f"{path}: uncertain", problems) if group else {}


def _attributes(group: Any) -> dict[str, Any]:
    """Attributes as plain numbers and strings."""
    found = {name: group.getncattr(name) for name in group.ncattrs()}
    numpy_types = np.generic | np.ndarray
    return {name: each.tolist() if isinstance(each, numpy_types) else each for name, each in found.items()}


def _checked(table: Table, given: Mapping[str, Any], at: str, problems: list[str]) -> dict[str, Any]:
    """Check attributes as the table of measured.toml with the same keys."""
    found: list[str] = []
    read = table.read(dict(given), "", found)
    problems.extend(f"{at}: {problem}" for problem in found)
    return read


def _test(group: Any, path: Path, model: Config | None, problems: list[str]) -> TestRecord | None:
    at = f"{path}: {group.path.lstrip('/')}"
    before = len(problems)
    given = _checked(TEST, {"file": group.name, **_read_numbers(_attributes(group))}, at, problems)
    problems.extend(f"{at}: {fault}" for fault in channels.keys_faults(given, group.variables, model))
    columns = {
        name: np.ma.filled(variable[:].astype(float), np.nan) for name, variable in group.variables.items()
    }
    units = {name: _unit(variable) for name, variable in group.variables.items()}
    quantity = getattr(group.variables.get(INPUT), "quantity", None)
    problems.extend(f"{at}: {fault}" for fault in _variable_faults(columns, units, quantity))
    if len(problems) > before:
        return None
    recorded = Channels(columns, units, at, lambda sample: f"{at}: sample {sample}")
    return build_record(Path(given["file"]).stem, given, recorded, at, problems)


def _read_numbers(attributes: dict[str, Any]) -> dict[str, Any]:
    """Attributes of a test with its numbers of the model read from their text, and 0 or 1 as a flag."""
    for flag in (DETREND.key, UNDRIVEN.key):
        if attributes.get(flag) in (0, 1):  # an attribute cannot be a truth value
            attributes = attributes | {flag: bool(attributes[flag])}
    if not isinstance(attributes.get("model"), str):
        return attributes
    try:
        return attributes | {"model": json_object(attributes["model"])}
    except ValueError:
        return attributes


def _variable_faults(
    columns: Mapping[str, np.ndarray], units: Mapping[str, str], quantity: str | None
) -> list[str]:
    # What else a test needs depends on its kind and on those beside it: see channels.py.
    faults = [] if "time" in columns else ["no variable time"]
    if not columns.keys() - {"time"}:
        faults.append("no variable displacement")
    if INPUT in columns and quantity not in QUANTITIES:
        faults.append(f"{INPUT}: quantity {show(quantity or 'none')}; valid here: {', '.join(QUANTITIES)}")
        quantity = None
    for name, samples in columns.items():
        if name not in (*UNITS, INPUT):
            faults.append(f"{name}: unknown variable; {hint(name, (*UNITS, INPUT))}")
            continue
        valid = units_of(name, quantity)
        if units[name] not in valid:
            faults.append(f"{name}: unknown units {show(units[name])}; valid here: {', '.join(valid)}")
        if samples.ndim != 1 or samples.size != columns.get("time", samples).size:
            faults.append(f"{name}: shape {samples.shape}; it has one dimension, that of time")
        elif not np.isfinite(samples).all():
            place = int(np.flatnonzero(~np.isfinite(samples))[0])
            faults.append(f"{name}: sample {place} is not a finite number")
    return faults
