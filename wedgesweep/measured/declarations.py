"""Declaration of every key of measured.toml."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import inf, nan
from typing import Any

from wedgesweep import toml
from wedgesweep.config.keys import Choice, Flag, Key, Number, Text, Unit, Whole
from wedgesweep.config.tables import Table, TableList, table
from wedgesweep.effects import EFFECTS, OF_THE_MODEL, SCALES, thermal_drift
from wedgesweep.hints import show
from wedgesweep.quantity import Quantity
from wedgesweep.readers.dialect import DECIMALS, DELIMITERS, THOUSANDS
from wedgesweep.uncertain import DISTORTION
from wedgesweep.units import UNITS

# Channels that show the response, and what a recorded input may be.
MOTIONS = ("displacement", "velocity", "acceleration")
RESPONSES = (*MOTIONS, "force")
INPUT = "input"
# A recorded force on the mass beside what drives it.
KNOWN_FORCE = "known_force"
# The load of a column.
NORMAL_FORCE = "normal_force"
QUANTITIES = RESPONSES
RELATIVE, ABSOLUTE = "relative", "absolute"
# Effects that scale a number of the model, which may be declared uncertain.
PARAMETERS = tuple(name for name in SCALES if EFFECTS[name].family == OF_THE_MODEL)

# Kinds of test: a periodic response, a motion from some start with or without an input, or a force under an
# imposed motion.
STEADY, TRANSIENT, LOOP = KINDS = ("steady", "transient", "loop")
# What tests of several kinds are together.
MIXED = "mixed"
# Channels of each kind where several kinds share one declaration.
CHANNELS = {
    STEADY: ("time", *MOTIONS, INPUT, KNOWN_FORCE, NORMAL_FORCE),
    TRANSIENT: ("time", *MOTIONS, INPUT, KNOWN_FORCE),
    LOOP: ("time", "displacement", "velocity", "force", KNOWN_FORCE),
}

FREQUENCY = Quantity("frequency_hz", nan, "input frequency; estimated if absent", above=0.0)
AMPLITUDE = Quantity("amplitude_mm", nan, "amplitude of the side frame; omit it if unknown", above=0.0)
FORCE_AMPLITUDE = Quantity(
    "amplitude_N", nan, "amplitude of the force on the mass; omit it if unknown", above=0.0
)
AMPLITUDE_STD = Quantity("amplitude_std", 0.0, "relative std of the amplitude", minimum=0.0, below=1.0)

LOWPASS = Quantity(
    "lowpass_hz",
    nan,
    "loop: cut-off frequency; by default as high as the noise of the displacement allows",
    above=0.0,
)
FROM = Quantity("from_s", nan, "time in the file from which the record is used; by default all of it")
TO = Quantity("to_s", nan, "time in the file up to which the record is used; by default all of it")
DETREND = Flag("detrend", "whether to remove the straight line of a sensor that drifts", default=False)
UNDRIVEN = Flag(
    "undriven", "transient: whether no input acts in this test, so that its file has none", default=False
)
MODEL_ERROR = Quantity(
    "model_error",
    0.0,
    "relative error that a model may have: 0.01 takes the verdict at 1 % of the response",
    minimum=0.0,
    below=1.0,
)


@dataclass(frozen=True, kw_only=True)
class Inline(Table):
    """A channel, which is written inline, in braces."""

    def read(self, value: Any, path: str, problems: list[str]) -> dict[str, Any]:
        read = super().read(value, path, problems)
        faults = [("sign", "1 or -1")] if read.get("sign") not in (None, 1.0, -1.0) else []
        faults += [("scale", "another number than 0")] if read.get("scale") == 0.0 else []
        for key, valid in faults:
            problems.append(f"{path}.{key}: {read[key]:g} is out of range; it must be {valid}")
        return read

    @property
    def written(self) -> str:
        example = {name: key.example for name, key in self.keys.items() if key.required}
        return f"{self.key} = {toml.inline(example)}"


@dataclass(frozen=True, kw_only=True)
class Overrides(Key):
    """Numbers of the model by "section.key"; the model itself checks the names and the ranges."""

    def read(self, value: Any, path: str, problems: list[str]) -> dict[str, float] | None:
        if not isinstance(value, dict):
            fault = f'{show(value)} is not a table; write {{ "section.key" = number }}'
            problems.append(f"{path}: {fault}")
            return None
        for name, number in value.items():
            if name.count(".") < 1:
                problems.append(f'{path}: {show(name)} is not "section.key"; write it in quotes')
            is_number = isinstance(number, int | float) and not isinstance(number, bool)
            if not is_number or not abs(number) < inf:
                problems.append(f"{path}.{show(name)}: {show(number)} is not a finite number; write one")
        return value

    def shape(self) -> dict[str, Any]:
        return {"type": "object", "additionalProperties": {"type": "number"}}


@dataclass(frozen=True, kw_only=True)
class Column(Key):
    """A column by its name or by its number, from 1."""

    def read(self, value: Any, path: str, problems: list[str]) -> str | int | None:
        if isinstance(value, int) and not isinstance(value, bool) and value >= 1:
            return value
        if isinstance(value, str) and value and "\0" not in value:
            return value
        fault = f'{show(value)} is no column; write its name in "quotes", or its number from 1'
        problems.append(f"{path}: {fault}")
        return None

    def shape(self) -> dict[str, Any]:
        return {"type": ["string", "integer"], "minimum": 1}


@dataclass(frozen=True, kw_only=True)
class Texts(Key):
    """A list of strings."""

    def read(self, value: Any, path: str, problems: list[str]) -> list[str] | None:
        if isinstance(value, list) and all(isinstance(each, str) for each in value):
            return value
        problems.append(f'{path}: {show(value)} is no list of strings; write ["NA", "-9999"]')
        return None

    def shape(self) -> dict[str, Any]:
        return {"type": "array", "items": {"type": "string"}}


@dataclass(frozen=True, kw_only=True)
class RecordTable(Table):
    """Keys of a test."""

    def read(self, value: Any, path: str, problems: list[str]) -> dict[str, Any]:
        stated = [key for key in self.keys if key.startswith("amplitude_") and key != AMPLITUDE_STD.key]
        if isinstance(value, dict) and "amplitude_std" in value and not value.keys() & set(stated):
            at = f"{path}." if path else ""
            problems.append(f"{at}amplitude_std: given without {' or '.join(stated)}; omit it")
        read = super().read(value, path, problems)
        if read.get("from_s", -inf) >= read.get("to_s", inf):
            at = f"{path}." if path else ""
            problems.append(f"{at}to_s: {read['to_s']:g} is not after from_s = {read['from_s']:g}")
        return read


@dataclass(frozen=True, kw_only=True)
class Input(Inline):
    """The recorded input, whose unit is one of its quantity."""

    def read(self, value: Any, path: str, problems: list[str]) -> dict[str, Any]:
        read = super().read(value, path, problems)
        if {"quantity", "unit"} <= read.keys() and read["unit"] not in UNITS[read["quantity"]]:
            valid = ", ".join(UNITS[read["quantity"]])
            fault = f"{show(read['unit'])} is no unit of {read['quantity']}; valid here: {valid}"
            problems.append(f"{path}.unit: {fault}")
        return read


def columns_of(columns: Mapping[str, Any], kind: str, alone: bool) -> dict[str, Any]:
    """The declared channels that the files of tests of a kind have; all of them if no other kind is there."""
    if alone:
        return dict(columns)
    used = [
        name for name in CHANNELS[kind] if (kind, name) != (LOOP, "velocity") or "displacement" not in columns
    ]
    return {name: each for name, each in columns.items() if name in used}


def units(channel: str, quantity: str | None = None) -> dict[str, float]:
    """Units of a channel, by name, and their sizes in SI; an input has those of its quantity."""
    if channel != INPUT:
        return UNITS["force" if channel in (KNOWN_FORCE, NORMAL_FORCE) else channel]
    if quantity is not None:
        return UNITS[quantity]
    return {name: size for each in QUANTITIES for name, size in UNITS[each].items()}


SCALE = Quantity("scale", nan, "unit per number in the file: 200 where it holds volts, at 200 N/V")
SIGN = Quantity("sign", nan, "1, or -1 for a channel of the other sign", minimum=-1.0, maximum=1.0)
DELAY = Quantity("delay_ms", nan, "time by which this channel is late")
DELAY_STD = Quantity("delay_std_ms", nan, "std of that time, which is then fitted", above=0.0)
RATE = Quantity("rate_hz", nan, "sampling rate, where no column holds the time", above=0.0)
# Keys that every channel has beside its column and its unit.
COMMON = (
    Text("file", "file of this channel; by default that of the test", optional=True),
    *(Number.of(each, optional=True) for each in (SCALE, SIGN, DELAY, DELAY_STD, RATE)),
    Texts(key="missing", meaning="texts of missing samples, beside NA, NaN, #N/A", optional=True),
)
INTERVAL = Flag("interval", "whether the column holds the time since the row before", default=False)


def _channel(name: str, meaning: str, column: str, unit: str, *more: Key, optional: bool = False) -> Table:
    return table(
        name,
        meaning,
        Column("column", "name of the column, or its number", example=column),
        Unit("unit", "its unit", choices=tuple(units(name)), example=unit),
        *more,
        *((INTERVAL, COMMON[-1]) if name == "time" else COMMON),
        kind=Input if name == INPUT else Inline,
        optional=optional,
    )


def _override(channel: Key) -> Table:
    """The same channel in one test: every key is optional there."""
    assert isinstance(channel, Table)
    keys = (replace(key, optional=True, default=None) for key in channel.keys.values())
    return table(channel.key, channel.meaning, *keys, kind=type(channel), optional=True)


def _uncertain(name: str) -> Number:
    meaning = (
        "std (rms) of the second and of the third harmonic of the stated input over its amplitude; "
        "the same in all tests"
        if name == DISTORTION
        else f"relative std of the quantity that the effect {name} scales"
    )
    return Number.of(Quantity(name, nan, meaning, above=0.0, below=1.0), optional=True)


OF = Choice(
    "of",
    "motion of the mass against its base, or against the ground",
    choices=(RELATIVE, ABSOLUTE),
    default=RELATIVE,
)
QUANTITY = Choice("quantity", "what was recorded of the input", choices=QUANTITIES, example="displacement")
INPUT_GAIN_STD = Quantity(
    "input_gain_std", 0.0, "relative std of the gain of the recorded input", minimum=0.0, below=1.0
)
INPUT_HARMONICS_STD = Quantity(
    "input_harmonics_std",
    0.0,
    "steady, stated amplitudes: std of each harmonic of the input over its amplitude",
    minimum=0.0,
    below=1.0,
)
INPUT_STDS = (INPUT_GAIN_STD.key, INPUT_HARMONICS_STD.key)
ZERO_STD = Quantity(
    "zero_std", nan, "std of the zero of the load cell from test to test, in this unit", minimum=0.0
)
DERIVED = Flag("derived", "whether it is computed from the displacement", default=False)

COLUMNS = table(
    "columns",
    "column and unit of each channel",
    _channel("time", "time stamps", "t", "s", optional=True),
    _channel("displacement", "side frame minus bolster, x - y", "d", "mm", OF, optional=True),
    _channel("velocity", "relative velocity, x' - y'", "v", "mm/s", DERIVED, OF, optional=True),
    _channel("acceleration", "relative acceleration, x'' - y''", "a", "m/s^2", OF, optional=True),
    _channel("force", "force on the mass", "f", "N", optional=True),
    _channel(INPUT, "input as recorded", "u", "mm", QUANTITY, optional=True),
    _channel(
        KNOWN_FORCE, "force on the mass beside force or input, as of a pressure", "p", "N", optional=True
    ),
    _channel(
        NORMAL_FORCE,
        "normal force of one wedge on its column; oscillator: of its contact",
        "n",
        "N",
        Number.of(ZERO_STD, example=0.1),
        optional=True,
    ),
    example="measurement.columns",
)

DIALECT = table(
    "csv",
    "how the CSV files are written; what is left out is detected",
    Choice("delimiter", "separator of the columns", choices=tuple(DELIMITERS), optional=True),
    Choice("decimal", "decimal sign", choices=tuple(DECIMALS), optional=True),
    Choice("thousands", "sign between thousands", choices=tuple(THOUSANDS), optional=True),
    Whole.of(Quantity("skip_rows", 0, "lines above the header", minimum=0)),
    Text("encoding", "encoding of the text", optional=True, example="latin-1"),
    default={},
)

UNCERTAIN = table(
    "uncertain", "uncertain numbers of the model", *map(_uncertain, (*PARAMETERS, DISTORTION)), default={}
)

TEST = table(
    "test",
    "one record",
    Text("file", "file, relative to this one", example="20hz.csv"),
    Choice("kind", "kind of this test, if the tests are of several", choices=KINDS, optional=True),
    *(Number.of(each, optional=True) for each in (LOWPASS, FREQUENCY, AMPLITUDE, FORCE_AMPLITUDE)),
    Number.of(AMPLITUDE_STD),
    *(Number.of(each, optional=True) for each in (FROM, TO)),
    DETREND,
    Text("repeat_of", "file of the test that this one repeats: what differs is noise", optional=True),
    UNDRIVEN,
    table(
        "columns",
        "keys of channels that differ in this test",
        *map(_override, COLUMNS.keys.values()),
        optional=True,
    ),
    Number.of(thermal_drift.TEMPERATURE, default=None, optional=True, example=20.0),
    Overrides("model", "numbers of the model in this test", optional=True),
    kind=RecordTable,
)

MEASUREMENT = table(
    "measurement",
    "measured data",
    Text("title", "title of the measurement", default="measurement"),
    Text("model", "the base model: a config, relative to this file", example="model.toml"),
    Choice(
        "kind",
        "steady: periodic response; transient: decay, sweep; loop: force under a motion",
        choices=KINDS,
        default=STEADY,
    ),
    Number.of(MODEL_ERROR),
    Number.of(RATE, optional=True),
    COLUMNS,
    DIALECT,
    Number.of(INPUT_GAIN_STD),
    Number.of(INPUT_HARMONICS_STD),
    UNCERTAIN,
    TableList("test", "the tests", item=TEST, example="measurement.test"),
)

ROOT = table("", "measured data", MEASUREMENT)
