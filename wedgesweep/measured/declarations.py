"""Declaration of every key of measured.toml."""

from dataclasses import dataclass
from math import nan
from typing import Any

from wedgesweep.config import toml
from wedgesweep.config.keys import Choice, Flag, Number, Text, show
from wedgesweep.config.tables import Table, TableList, table
from wedgesweep.effects import EFFECTS, OF_THE_MODEL, SCALES
from wedgesweep.quantity import Quantity

UNITS = {
    "time": {"s": 1.0, "ms": 1e-3},
    "displacement": {"m": 1.0, "mm": 1e-3, "um": 1e-6},
    "velocity": {"m/s": 1.0, "mm/s": 1e-3},
}
# Effects that scale a number of the model, which may be declared uncertain.
PARAMETERS = tuple(name for name in SCALES if EFFECTS[name].family == OF_THE_MODEL)

FREQUENCY = Quantity("frequency_hz", nan, "input frequency; estimated if absent", above=0.0)
AMPLITUDE = Quantity("amplitude_mm", nan, "amplitude of the side frame; omit it if unknown", above=0.0)
AMPLITUDE_STD = Quantity("amplitude_std", 0.0, "relative std of the amplitude", minimum=0.0, below=1.0)

MODEL_ERROR = Quantity(
    "model_error",
    0.0,
    "relative error that a model may have: 0.01 takes the verdict at 1 % of the response",
    minimum=0.0,
    below=1.0,
)


@dataclass(frozen=True, kw_only=True)
class Inline(Table):
    """A table that is written inline, in braces."""

    @property
    def written(self) -> str:
        example = {name: key.example for name, key in self.keys.items() if key.required}
        return f"{self.key} = {toml.inline(example)}"


@dataclass(frozen=True, kw_only=True)
class Unit(Choice):
    """A unit of a channel; an unknown one is answered by all valid ones, as similar names are other units."""

    def read(self, value: Any, path: str, problems: list[str]) -> str | None:
        if value in self.choices:
            return value
        problems.append(f"{path}: unknown unit {show(value)}; valid here: {', '.join(self.choices)}")
        return None


@dataclass(frozen=True, kw_only=True)
class RecordTable(Table):
    """Keys of a test."""

    def read(self, value: Any, path: str, problems: list[str]) -> dict[str, Any]:
        if isinstance(value, dict) and "amplitude_std" in value and "amplitude_mm" not in value:
            at = f"{path}." if path else ""
            problems.append(f"{at}amplitude_std: given without amplitude_mm; omit it")
        return super().read(value, path, problems)


def _channel(name: str, meaning: str, column: str, unit: str, *more: Flag, optional: bool = False) -> Inline:
    keys = (
        Text(key="column", meaning="header name in the CSV files", example=column),
        Unit(key="unit", meaning="its unit", choices=tuple(UNITS[name]), example=unit),
        *more,
    )
    groups = tuple((key,) for key in keys)
    return Inline(key=name, meaning=meaning, groups=groups, optional=optional)


def _uncertain(name: str) -> Number:
    meaning = f"relative std of the quantity that the effect {name} scales"
    return Number.of(Quantity(name, nan, meaning, above=0.0, below=1.0), optional=True)


DERIVED = Flag(key="derived", meaning="whether it is computed from the displacement", default=False)

COLUMNS = table(
    "columns",
    "header name and unit of each channel",
    _channel("time", "time at a constant sampling rate", "t", "s"),
    _channel("displacement", "side frame minus bolster, x - y", "d", "mm"),
    _channel("velocity", "relative velocity, x' - y'", "v", "mm/s", DERIVED, optional=True),
    example="measurement.columns",
)

UNCERTAIN = table("uncertain", "uncertain numbers of the model", *map(_uncertain, PARAMETERS), default={})

TEST = RecordTable(
    key="test",
    meaning="one record of steady vibration",
    groups=(
        (Text(key="file", meaning="CSV file, relative to this one", example="20hz.csv"),),
        (Number.of(FREQUENCY, optional=True),),
        (Number.of(AMPLITUDE, optional=True),),
        (Number.of(AMPLITUDE_STD),),
    ),
)

MEASUREMENT = table(
    "measurement",
    "measured data",
    Text(key="title", meaning="title of the measurement", default="measurement"),
    Text(key="model", meaning="the base model: a config, relative to this file", example="model.toml"),
    Number.of(MODEL_ERROR),
    COLUMNS,
    UNCERTAIN,
    TableList(key="test", meaning="the tests", item=TEST, example="measurement.test"),
)

ROOT = table("", "measured data", MEASUREMENT)
