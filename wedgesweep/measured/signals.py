"""Channels of a test as they are in their files: samples in SI at time stamps of their own."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from math import floor, inf
from pathlib import Path
from typing import Any

import numpy as np

from wedgesweep import readers
from wedgesweep.hints import show
from wedgesweep.measured.clock import resolution
from wedgesweep.measured.declarations import units as units_of
from wedgesweep.readers import ReadError, Table
from wedgesweep.readers.table import DATETIME, Channel
from wedgesweep.units import DATES, DAY, UNITS, usual

# Number of faulty samples that are listed per file; the others are counted.
LISTED = 3
# Stamps between these numbers (1954 to 2119 as days of Excel) that are closer than FASTEST are no seconds:
# vibrations are not sampled at over 500 kHz.
EXCEL, FASTEST = (2e4, 8e4), 2e-6
# Distance from the median, over that of all other samples, of a number that may stand for a missing one.
FAR = 10.0
CLOCK = "write the column time in [measurement.columns], or rate_hz in [measurement]"


@dataclass(frozen=True, eq=False)
class Signal:
    """Samples (n,) in SI at stamps (n,) in s that are rounded to ``resolution`` (s), shape (n,).

    NaN where missing. ``where`` names the place of a sample in its file; ``faults`` are those of samples.
    """

    time: np.ndarray
    samples: np.ndarray
    resolution: np.ndarray
    where: Callable[[int], str]
    faults: Mapping[int, str] = field(default_factory=dict)

    def of(self, rows: np.ndarray) -> "Signal":
        """Some of the samples, by their indices; the same signal if these are all."""
        if rows.size == self.time.size:
            return self
        faults = {i: self.faults[row] for i, row in enumerate(rows.tolist()) if row in self.faults}
        return Signal(
            self.time[rows],
            self.samples[rows],
            self.resolution[rows],
            lambda i: self.where(int(rows[i])),
            faults,
        )


Signals = dict[str, Signal]


def read_signals(
    folder: Path, given: Mapping[str, Any], measurement: Mapping[str, Any], problems: list[str]
) -> tuple[Signals, list[str]]:
    """Signals of a test by channel, and remarks on its files; none after a fault.

    ``given`` are the keys of the test, ``measurement`` has columns, csv and rate_hz. Time counts from the
    first stamp where it is a date.
    """
    columns = dict(measurement["columns"])
    time = columns.pop("time", None)
    by_file: dict[str, dict[str, Any]] = {}
    for name, channel in columns.items():
        by_file.setdefault(channel.get("file", given["file"]), {})[name] = channel
    signals: Signals = {}
    remarks: list[str] = []
    before = len(problems)
    for file, own in by_file.items():
        # The clock of another file than the test's may count in another unit.
        clock = time and {**time, "own_unit": file != given["file"]}
        try:
            signals |= _FileOfSignals(folder / file, own, clock, measurement).read(problems, remarks)
        except ReadError as error:
            problems.extend(error.problems)
    if len(problems) > before:
        return {}, []
    if any(remark == DATETIME for remark in remarks) or (time and time["unit"] in DATES):
        origin = next(iter(signals.values())).time
        origin = origin[np.isfinite(origin)][:1]
        signals = {name: _later(each, -origin.sum()) for name, each in signals.items()}
    return signals, [each for each in dict.fromkeys(remarks) if each != DATETIME]


def _later(signal: Signal, delay: float) -> Signal:
    return Signal(signal.time + delay, signal.samples, signal.resolution, signal.where, signal.faults)


@dataclass(frozen=True)
class _FileOfSignals:
    """A file, the channels that are in it, and the column of the time (None: there is none)."""

    file: Path
    channels: Mapping[str, Mapping[str, Any]]
    time: Mapping[str, Any] | None
    measurement: Mapping[str, Any]

    def read(self, problems: list[str], remarks: list[str]) -> Signals:
        table = self._table()
        remarks.append(table.form)
        timed = {"time": self.time} if self.time is not None and self._timed else {}
        faults = [
            f"{self.file}: {fault}"
            for name, channel in {**self.channels, **timed}.items()
            for fault in _unit_faults(name, table.channels[channel["column"]], channel, remarks)
        ]
        clocks: dict[Any, tuple[np.ndarray, np.ndarray, Mapping[int, str]]] = {}
        signals = {}
        for name, channel in self.channels.items():
            found = table.channels[channel["column"]]
            key = channel.get("rate_hz") or (self._timed or id(found.clock))
            try:
                time, rounding, odd = clocks.setdefault(key, self._clock(table, found, channel, remarks))
            except ValueError as error:
                faults.append(f"{self.file}: {error}")
                break
            if time.size != found.values.size:
                sizes = f"{channel['column']} {found.values.size}, time {time.size}"
                faults.append(f"{self.file}: variables of different numbers of samples: {sizes}")
                continue
            late = 1e-3 * channel.get("delay_ms", 0.0)
            values = _missing(found.values, channel)
            faults += [f"{self.file}: {name}: {fault}" for fault in _stand_in_faults(values)]
            samples = values * _size(name, channel)
            signals[name] = Signal(
                time - late if late else time, samples, rounding, table.where, {**found.faults, **odd}
            )
        problems.extend(faults)
        return {} if faults else signals

    @property
    def _timed(self) -> bool:
        """Whether a column of the file holds the time."""
        return self.time is not None and not all("rate_hz" in each for each in self.channels.values())

    def _table(self) -> Table:
        names = [channel["column"] for channel in self.channels.values()]
        specs = list(self.channels.values())
        if self.time is not None and self._timed:
            names.append(self.time["column"])
            specs.append(self.time)
        missing = [text for spec in specs for text in spec.get("missing", ())]
        return readers.read(self.file, names, {**self.measurement.get("csv", {}), "missing": missing})

    def _clock(
        self, table: Table, found: Channel, channel: Mapping[str, Any], remarks: list[str]
    ) -> tuple[np.ndarray, np.ndarray, Mapping[int, str]]:
        """Stamps (s), their rounding (s) and the faults of single ones; raises ValueError."""
        rate = channel.get("rate_hz")
        if rate is None and self.time is not None:
            return _stamps(table.channels[self.time["column"]], self.time, remarks)
        if rate is None and found.clock is not None:
            return found.clock, np.zeros(found.clock.size), {}
        rate = rate or self.measurement.get("rate_hz")
        if rate is None:
            fault = f"holds no time; {CLOCK}"
            raise ValueError(fault)
        time = np.arange(found.values.size) / rate
        return time, np.zeros(time.size), {}


def _stamps(
    column: Channel, time: Mapping[str, Any], remarks: list[str]
) -> tuple[np.ndarray, np.ndarray, Mapping[int, str]]:
    """Stamps (s), their rounding (s), and the faults of single ones; raises ValueError."""
    unit = usual(column.unit) if time["own_unit"] and usual(column.unit) in UNITS["time"] else time["unit"]
    values = _missing(column.values, time)
    if column.unit == DATETIME:
        remarks += [DATETIME, "time stamps are dates"] if unit != DATETIME else [DATETIME]
        return values, np.full(values.size, 1e-6), column.faults
    if unit == DATETIME:
        fault = 'time: unit = "datetime", but its cells are no ISO 8601 dates; write another unit'
        raise ValueError(fault)
    finite = values[np.isfinite(values)]
    steps = np.diff(finite[[0, -1]]) * UNITS["time"][unit] / finite.size if finite.size else np.ones(1)
    if unit not in DATES and EXCEL[0] < finite[:1].sum() < EXCEL[1] and abs(steps[0]) < FASTEST:
        fault = f'time: {finite[0]:.12g} looks like days of Excel; write unit = "excel" for the time'
        raise ValueError(fault)
    size, rounding = UNITS["time"][unit], np.zeros(values.size)
    rounding[np.isfinite(values)] = resolution(finite) * size
    if time.get("interval"):
        values = np.cumsum(values) - values[:1]
    if unit in DATES and finite.size:
        day = DAY / size
        values = values - day * floor(finite[0] / day)
    return values * size, rounding, column.faults


def _missing(values: np.ndarray, channel: Mapping[str, Any]) -> np.ndarray:
    """Samples (n,), NaN where they are numbers that stand for missing ones."""
    for text in channel.get("missing", ()):
        try:
            values = np.where(values == float(text), np.nan, values)
        except ValueError:
            continue
    return values


def _stand_in_faults(values: np.ndarray) -> list[str]:
    """A number that is repeated far from all others, as some loggers write it for a missing sample."""
    numbers = values[np.isfinite(values)]
    for number in (numbers.min(), numbers.max()) if numbers.size else ():
        others = numbers[numbers != number]
        count, middle = numbers.size - others.size, float(np.median(others)) if others.size else 0.0
        if count > 1 and others.size > count and abs(number - middle) > FAR * np.abs(others - middle).max():
            fault = f"{number:.12g} occurs {count} times, far from all other samples"
            return [f'{fault}; if it stands for a missing sample, write missing = ["{number:.12g}"]']
    return []


def _size(name: str, channel: Mapping[str, Any]) -> float:
    """Size in SI of 1 in the file."""
    unit: float = units_of(name)[channel["unit"]]
    return unit * float(channel.get("scale", 1.0)) * float(channel.get("sign", 1.0))


def _unit_faults(name: str, column: Channel, channel: Mapping[str, Any], remarks: list[str]) -> list[str]:
    """Why the unit that a file names is not the stated one; an unknown unit is a remark."""
    written, stated = usual(column.unit), channel["unit"]
    if not written or written == stated or channel.get("scale", 1.0) != 1.0 or channel.get("own_unit"):
        return []
    if written == DATETIME:
        return [] if name == "time" else [f"{name}: the column holds dates; name another one"]
    valid = units_of(name)
    if valid.get(written) == valid[stated]:
        return []
    if any(written in units for units in UNITS.values()):
        fault = f"{name}: the file says {show(written)}, its unit is stated as {show(stated)}"
        return [f"{fault}; correct one of them"]
    remarks.append(f"{name}: unit {show(written)} of the file is unknown, and not compared with {stated}")
    return []


def selected(signals: Signals, given: Mapping[str, Any], file: str, at: str, problems: list[str]) -> Signals:
    """The part of a test from from_s to to_s, and the faults of its samples."""
    start, end = given.get("from_s", -inf), given.get("to_s", inf)
    if start < end and (start, end) != (-inf, inf):
        times = [each.time[np.isfinite(each.time)] for each in signals.values()]
        first, last = (float(f([f(t) for t in times if t.size] or [0.0])) for f in (np.min, np.max))
        if not (start < last and end > first):
            key, value = ("to_s", end) if end <= first else ("from_s", start)
            span = f"{file} goes from {first:.6g} to {last:.6g} s; choose a time within"
            problems.append(f"{at}.{key}: {value:g}, but {span}")
            return signals
        signals = {name: _between(each, start, end) for name, each in signals.items()}
    faults: dict[str, str] = {}
    for each in signals.values():
        for row, fault in each.faults.items():
            faults.setdefault(each.where(row), fault)
    listed = [f"{place}: {fault}" for place, fault in faults.items()]
    problems.extend(listed[:LISTED])
    if len(listed) > LISTED:
        problems.append(f"{file}: {len(listed) - LISTED} more such faults")
    return signals


def _between(signal: Signal, start: float, end: float) -> Signal:
    """A span of time; rows without a stamp belong to it if they stand among its rows."""
    inside = np.flatnonzero((signal.time >= start) & (signal.time <= end))
    among = np.isnan(signal.time)
    among[: inside[0] if inside.size else None] = False
    among[inside[-1] if inside.size else 0 :] = False
    return signal.of(np.union1d(inside, np.flatnonzero(among)))


def reference(names: Iterable[str]) -> str:
    """The channel on whose clock all others meet: the first response."""
    ordered = [
        name for name in ("displacement", "velocity", "acceleration", "force", "input") if name in names
    ]
    return ordered[0]
