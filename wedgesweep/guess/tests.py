"""Which files and runs are tests, and which files hold channels of the others."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import compress, pairwise
from pathlib import Path

import numpy as np

from wedgesweep.guess.columns import (
    DERIVED,
    FORCE,
    HUGE,
    INPUT,
    Chosen,
    Run,
    choose,
    known_samples,
    runs_of,
    slope,
    with_units,
)
from wedgesweep.guess.kind import WHOLE, Part, down, from_release, kind_of, parts_of, steady_part, swings_back
from wedgesweep.measured.clock import continued
from wedgesweep.measured.declarations import LOOP, MOTIONS, STEADY, TRANSIENT
from wedgesweep.measured.kinds import LARGE, released_again
from wedgesweep.measured.signals import spikes
from wedgesweep.readers.survey import Column, Survey
from wedgesweep.units import UNITS, is_dated

# Names of single numbers that are a sampling rate (Hz), and of those that are a sampling interval (s).
RATES = ("fs", "rate", "samplerate", "samplingrate", "samplefrequency", "samplingfrequency", "fsamp", "sr")
INTERVALS = ("dt", "ts", "interval", "sampleinterval", "samplinginterval", "timestep", "increment")
# Rate (Hz) where nothing tells it.
UNKNOWN_RATE = 1000.0


@dataclass(frozen=True, eq=False)
class Guessed:
    """A test: its file, its channels, its kind and why, and the part that is used.

    ``rate``: in Hz, without a time; ``negated``: a channel whose sign is the other one.
    """

    file: Path
    run: Run
    kind: str = STEADY
    reason: str = ""
    part: Part = WHOLE
    negated: str = ""
    rate: float | None = None


def tests_of(surveys: Sequence[Survey]) -> list[Guessed]:
    """The tests that files hold, in their order."""
    parts = [(survey, columns) for survey in surveys for columns in runs_of(known_samples(survey.columns))]
    first = choose(parts[0][1])
    found = [
        Guessed(survey.path, run, rate=_rate(survey) or _rate_of(run))
        for survey, columns in parts
        for run in [_like(first, parts[0][1], columns)]
    ]
    moving = [test for test in found if any(name in test.run.channels for name in MOTIONS)]
    others = [test for test in found if test not in moving and test.run.channels]
    if not moving:
        return [replace(test, reason="no column is known as a motion") for test in found]
    if others:
        moving = [_joined(test, other) for test, other in zip(moving, others, strict=False)]
    tests = [part for test in moving for part in _with_kind(test)]
    # Only loops that all have a load tell the coefficient of friction; without it a load is of no use.
    if all(test.kind == LOOP and test.run.load is not None for test in tests):
        return tests
    return [replace(test, run=replace(test.run, load=None)) for test in tests]


def _like(first: Run, theirs: Sequence[Column], columns: Sequence[Column]) -> Run:
    """The run of some columns: where they are named as those of the first run, each is what it is there."""
    run = choose(columns)
    layouts = [[(each.label, each.channel.unit) for each in both] for both in (theirs, columns)]
    if layouts[0] != layouts[1] or set(run.channels) != set(first.channels):
        return run
    same = {name: columns[theirs.index(each.column)] for name, each in first.channels.items()}
    if all(same[name] is each.column for name, each in run.channels.items()):
        return run
    return replace(run, channels=with_units(same))


def _rate(survey: Survey) -> float | None:
    """Sampling rate (Hz) by the single numbers of a file."""
    for name, value in survey.numbers.items():
        bare = re.sub(r"[\W_]", "", name.lower().rpartition(".")[2])
        if value > 0.0 and bare in (*RATES, *INTERVALS):
            return value if bare in RATES else 1.0 / value
    return None


def _rate_of(run: Run) -> float | None:
    """Sampling rate (Hz) at which a velocity is the slope of a displacement, whose units the file names."""
    both = [run.channels[name] for name in ("displacement", "velocity") if name in run.channels]
    if run.time is not None or len(both) < 2 or any(each.questions for each in both):
        return None
    size, left = slope(
        *(UNITS[name][each.unit] * each.values for name, each in zip(MOTIONS, both, strict=False))
    )
    return float(f"{1.0 / size:.4g}") if left < np.sqrt(1.0 - DERIVED**2) else None


def _joined(test: Guessed, other: Guessed) -> Guessed:
    """A test with the channels of another file, which has no motion of its own."""
    rate, both = _rate_beside(test, other), {**test.run.channels, **other.run.channels}
    channels = with_units({name: each.column for name, each in both.items()})
    for name in other.run.channels:
        keys = {**channels[name].keys, "file": other.file, **rate}
        channels[name] = replace(channels[name], keys=keys)
    return replace(test, run=replace(test.run, channels=channels))


def _rate_beside(test: Guessed, other: Guessed) -> dict[str, float]:
    """The sampling rate (Hz) of another file, unless its time is found as that of the test's file is."""
    time, beside = test.run.time, other.run.time
    if time is None or (beside and (time.column.name, time.unit) == (beside.column.name, beside.unit)):
        return {}
    stamps = _stamps(other)
    if beside is None and other.rate is None:  # as long as the test
        return {"rate_hz": float(f"{stamps.size / np.nanmax(np.abs(_stamps(test) - _stamps(test)[0])):.6g}")}
    return {"rate_hz": float(f"{1.0 / np.median(np.diff(stamps[np.isfinite(stamps)])):.6g}")}


def _with_kind(test: Guessed) -> list[Guessed]:
    """A test with its kind and what channels are to it, once for each part between long pauses."""
    channels = dict(test.run.channels)
    if INPUT in channels:
        channels.pop(FORCE, None)
    elif FORCE in channels and "displacement" not in channels:
        given = channels.pop(FORCE)
        channels[INPUT] = replace(given, keys={**given.keys, "quantity": FORCE})
    test = replace(test, run=replace(test.run, channels=channels))
    parts = [(part, *_evenly(test, part)) for part in parts_of(_stamps(test))]
    _, time, signals = parts[0]
    kind, reason = kind_of(signals, time)
    if kind == LOOP:
        channels = {name: each for name, each in channels.items() if name in ("displacement", FORCE)}
    elif kind == TRANSIENT:
        channels.pop(FORCE, None)
    channels = _compared(channels)
    test = replace(test, run=replace(test.run, channels=channels), kind=kind, reason=reason)
    if kind == TRANSIENT and INPUT not in channels:
        parts = [each for part in parts for each in _releases(test, *part)]
    return [replace(test, part=_begun(*each, kind)) for each in parts]


def imposed(test: Guessed) -> Guessed:
    """A steady test of a velocity under a force as a loop: of that force under that velocity."""
    channels = test.run.channels
    if (
        test.kind != STEADY
        or set(channels) != {"velocity", INPUT}
        or channels[INPUT].keys["quantity"] != FORCE
    ):
        return test
    keys = {key: value for key, value in channels[INPUT].keys.items() if key != "quantity"}
    as_loop = {"velocity": channels["velocity"], FORCE: replace(channels[INPUT], keys=keys)}
    negated = FORCE if test.negated else ""
    reason = "a force under a velocity, and no inertia shows"
    return replace(test, run=replace(test.run, channels=as_loop), kind=LOOP, reason=reason, negated=negated)


def _releases(
    test: Guessed, part: Part, time: np.ndarray, signals: dict[str, np.ndarray]
) -> list[tuple[Part, np.ndarray, dict[str, np.ndarray]]]:
    """Parts of a free motion, each of which begins anew, with their times and signals.

    What a hand moves before it lets go is none, if others swing.
    """
    signal = next(iter(signals.values()))
    again = released_again(signal)
    if not again:  # what comes before the release may hide it
        first = int(np.searchsorted(time, from_release(signal, time) or time[0]))
        again = [first + each for each in released_again(signal[first:])]
    if not again:
        return [(part, time, signals)]
    starts = [down(float(time[each]), float(time[1] - time[0])) for each in again]
    parts = [Part(*ends) for ends in pairwise([part.start, *starts, part.end])]
    found = [(each, *_evenly(test, each)) for each in parts]
    motions = [next(iter(own.values())) for _, _, own in found]
    least = LARGE * max(float(np.ptp(each)) for each in motions)
    free = [swings_back(each) and float(np.ptp(each)) > least for each in motions]
    return list(compress(found, free)) or found


def _begun(part: Part, time: np.ndarray, signals: Mapping[str, np.ndarray], kind: str) -> Part:
    """A part of a test, from where it is free or steady on."""
    response = next(each for name, each in signals.items() if name != INPUT or len(signals) == 1)
    own = WHOLE
    if kind == STEADY:
        own = steady_part(response, time)
    elif kind == TRANSIENT and INPUT not in signals:
        own = Part(from_release(response, time))
    return Part(part.start if own.start is None else own.start, part.end if own.end is None else own.end)


def _compared(channels: Mapping[str, Chosen]) -> dict[str, Chosen]:
    """Channels of which two responses at most are compared."""
    responses = [name for name in MOTIONS if name in channels and not channels[name].keys.get("derived")]
    if len(responses) < 3:
        return dict(channels)
    return {name: each for name, each in channels.items() if name != "acceleration"}


def _stamps(test: Guessed) -> np.ndarray:
    """Time stamps (n,) in s of a test, from its first one on if they are dates."""
    if test.run.time is not None:
        values, unit = continued(test.run.time.values)[0], test.run.time.unit
        start = float(values[np.isfinite(values)][0])
        return (values - start * is_dated(unit, start)) * UNITS["time"][unit]
    first = next(iter(test.run.channels.values()))
    if first.column.channel.clock is not None:
        return first.column.channel.clock
    return np.arange(first.values.size) / (test.rate or UNKNOWN_RATE)


def _evenly(test: Guessed, part: Part) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Even times (n,) in s of a part and signals (n,), as far as a look needs them; of other files 0."""
    stamps = _stamps(test)
    channels = test.run.channels
    own = {name: each.values for name, each in channels.items() if "file" not in each.keys}
    good = (np.abs(stamps) < HUGE) & part.holds(stamps)
    order = np.argsort(stamps[good], kind="stable")
    time = np.linspace(stamps[good].min(), stamps[good].max(), int(good.sum()))
    signals = {}
    for name, values in own.items():
        if values.size != stamps.size:
            continue
        column = channels[name].column
        x = stamps if not column.rate else column.start + np.arange(stamps.size) / column.rate
        x, y = x[good][order], values[good][order]
        known = (np.abs(y) < HUGE) & ~spikes(y)
        signals[name] = np.interp(time, x[known], y[known])
    return time, {**dict.fromkeys(channels, np.zeros(time.size)), **signals}
