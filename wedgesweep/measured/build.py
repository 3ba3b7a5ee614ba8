"""Builds the record of a test in SI units from the numbers in a file; faults name their place."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from math import inf
from typing import Any

import numpy as np

from wedgesweep.measured import sampling
from wedgesweep.measured.declarations import (
    AMPLITUDE,
    FORCE_AMPLITUDE,
    INPUT,
    LOOP,
    STEADY,
    TRANSIENT,
    UNITS,
    units,
)
from wedgesweep.measured.kinds import loop_faults, transient_faults
from wedgesweep.measured.measurement import TestRecord
from wedgesweep.measured.plausibility import channel_faults
from wedgesweep.measured.stationarity import stationarity_faults, without_trend
from wedgesweep.measured.steadiness import frequency_faults


@dataclass(frozen=True)
class Channels:
    """Columns of a test as in its file, shape (n,) each, with their units.

    ``file`` names the file and ``where`` the place of a sample in it.
    """

    columns: Mapping[str, np.ndarray]
    units: Mapping[str, str]
    file: str
    where: Callable[[int], str]

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

    def without_trend(self) -> "Channels":
        """The same with the straight line through each channel removed."""
        straight = {name: without_trend(samples) for name, samples in self.columns.items() if name != "time"}
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
    if len(problems) == before:
        grid = sampling.even_grid(channels.columns["time"], channels.where, problems)
        for channel in set(channels.columns) - {"time"}:
            if np.ptp(channels.columns[channel]) == 0.0:
                problems.append(f"{channels.file}: {channel} is constant; there is no vibration in it")
    if len(problems) > before:
        return None
    if given.get("detrend", False):
        channels = channels.without_trend()
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
        recorded_s=None
        if channels.seconds.size == recorded.seconds.size
        else float(np.ptp(recorded.seconds)),
    )
    problems.extend(FAULTS[test.kind](test, channels.file, at))
    return None if len(problems) > before else test


def _steady_faults(test: TestRecord, file: str, at: str) -> list[str]:
    return stationarity_faults(test, file) or frequency_faults(test, file, at) or channel_faults(test, file)


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
        told = f"{channels.file} goes from {first:.6g} to {last:.6g} s; choose a time within"
        problems.append(f"{at}.{key}: {value:g}, but {told}")
        return channels
    return channels.between(start, end)
