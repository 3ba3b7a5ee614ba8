"""measured.toml and its data files."""

from collections.abc import Mapping
from dataclasses import replace
from math import hypot
from pathlib import Path
from typing import Any

from wedgesweep import rotation, toml
from wedgesweep.config import Config
from wedgesweep.config.turned import Turned
from wedgesweep.effects import of_system
from wedgesweep.effects.base import OSCILLATOR
from wedgesweep.effects.thermal_drift import TEMPERATURE
from wedgesweep.errors import ConfigError, InputError
from wedgesweep.files import missing
from wedgesweep.hints import shortened
from wedgesweep.measured import channels, contact_load, kinds
from wedgesweep.measured.build import build_record
from wedgesweep.measured.declarations import (
    DELAY_STD,
    INPUT,
    INPUT_STDS,
    NORMAL_FORCE,
    ROOT,
    STEADY,
    UNCERTAIN,
    ZERO_STD,
    columns_of,
    units,
)
from wedgesweep.measured.measurement import MeasuredError, Measurement, TestRecord
from wedgesweep.measured.model import load_model, with_numbers
from wedgesweep.measured.plausibility import amplitude_faults, noise_faults
from wedgesweep.measured.signals import read_signals

MODEL = "give the path of a config, from here"


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
    problems: list[str] = []
    given = _document(path, model, problems)
    measurement = given.get("measurement", {})
    columns = measurement.get("columns", {})
    by_kind = _columns_by_kind(measurement)
    complete = not problems
    model = model or _stated_model(path, measurement, problems)
    config, law = load_model(model, problems) if model else (None, "")
    contact = config is not None and config.system == OSCILLATOR
    if complete:
        faults = channels.faults(_without_load(by_kind) if contact else by_kind, measurement, config)
        problems += [f"{path}: {_at(fault)}" for fault in faults]
    if config is not None:
        problems += [f"{model}: {fault}" for fault in channels.model_faults(config, columns, by_kind)]
        problems += _temperature_faults(path, measurement) + _override_faults(path, measurement, config)
        problems += _uncertain_faults(path, measurement, config)
    tests = _tests(path, measurement, config, problems)
    if problems or config is None:
        raise MeasuredError(problems)
    found = Measurement(
        path=path,
        title=measurement["title"],
        model=config,
        law=law,
        uncertain=measurement["uncertain"],
        tests=tuple(tests),
        derived_velocity=columns.get("velocity", {}).get("derived", False),
        columns={
            name: {key: value for key, value in each.items() if key != "derived"}
            for name, each in columns.items()
        },
        **{name: measurement[name] for name in INPUT_STDS},
        model_error=measurement["model_error"],
        delay_std=hypot(*(1e-3 * each.get(DELAY_STD.key, 0.0) for each in columns.values())),
    )
    if faults := noise_faults(found) or amplitude_faults(found):
        raise MeasuredError([f"{path}: {fault}" for fault in faults])
    return found


def _stated_model(path: Path, measurement: Mapping[str, Any], problems: list[str]) -> Path | None:
    """The file of the model that a measured.toml names, if it is there."""
    if "model" not in measurement:  # a fault of the document
        return None
    model = path.parent / measurement["model"]
    if reason := missing(model):
        problems.append(f"{path}: measurement.model: {shortened(model)}: {reason}; {MODEL}")
        return None
    return model


def _columns_by_kind(measurement: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """The declared channels of each kind of test that there is."""
    columns = measurement.get("columns", {})
    found = dict.fromkeys(each["kind"] for each in measurement.get("test", ())) or {STEADY: None}
    return {kind: columns_of(columns, kind, len(found) == 1) for kind in found}


def _without_load(by_kind: Mapping[str, Mapping[str, Any]]) -> dict[str, dict[str, Any]]:
    """The channels that are compared where the load is that of an oscillator's contact."""
    return {
        kind: {name: each for name, each in own.items() if name != NORMAL_FORCE}
        for kind, own in by_kind.items()
    }


def _at(fault: str) -> str:
    """The full key of a fault of the channels."""
    elsewhere = fault.startswith((*INPUT_STDS, UNCERTAIN.key))
    return f"measurement.{fault}" if elsewhere else f"measurement.columns.{fault}"


def _override_faults(path: Path, measurement: dict[str, Any], config: Config) -> list[str]:
    """Numbers of single tests that the model does not have, or that are out of range."""
    faults: list[str] = []
    for i, given in enumerate(measurement.get("test", ())):
        try:
            with_numbers(config, given.get("model", {}), f"{path}: measurement.test[{i}].model")
        except ConfigError as error:
            faults += error.problems
    return faults


def _uncertain_faults(path: Path, measurement: dict[str, Any], config: Config) -> list[str]:
    """Uncertain numbers that no model of this kind has."""
    lacking = [name for name in measurement.get(UNCERTAIN.key, {}) if name not in of_system(config.system)]
    why = f"is a number of no {config.system}; omit it"
    return [f"{path}: measurement.{UNCERTAIN.key}.{name}: {why}" for name in lacking]


def _temperature_faults(path: Path, measurement: dict[str, Any]) -> list[str]:
    """Tests without a temperature beside others that state it: they would be simulated at the reference."""
    tests, key = measurement.get("test", ()), TEMPERATURE.key
    without = [i for i, given in enumerate(tests) if key not in given]
    if len(without) == len(tests):
        return []
    fault = f"{key}: missing; other tests state it, and this one must"
    return [f"{path}: measurement.test[{i}].{fault}" for i in without]


def _document(path: Path, model: Path | None, problems: list[str]) -> dict[str, Any]:
    """The checked document, with the keys of a translation; its faults go to ``problems``."""
    try:
        given = toml.load(path, "a measured.toml")
    except InputError as error:
        raise MeasuredError(error.problems) from error
    found: list[str] = []
    turned = Turned()
    root = turned.table(ROOT) if _turns(model or path.parent / _named_model(given)) else ROOT
    document: dict[str, Any] = turned.back(root.read(given, "", found))
    problems.extend(f"{path}: {problem}" for problem in found)
    measurement = document.get("measurement", {})
    for test in measurement.get("test", ()):
        test.setdefault("kind", measurement.get("kind", STEADY))
    return document


def _named_model(given: Mapping[str, Any]) -> str:
    """The model that an unchecked document names; a fault of it is told later."""
    measurement = given.get("measurement")
    named = measurement.get("model") if isinstance(measurement, Mapping) else None
    return named if isinstance(named, str) else ""


def _turns(model: Path) -> bool:
    """Whether a model is an oscillator that turns; a fault of its file is told later."""
    try:
        return rotation.turns(toml.load(model, "a TOML file"))
    except (InputError, OSError, ValueError):
        return False


def _tests(
    path: Path, measurement: dict[str, Any], model: Config | None, problems: list[str]
) -> list[TestRecord]:
    """The tests whose keys and data are valid; without valid columns no test can be read."""
    columns = measurement.get("columns", {})
    by_kind = _columns_by_kind(measurement)
    complete = bool(columns.keys() - {"time"}) and all(
        {"column", "unit"} <= each.keys() for each in columns.values()
    )
    tests: list[TestRecord] = []
    before: list[dict[str, Any]] = []
    for i, given in enumerate(measurement.get("test", ())):
        at = f"{path}: measurement.test[{i}]"
        if "file" not in given:
            continue
        earlier = [other for other in before if other["file"] == given["file"]]
        if any(_part(other) == _part(given) for other in earlier):
            fault = (
                f"repeats test[{before.index(earlier[0])}].file; each test has its own file, columns or part"
            )
            problems.append(f"{at}.file: {fault}")
            continue
        number = f"#{len(earlier) + 1}" if earlier else ""
        problems.extend(f"{at}.{fault}" for fault in kinds.repeat_faults(given, before))
        before.append({**given, "name": f"{given['file']}{number}"})
        own = by_kind[given["kind"]]
        contact = model is not None and model.system == OSCILLATOR and NORMAL_FORCE in columns
        if contact:
            own = own | {NORMAL_FORCE: columns[NORMAL_FORCE]}
        if given.get("undriven"):
            own = {name: each for name, each in own.items() if name != INPUT}
        told = rotation.text if model is not None and model.turns else str
        problems.extend(f"{at}.{told(fault)}" for fault in channels.keys_faults(given, own, model))
        changes = given.get("columns", {})
        unknown = [name for name in changes if name not in own]
        problems.extend(f"{at}.columns.{name}: no such channel; declare it above" for name in unknown)
        changed = {name: {**each, **changes.get(name, {})} for name, each in own.items()}
        if complete and own:
            found = _test(path.parent, at, given, {**measurement, "columns": changed}, problems)
            if contact:
                found = contact_load.stated(found, at, problems)
            tests += [replace(each, name=each.name + number, file=each.file + number) for each in found]
    return tests


def _part(given: Mapping[str, Any]) -> tuple:
    """What a test uses of its file."""
    return given.get("columns"), given.get("from_s"), given.get("to_s")


def _test(
    folder: Path, at: str, given: dict[str, Any], measurement: dict[str, Any], problems: list[str]
) -> list[TestRecord]:
    file = folder / given["file"]
    if reason := missing(file):
        problems.append(f"{at}.file: {shortened(file)}: {reason}; give the path of a data file, from here")
        return []
    signals, remarks = read_signals(folder, given, measurement, problems)
    if not signals:
        return []
    test = build_record(file.stem, given, signals, remarks, str(file), at, problems)
    if test and (load := measurement["columns"].get(NORMAL_FORCE)):
        test = replace(test, zero_std=load.get(ZERO_STD.key, 0.0) * units(NORMAL_FORCE)[load["unit"]])
    return [test] if test else []
