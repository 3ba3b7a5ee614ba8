"""The files of a synthetic measurement: measured.toml, model.toml, a CSV per test, truth.json."""

import json
import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from wedgesweep import rotation, toml
from wedgesweep.config import Config
from wedgesweep.effects.thermal_drift import TEMPERATURE
from wedgesweep.errors import InputError
from wedgesweep.files import beside
from wedgesweep.measured.declarations import LOOP, STEADY, TRANSIENT
from wedgesweep.synthesize.motion import RTOL
from wedgesweep.synthesize.options import Options
from wedgesweep.synthesize.plan import Plan
from wedgesweep.synthesize.truth import Truth
from wedgesweep.units import UNITS


@dataclass(frozen=True, eq=False)
class Table:
    """Content of a CSV file: time in s, displacement in mm, velocity in mm/s, shape (n,) each.

    ``input``: as recorded, in its SI unit; ``force`` and ``load`` (N); None where not measured.
    ``settle_periods``: after how many periods a steady motion was recorded.
    """

    time: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray | None
    input: np.ndarray | None = None
    force: np.ndarray | None = None
    load: np.ndarray | None = None
    settle_periods: int | None = None


def require_free(directory: Path) -> None:
    """Check before the work that a directory is empty or can be created; raises InputError."""
    if directory.exists() and (not directory.is_dir() or any(directory.iterdir())):
        raise InputError([f"{directory}: not an empty directory; choose another, or remove it"])
    if not directory.parent.is_dir():
        raise InputError([f"{directory.parent}: not a directory; create it"])


def write(
    directory: Path, measured: dict[str, Any], model: Config, tables: Sequence[Table], truth: dict[str, Any]
) -> None:
    """Write all files into a directory, or nothing."""
    with beside(directory) as partial:
        (partial / "measured.toml").write_text(toml.dumps(measured), encoding="utf-8")
        (partial / "model.toml").write_text(model.to_toml(), encoding="utf-8")
        (partial / "truth.json").write_text(json.dumps(truth, indent=1) + "\n", encoding="utf-8")
        for test, table in zip(measured["measurement"]["test"], tables, strict=True):
            _write_csv(partial / test["file"], table)
        os.replace(partial, directory)


def _write_csv(path: Path, table: Table) -> None:
    named = {
        "t": table.time,
        "d": table.displacement,
        "v": table.velocity,
        "u": table.input,
        "F": table.force,
        "n": table.load,
    }
    columns = {name: each for name, each in named.items() if each is not None}
    formats = ["%.7f", *["%.7g"] * (len(columns) - 1)]
    content, header = np.column_stack(list(columns.values())), ",".join(columns)
    np.savetxt(path, content, fmt=formats, delimiter=",", header=header, comments="")


def measured(title: str, config: Config, plan: Plan, options: Options) -> dict[str, Any]:
    """The document of measured.toml."""
    tests = []
    for i, test in enumerate(plan.tests):
        keys: dict[str, Any] = {"file": f"test-{i:02d}.csv"}
        if test.temperature_C is not None:
            keys[TEMPERATURE.key] = test.temperature_C
        if test.kind != STEADY:
            undriven = options.record_input is not None and test.kind == TRANSIENT and not test.driven
            tests.append({**keys, "kind": test.kind, **({"undriven": True} if undriven else {})})
            continue
        keys["frequency_hz"] = test.frequency_hz
        if test.known and options.record_input is None:
            keys[config.amplitude_unit.key] = test.amplitude
            keys["amplitude_std"] = test.amplitude_std or options.amplitude_error
        tests.append(keys)
    motion = config.simulated_motion[0]
    velocity = {"column": "v", "unit": "mm/s", "derived": options.noise == "differentiated", "of": motion}
    columns: dict[str, dict[str, Any]] = {
        "time": {"column": "t", "unit": "s"},
        "displacement": {"column": "d", "unit": "mm", "of": motion},
    }
    kinds = {test.kind for test in plan.tests}
    if kinds != {LOOP}:
        columns["velocity"] = velocity
    if LOOP in kinds:
        columns["force"] = {"column": "F", "unit": "N"}
    if options.normal_force is not None:
        columns["normal_force"] = {"column": "n", "unit": "N", "zero_std": options.normal_force}
    if options.record_input is not None and any(t.driven or t.kind == STEADY for t in plan.tests):
        unit = next(iter(UNITS[options.record_input]))
        columns["input"] = {"column": "u", "unit": unit, "quantity": options.record_input}
    head = {"title": title, "model": "model.toml", "columns": columns, "uncertain": plan.uncertain}
    document = {"measurement": {**head, "test": tests}}
    if not config.turns:
        return document
    for channel in columns.values():
        channel["unit"] = rotation.UNITS.get(channel["unit"], channel["unit"])
    return rotation.written(document)


def truth_document(truth: Truth, tables: Sequence[Table], options: Options) -> dict[str, Any]:
    """The document of truth.json: what a diagnosis should find, in the keys and units of a config."""
    tests: list[dict[str, Any]] = [
        {
            "frequency_hz": test.plan.frequency_hz,
            f"amplitude_{test.plan.unit}": test.amplitude,
            f"nominal_amplitude_{test.plan.unit}": test.plan.amplitude,
            "phase_deg": test.phase_deg,
            "stray_vibration_phase_deg": test.stray_phase_deg,
            "sampling_hz": test.sampling_hz,
            "settle_periods": table.settle_periods,
        }
        for test, table in zip(truth.tests, tables, strict=True)
        if test.plan.kind == STEADY
    ]
    tests += [
        {"kind": test.plan.kind, "motion": test.plan.motion, "sampling_hz": test.sampling_hz}
        for test in truth.tests
        if test.plan.kind != STEADY
    ]
    document = {
        "effects": truth.config.document["effects"],
        "friction_law": truth.law,
        "uncertain": _uncertain(truth),
        "noise": options.noise,
        "level": options.level,
        "seed": options.seed,
        "solver": {"method": "radau", "rtol": RTOL},
        "tests": tests,
    }
    return rotation.written(document) if truth.config.turns else document


def _uncertain(truth: Truth) -> dict[str, Any]:
    """True factors by effect, and the numbers of other uncertain effects."""
    found = truth.uncertain.by_key(truth.x)
    return {name: numbers.get("scale", numbers) for name, numbers in found.items()}
