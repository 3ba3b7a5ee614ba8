"""Checks of tests in which the motion is imposed and the force is measured."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from wedgesweep.measured.measurement import TestRecord

# The motion must come back by this share of its range, or friction cannot be told from a spring.
RETURNS = 0.1
# Highest cut-off over the sampling rate: the motion is filtered at twice that.
HIGHEST = 0.2
# Fewest samples over which a filter settles.
FEWEST = 64
# Keys of a test whose input is known as a sine.
OF_A_SINE = ("frequency_hz", "amplitude_mm")


def kind_faults(kinds: Sequence[str]) -> list[str]:
    """Faults of the kinds of the tests together, as "key: fault"."""
    if len(set(kinds)) < 2:
        return []
    mixed = " and ".join(sorted(set(kinds)))
    return [f"test.kind: {mixed} are mixed; write a measurement for each kind"]


def column_faults(columns: Mapping[str, Any]) -> list[str]:
    """Faults of the channels of loops, as "key: fault"."""
    faults = [
        f"{name}: missing; a loop is the force under a recorded displacement"
        for name in ("displacement", "force")
        if name not in columns
    ]
    extra = [name for name in columns if name not in ("time", "displacement", "force")]
    return faults + [
        f"{name}: not used in a loop, whose motion is its displacement; omit it" for name in extra
    ]


def key_faults(given: Mapping[str, Any]) -> list[str]:
    """Faults of the keys of a loop, as "key: fault"."""
    return [f"{key}: the motion of a loop is recorded; omit it" for key in OF_A_SINE if key in given]


def loop_faults(test: TestRecord, file: str, at: str) -> list[str]:
    """Faults of a loop, in its data or by its keys at ``at``."""
    assert test.displacement is not None
    if test.time.size < FEWEST:
        return [f"{file}: has {test.time.size} samples; at least {FEWEST} make a loop"]
    if test.cutoff is not None and not test.cutoff <= HIGHEST * test.sampling_rate:
        told = f"{test.cutoff:g} Hz is more than {HIGHEST:g} times the sampling rate"
        return [f"{at}.lowpass_hz: {told} of {test.sampling_rate:g} Hz; lower it, or omit it"]
    steps = np.diff(test.displacement)
    there, back = steps[steps > 0.0].sum(), -steps[steps < 0.0].sum()
    if min(there, back) < RETURNS * float(np.ptp(test.displacement)):
        told = "the displacement goes one way only, which cannot tell friction from a spring"
        return [f'{file}: {told}; record at least one cycle, or write kind = "steady" ({at}.kind)']
    return []
