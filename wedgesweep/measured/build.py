"""Builds the record of a test in SI units from the numbers in a file; faults name their place."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from math import inf, nan
from typing import Any

import numpy as np

from wedgesweep.measured import decimation, sampling
from wedgesweep.measured.cycles import slope_of_means
from wedgesweep.measured.declarations import (
    AMPLITUDE,
    FORCE_AMPLITUDE,
    INPUT,
    LOOP,
    STEADY,
    TRANSIENT,
    units,
)
from wedgesweep.measured.frequency import FEWEST_CYCLES, estimate_frequency
from wedgesweep.measured.kinds import loop_faults, transient_faults
from wedgesweep.measured.measurement import TestRecord
from wedgesweep.measured.plausibility import channel_faults
from wedgesweep.measured.quality import trend_faults
from wedgesweep.measured.stationarity import stationarity_faults, without_trend
from wedgesweep.measured.steadiness import MOST_SAMPLES, frequency_faults
from wedgesweep.units import UNITS

# Bounds of a channel in SI units, and the variation that is rounding, over its size.
LARGEST, SMALLEST, ROUNDING = 1e12, 1e-15, 1e-13


@dataclass(frozen=True)
class Channels:
    """Columns of a test as in its file, shape (n,) each, with their units.

    ``file`` names the file and ``where`` the place of a sample in it; ``form`` says how it is written where
    that is unusual.
    """

    columns: Mapping[str, np.ndarray]
    units: Mapping[str, str]
    file: str
    where: Callable[[int], str]
    form: str = ""

    def si(self, channel: str) -> np.ndarray | None:
        """Samples of a channel in SI units, or None."""
        if channel not in self.columns:
            return None
        return self.columns[channel] * units(channel)[self.units[channel]]

    def between(self, start: float, end: float) -> "Channels":
        """The samples of a span of time (s)."""
        kept = np.flatnonzero((self.seconds >= start) & (self.seconds <= end))
        columns = {name: samples[kept] for name, samples in self.columns.items()}
        return replace(self, columns=columns, where=lambda sample: self.where(int(kept[sample])))

    def without_trend(self, frequency: float) -> "Channels":
        """The same without the drift of channels that vibrate at a frequency (Hz; NaN: at none)."""
        time = self.seconds
        straight = {
            name: _straightened(time, samples, frequency)
            for name, samples in self.columns.items()
            if name != "time"
        }
        return replace(self, columns={**self.columns, **straight})

    @property
    def seconds(self) -> np.ndarray:
        """The time stamps (n,) in s."""
        return self.columns["time"] * UNITS["time"][self.units["time"]]


def build_record(
    name: str, given: Mapping[str, Any], channels: Channels, at: str, problems: list[str]
) -> TestRecord | None:
    """Build the record of a test from its checked keys ``given``, found at ``at``; None after a fault."""
    before = len(problems)
    recorded, channels = channels, _selected(given, channels, at, problems)
    problems.extend(f"{channels.file}: {fault}" for fault in _size_faults(channels))
    if len(problems) > before:
        return None
    grid = sampling.even_grid(channels.columns["time"], channels.where, problems)
    if len(problems) > before:
        return None
    frequency = _frequency(given, channels, grid)
    if given.get("detrend", False):
        channels = channels.without_trend(frequency)
    cut = channels.seconds.size != recorded.seconds.size
    channels, grid, thinned = _shortened(given, channels, grid, frequency)
    amplitudes = [given[each.key] * each.factor for each in (AMPLITUDE, FORCE_AMPLITUDE) if each.key in given]
    test = TestRecord(
        name=name,
        file=given.get("file", channels.file),
        frequency=given.get("frequency_hz"),
        amplitude=amplitudes[0] if amplitudes else None,
        amplitude_std=given.get("amplitude_std", 0.0),
        time=grid * UNITS["time"][channels.units["time"]],
        displacement=channels.si("displacement"),
        velocity=channels.si("velocity"),
        acceleration=channels.si("acceleration"),
        input=channels.si(INPUT),
        model=given.get("model", {}),
        kind=given.get("kind", STEADY),
        force=channels.si("force"),
        cutoff=given.get("lowpass_hz"),
        recorded_s=float(np.ptp(recorded.seconds)) if cut else None,
        repeat_of=given.get("repeat_of"),
        remarks=tuple(filter(None, (channels.form, thinned))),
    )
    problems.extend(FAULTS[test.kind](test, channels.file, at))
    return None if len(problems) > before else test


def _steady_faults(test: TestRecord, file: str, at: str) -> list[str]:
    if not test.channels:  # a fault of the columns
        return []
    return (
        stationarity_faults(test, file)
        or frequency_faults(test, file, at)
        or trend_faults(test, file)
        or channel_faults(test, file)
    )


# Faults of a record (test, file, place of its keys) by its kind.
FAULTS = {STEADY: _steady_faults, TRANSIENT: transient_faults, LOOP: loop_faults}


def _selected(given: Mapping[str, Any], channels: Channels, at: str, problems: list[str]) -> Channels:
    """The part of the record that the keys of a test select."""
    start, end = given.get("from_s", -inf), given.get("to_s", inf)
    if (start, end) == (-inf, inf) or not start < end:  # the latter is a fault of the keys
        return channels
    first, last = channels.seconds.min(), channels.seconds.max()
    if not (start < last and end > first):
        key, value = ("to_s", end) if end <= first else ("from_s", start)
        span = f"{channels.file} goes from {first:.6g} to {last:.6g} s; choose a time within"
        problems.append(f"{at}.{key}: {value:g}, but {span}")
        return channels
    return channels.between(start, end)


def _size_faults(channels: Channels) -> Iterator[str]:
    """Channels of sizes that no vibration has, whose squares might not even be numbers."""
    for channel, column in channels.columns.items():
        samples = column * units(channel)[channels.units[channel]]
        largest = float(np.abs(samples).max(initial=0.0))
        if largest > LARGEST:
            yield f"{channel}: {largest:.3g} in SI units is too large; correct the unit or the file"
        elif samples.size and np.ptp(samples) <= max(SMALLEST, ROUNDING * largest):
            yield f"{channel} is constant; there is no vibration in it"


def _frequency(given: Mapping[str, Any], channels: Channels, grid: np.ndarray) -> float:
    """Frequency (Hz) of a steady record where its drift or its length matters, else NaN."""
    if given.get("kind", STEADY) != STEADY or not (given.get("detrend") or grid.size > MOST_SAMPLES):
        return nan
    names = [name for name in channels.columns if name != "time"]
    leading = channels.columns[INPUT if INPUT in names else names[0]][:MOST_SAMPLES]
    seconds = UNITS["time"][channels.units["time"]]
    stated: float | None = given.get("frequency_hz")
    return stated or estimate_frequency(grid[:MOST_SAMPLES] * seconds, without_trend(leading))


def _straightened(time: np.ndarray, samples: np.ndarray, frequency: float) -> np.ndarray:
    """Samples less their drift about the middle of the record."""
    if not FEWEST_CYCLES <= frequency * (time[-1] - time[0]) <= 0.25 * time.size:
        return without_trend(samples)
    return samples - slope_of_means(time, samples, frequency) * (time - time.mean())


def _shortened(
    given: Mapping[str, Any], channels: Channels, grid: np.ndarray, frequency: float
) -> tuple[Channels, np.ndarray, str]:
    """A steady record of at most MOST_SAMPLES, the times, and a remark if samples were left out."""
    if grid.size <= MOST_SAMPLES or given.get("kind", STEADY) != STEADY:
        return channels, grid, ""
    columns = {name: samples for name, samples in channels.columns.items() if name != "time"}
    seconds = UNITS["time"][channels.units["time"]]
    columns, grid, remark = decimation.shortened(columns, grid, frequency * seconds, MOST_SAMPLES)
    return replace(channels, columns={"time": grid, **columns}), grid, remark
