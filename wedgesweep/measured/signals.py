"""Channels of a test as they are in their files: samples in SI at time stamps of their own."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from math import floor, inf
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from wedgesweep import readers
from wedgesweep.hints import show
from wedgesweep.measured.clock import continued, resolution
from wedgesweep.measured.declarations import units as units_of
from wedgesweep.readers import ReadError, Table
from wedgesweep.readers.table import DATETIME, Channel
from wedgesweep.units import DATES, DAY, UNITS, is_dated, usual

# Number of faulty samples that are listed per file; the others are counted.
LISTED = 3
# Stamps between these numbers (1954 to 2119 as days of Excel) that are closer than FASTEST are no seconds:
# vibrations are not sampled at over 500 kHz.
EXCEL, FASTEST = (2e4, 8e4), 2e-6
# Distance from the median, over that of all other samples, of a number that may stand for a missing one.
FAR = 10.0
# A sensor that hangs repeats a number STUCK times or more, and then jumps by JUMP times its median step.
# Where more than this share of the samples hang, or of other steps are none, it is coarse or rests.
STUCK, JUMP, RARE = 10, 10.0, 0.05
# A spike is farther from both neighbours than this many times the range of all others but the share SELDOM,
# in a record of FEWEST samples or more: no motion that is sampled four times a period comes back as fast.
SPIKE, SELDOM, FEWEST = 2.0, 1e-3, 64
CLOCK = "write the column time in [measurement.columns], or rate_hz in [measurement]"


@dataclass(frozen=True, eq=False)
class Signal:
    """Samples (n,) in SI at stamps (n,) in s that are rounded to ``resolution`` (s), shape (n,).

    NaN where missing. ``where`` names the place of a sample in its file; ``faults`` are those of samples;
    ``dated``: whether time counts from a date.
    """

    time: np.ndarray
    samples: np.ndarray
    resolution: np.ndarray
    where: Callable[[int], str]
    faults: Mapping[int, str] = field(default_factory=dict)
    dated: bool = False

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


@np.errstate(over="ignore")  # numbers in the files may be of any size, and are refused later
def read_signals(
    folder: Path, given: Mapping[str, Any], measurement: Mapping[str, Any], problems: list[str]
) -> tuple[Signals, list[str]]:
    """Signals of a test by channel, and remarks on its files; none after a fault.

    ``given`` are the keys of the test, ``measurement`` has columns, csv and rate_hz. Time counts from the
    first stamp where it is a date.
    """
    columns = dict(measurement["columns"])
    time = columns.pop("time", None)
    files: dict[str, dict[str, Any]] = {}
    for name, channel in columns.items():
        files.setdefault(channel.get("file", given["file"]), {})[name] = channel
    signals: Signals = {}
    remarks: list[str] = []
    faults: list[str] = []
    for file, own in files.items():
        # The clock of another file than the test's may count in another unit.
        clock = time and {**time, "own_unit": file != given["file"]}
        try:
            signals |= _signals_of(folder / file, own, clock, measurement, faults, remarks)
        except ReadError as error:
            faults.extend(error.problems)
    problems.extend(faults)
    if faults:
        return {}, []
    starts = [each.time[np.isfinite(each.time)][:1].sum() for each in signals.values() if each.dated]
    return {
        name: replace(each, time=each.time - starts[0]) if each.dated else each
        for name, each in signals.items()
    }, list(dict.fromkeys(remarks))


def _signals_of(
    file: Path,
    channels: Mapping[str, Mapping[str, Any]],
    time: Mapping[str, Any] | None,
    measurement: Mapping[str, Any],
    faults: list[str],
    remarks: list[str],
) -> Signals:
    """Signals of the channels in one file; raises ReadError."""
    timed = time is not None and not all("rate_hz" in channel for channel in channels.values())
    read = {**channels, "time": time} if time is not None and timed else dict(channels)
    missing = [text for channel in read.values() for text in channel.get("missing", ())]
    stated = {**measurement.get("csv", {}), "missing": missing}
    table = readers.read(file, [channel["column"] for channel in read.values()], stated)
    remarks.append(table.form)
    columns = {name: table.channels[channel["column"]] for name, channel in read.items()}
    found = [fault for name in read for fault in _unit_faults(name, columns[name], read[name], remarks)]
    signals = {}
    try:
        stamps = _stamps(columns["time"], read["time"], remarks) if timed else None
        for name, channel in channels.items():
            rate = channel.get("rate_hz") or (None if timed else measurement.get("rate_hz"))
            signals[name] = _without_stuck(
                name, _signal(name, channel, columns[name], (stamps, rate), table), remarks
            )
    except ValueError as error:
        found.append(str(error))
    faults.extend(f"{file}: {fault}" for fault in found)
    return signals


def _signal(
    name: str,
    channel: Mapping[str, Any],
    column: Channel,
    clock: tuple["_Stamps | None", float | None],
    table: Table,
) -> Signal:
    """A channel in SI by the stamps of the file, a rate (Hz) or its own clock; raises ValueError."""
    stamps, rate = clock
    values = _missing(column.values, channel)
    _refuse_stand_ins(name, values)
    own = np.arange(values.size) / rate if rate else column.clock
    if own is not None and (rate or stamps is None):
        stamps = _Stamps(own, np.zeros(own.size))
    if stamps is None:
        fault = f"holds no time; {CLOCK}"
        raise ValueError(fault)
    if stamps.time.size != values.size:
        sizes = f"{channel['column']} {values.size}, time {stamps.time.size}"
        fault = f"variables of different numbers of samples: {sizes}"
        raise ValueError(fault)
    late = 1e-3 * channel.get("delay_ms", 0.0)
    size = units_of(name)[channel["unit"]] * channel.get("scale", 1.0) * channel.get("sign", 1.0)
    faults = {**column.faults, **stamps.faults}
    return Signal(stamps.time - late, size * values, stamps.resolution, table.where, faults, stamps.dated)


def _without_stuck(name: str, signal: Signal, remarks: list[str]) -> Signal:
    """A signal without samples of a sensor that hung: they are missing."""
    stuck = stuck_samples(signal.samples)
    if not stuck.any():
        return signal
    count, first = int(np.count_nonzero(stuck)), float(signal.time[int(stuck.argmax())])
    remarks.append(f"{name} hangs for {count} samples, the first after {first:.6g} s: they count as missing")
    return replace(signal, samples=np.where(stuck, np.nan, signal.samples))


def without_spikes(name: str, signal: Signal, remarks: list[str]) -> Signal:
    """A signal without samples that no motion makes: they are missing. A force may be as short as a hit."""
    far = spikes(signal.samples) if name in ("displacement", "velocity") else np.zeros(0, bool)
    if not far.any():
        return signal
    when = ", ".join(f"{each:.6g} s" for each in signal.time[far][:LISTED])
    more = " and more" if np.count_nonzero(far) > LISTED else ""
    remarks.append(f"{name} has a spike at {when}{more} that no motion makes: it counts as missing")
    return replace(signal, samples=np.where(far, np.nan, signal.samples))


def spikes(samples: np.ndarray) -> np.ndarray:
    """Which of samples (n,) are farther from both neighbours than twice the range of nearly all others."""
    known, found = np.flatnonzero(np.isfinite(samples)), np.zeros(samples.size, bool)
    if known.size < FEWEST:
        return found
    steps = np.abs(np.diff(samples[known]))
    apart = np.r_[0.0, np.minimum(steps[:-1], steps[1:]), 0.0]
    rest = known.size - max(int(SELDOM * known.size), 1)
    others = samples[known[np.argpartition(apart, rest)[:rest]]]
    found[known[apart > SPIKE * np.ptp(others)]] = True
    return found


def stuck_samples(samples: np.ndarray) -> np.ndarray:
    """Which of samples (n,) a sensor repeated before it jumped; not those at its extremes."""
    known, found = np.flatnonzero(np.isfinite(samples)), np.zeros(samples.size, bool)
    if known.size < 2:
        return found
    values = samples[known]
    steps = np.abs(np.diff(values))
    runs, typical = marked_runs(steps == 0.0), float(np.median(steps))
    lengths = runs[:, 1] - runs[:, 0]
    for start, end in runs[lengths >= STUCK].tolist():
        inside = start > 0 and end < steps.size and values.min() < values[start] < values.max()
        found[known[start + 1 : end + 1]] = inside and steps[end] > JUMP * typical
    shorter = int(lengths[lengths < STUCK].sum())
    coarse = max(shorter, int(np.count_nonzero(found))) > RARE * values.size
    return np.zeros(samples.size, bool) if coarse else found


def marked_runs(marked: np.ndarray) -> np.ndarray:
    """First sample and end (k, 2) of each run of marked samples (n,)."""
    return np.flatnonzero(np.diff(np.r_[False, marked, False].astype(int))).reshape(-1, 2)


class _Stamps(NamedTuple):
    """Stamps (n,) in s, their rounding (n,) in s, faults by sample, and whether they count from a date."""

    time: np.ndarray
    resolution: np.ndarray
    faults: Mapping[int, str] = {}
    dated: bool = False


def _stamps(column: Channel, time: Mapping[str, Any], remarks: list[str]) -> _Stamps:
    """The stamps in a column; raises ValueError."""
    unit = usual(column.unit) if time["own_unit"] and usual(column.unit) in UNITS["time"] else time["unit"]
    values = _missing(column.values, time)
    if column.unit == DATETIME:
        remarks.append("" if unit == DATETIME else "time stamps are dates")
        return _Stamps(values, np.full(values.size, 1e-6), column.faults, dated=True)
    if unit == DATETIME:
        fault = 'time: unit = "datetime", but its cells are no dates; write another unit'
        raise ValueError(fault)
    size, rounding = UNITS["time"][unit], np.zeros(values.size)
    finite = values[np.isfinite(values)]
    rounding[np.isfinite(values)] = resolution(finite) * size
    first, span = (float(finite[0]), float(np.ptp(finite)) * size) if finite.size else (0.0, 0.0)
    if unit not in DATES and EXCEL[0] < first < EXCEL[1] and span < FASTEST * finite.size:
        fault = f'time: {first:.12g} looks like days of Excel; write unit = "excel" for the time'
        raise ValueError(fault)
    if time.get("interval"):
        values = np.cumsum(values) - values[:1]
    values, between = continued(values)
    if between:
        runs = f"one every {between * size:g} s of from_s and to_s"
        remarks.append(f"time begins anew in the file: its runs follow one another, {runs}")
    dated = is_dated(unit, first)
    if dated:
        values = values - DAY / size * floor(first * size / DAY)
    return _Stamps(values * size, rounding, column.faults, dated)


def _missing(values: np.ndarray, channel: Mapping[str, Any]) -> np.ndarray:
    """Samples (n,), NaN where they are numbers that stand for missing ones."""
    for text in channel.get("missing", ()):
        try:
            values = np.where(values == float(text), np.nan, values)
        except ValueError:
            continue
    return values


def _refuse_stand_ins(name: str, values: np.ndarray) -> None:
    """Raise ValueError for a number that may stand for a missing sample."""
    for number, count in stand_ins(values).items():
        fault = f"{name}: {number} occurs {count} times, far from all other samples"
        mend = f'if it stands for a missing sample, write missing = ["{number}"]'
        raise ValueError(f"{fault}; {mend}")


def stand_ins(values: np.ndarray) -> dict[str, int]:
    """How often numbers far from all others occur, as some loggers write for a missing sample."""
    numbers, found = values[np.isfinite(values)], {}
    for number in (numbers.min(), numbers.max()) if numbers.size else ():
        others = numbers[numbers != number]
        count, middle = numbers.size - others.size, float(np.median(others)) if others.size else 0.0
        if count > 1 and others.size > count and abs(number - middle) > FAR * np.abs(others - middle).max():
            found[f"{number:.12g}"] = count
    return found


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
