"""Builds the record of a test in SI units from the numbers in a file; faults name their place."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
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


def build_record(
    name: str, given: Mapping[str, Any], channels: Channels, at: str, problems: list[str]
) -> TestRecord | None:
    """Build the record of a test from its checked keys ``given``, found at ``at``; None after a fault."""
    before = len(problems)
    grid = sampling.even_grid(channels.columns["time"], channels.where, problems)
    for channel in set(channels.columns) - {"time"}:
        if np.ptp(channels.columns[channel]) == 0.0:
            problems.append(f"{channels.file}: {channel} is constant; there is no vibration in it")
    if len(problems) > before:
        return None
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
    )
    problems.extend(FAULTS[test.kind](test, channels.file, at))
    return None if len(problems) > before else test


def _steady_faults(test: TestRecord, file: str, at: str) -> list[str]:
    return frequency_faults(test, file, at) or channel_faults(test, file)


# Faults of a record (test, file, place of its keys) by its kind.
FAULTS = {STEADY: _steady_faults, TRANSIENT: transient_faults, LOOP: loop_faults}
