"""Builds the record of a test in SI units from the numbers in a file; faults name their place."""

from collections.abc import Iterator, Mapping
from math import isfinite, nan
from typing import Any

import numpy as np

from wedgesweep.effects import thermal_drift
from wedgesweep.measured.cycles import slope_of_means
from wedgesweep.measured.declarations import (
    AMPLITUDE,
    FORCE_AMPLITUDE,
    INPUT,
    KNOWN_FORCE,
    LOOP,
    NORMAL_FORCE,
    STEADY,
    TRANSIENT,
)
from wedgesweep.measured.even import ClockError, evened
from wedgesweep.measured.frequency import FEWEST_CYCLES, estimate_frequency
from wedgesweep.measured.kinds import goes_one_way, loop_faults, periods, transient_faults
from wedgesweep.measured.measurement import TestRecord
from wedgesweep.measured.plausibility import channel_faults
from wedgesweep.measured.quality import trend_faults
from wedgesweep.measured.signals import Signal, Signals, selected, without_spikes
from wedgesweep.measured.stationarity import stationarity_faults
from wedgesweep.measured.steadiness import MOST_SAMPLES, frequency_faults
from wedgesweep.periodogram import without_trend

# Bounds of a channel in SI units, and the variation that is rounding, over its size.
LARGEST, SMALLEST, ROUNDING = 1e12, 1e-15, 1e-13
# Channels that may be constant.
CONSTANT = ("time", KNOWN_FORCE, NORMAL_FORCE)
# Samples per period that must remain, so that all harmonics that are compared pass the filter unchanged.
FEWEST_PER_PERIOD = 200
# A free motion of more samples keeps so many per period: eight harmonics of it are compared, and jumps of
# friction still show.
MOST_OF_FREE, PER_PERIOD = 20_000, 100
# Half length of the filter in samples that remain, edge of its pass band over the new Nyquist frequency, and
# beta of its Kaiser window: stop band and ripple of -118 dB (Oppenheim and Schafer, Discrete-Time Signal
# Processing, sec. 7.5).
HALF_LENGTH, EDGE, BETA = 20, 0.8, 12.0


def build_record(
    name: str,
    given: Mapping[str, Any],
    signals: Signals,
    remarks: list[str],
    file: str,
    at: str,
    problems: list[str],
) -> TestRecord | None:
    """Build the record of a test from its checked keys ``given``, found at ``at``; None after a fault."""
    before = len(problems)
    recorded = max(map(_span, signals.values()))
    signals = selected(signals, given, file, at, problems)
    used = max(map(_span, signals.values()))
    problems.extend(f"{file}: {fault}" for fault in dict.fromkeys(_size_faults(signals)))
    if len(problems) > before:
        return None
    if given["kind"] != STEADY:  # there a spike is warned of: it hardly moves harmonics
        signals = {name: without_spikes(name, each, remarks) for name, each in signals.items()}
    try:
        even = evened(signals)
    except ClockError as error:
        problems.append(str(error))
        return None
    time, columns = even.time, dict(even.columns)
    frequency = _frequency(given, columns, time)
    if given.get("detrend", False):
        columns = {each: _straightened(time, samples, frequency) for each, samples in columns.items()}
    columns, time, thinned = _limited(given, columns, time, frequency)
    if given["kind"] == LOOP and "displacement" not in columns:
        columns["displacement"] = _integrated(time, columns["velocity"])
    if (known := columns.pop(KNOWN_FORCE, None)) is not None:
        # Only the sum with the force that is measured, or drives the mass, acts.
        beside = "force" if given["kind"] == LOOP else INPUT
        columns[beside] = columns[beside] + known
    amplitudes = [given[each.key] * each.factor for each in (AMPLITUDE, FORCE_AMPLITUDE) if each.key in given]
    test = TestRecord(
        name=name,
        file=given.get("file", file),
        frequency=given.get("frequency_hz"),
        amplitude=amplitudes[0] if amplitudes else None,
        amplitude_std=given.get("amplitude_std", 0.0),
        time=time,
        displacement=columns.get("displacement"),
        velocity=columns.get("velocity"),
        acceleration=columns.get("acceleration"),
        input=columns.get(INPUT),
        model=thermal_drift.of_test(given) | given.get("model", {}),
        kind=given["kind"],
        force=columns.get("force"),
        cutoff=given.get("lowpass_hz"),
        recorded_s=recorded if used < recorded else None,
        repeat_of=given.get("repeat_of"),
        normal_force=columns.get(NORMAL_FORCE),
        remarks=tuple(filter(None, (*remarks, *even.remarks, thinned))),
    )
    problems.extend(FAULTS[test.kind](test, file, at))
    return None if len(problems) > before else test


def _span(signal: Signal) -> float:
    """Length (s) of a signal."""
    times = signal.time[np.isfinite(signal.time)]
    # Of Python's numbers: a difference that is too large is infinite, without a warning.
    return float(times.max()) - float(times.min()) if times.size else 0.0


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


def _size_faults(signals: Signals) -> Iterator[str]:
    """Signals of sizes that no vibration has, whose squares might not even be numbers."""
    sizes = [("time", each.time) for each in signals.values()]
    sizes += [(name, each.samples) for name, each in signals.items()]
    for name, values in sizes:
        samples = values[np.isfinite(values)]
        largest = float(np.abs(samples).max(initial=0.0))
        if not samples.size:
            yield f"{name}: no samples in the part that is used; correct the columns, or from_s and to_s"
        elif largest > LARGEST:
            yield f"{name}: {largest:.3g} in SI units is too large; correct the unit or the file"
        elif name not in CONSTANT and np.ptp(samples) <= max(SMALLEST, ROUNDING * largest):
            yield f"{name} is constant; there is no vibration in it"


def _frequency(given: Mapping[str, Any], columns: Mapping[str, np.ndarray], time: np.ndarray) -> float:
    """Frequency (Hz) of a steady record where its drift or its length matters, else NaN."""
    if given["kind"] != STEADY or not (given.get("detrend") or time.size > MOST_SAMPLES):
        return nan
    leading = columns[INPUT] if INPUT in columns else next(iter(columns.values()))
    stated: float | None = given.get("frequency_hz")
    return stated or estimate_frequency(time[:MOST_SAMPLES], without_trend(leading[:MOST_SAMPLES]))


def _straightened(time: np.ndarray, samples: np.ndarray, frequency: float) -> np.ndarray:
    """Samples less their drift about the middle of the record; ``frequency`` in Hz, NaN: unknown."""
    if not FEWEST_CYCLES <= frequency * (time[-1] - time[0]) <= 0.25 * time.size:
        return without_trend(samples)
    return samples - slope_of_means(time, samples, frequency) * (time - time.mean())


def _integrated(time: np.ndarray, velocity: np.ndarray) -> np.ndarray:
    """Displacement (n,) by a velocity (n,), which has a zero of its own where the motion comes back."""
    from scipy.integrate import cumulative_trapezoid

    place = cumulative_trapezoid(velocity, time, initial=0.0)
    return place if goes_one_way(place) else _straightened(time, place, estimate_frequency(time, velocity))


def _limited(
    given: Mapping[str, Any], columns: dict[str, np.ndarray], time: np.ndarray, frequency: float
) -> tuple[dict[str, np.ndarray], np.ndarray, str]:
    """A record of as many samples as its kind needs, the times, and a remark if samples were left out."""
    kind = given["kind"]
    if kind == STEADY and time.size > MOST_SAMPLES:
        return shortened(columns, time, frequency, MOST_SAMPLES)
    if kind == TRANSIENT and INPUT not in columns and time.size > MOST_OF_FREE:
        factor = int(time.size / (PER_PERIOD * max(map(periods, columns.values()))))
        return _thinned(columns, time, factor) if factor > 1 else (columns, time, "")
    return columns, time, ""


def shortened(
    columns: Mapping[str, np.ndarray], time: np.ndarray, frequency: float, most: int
) -> tuple[dict[str, np.ndarray], np.ndarray, str]:
    """Shorten records that vibrate at a frequency, in cycles per unit of time.

    Parameters
    ----------
    columns : mapping of arrays, shape (n,)
        Channels over an even ``time``, shape (n,).
    frequency : float
        Frequency of the vibration; NaN if it is not known.
    most : int
        Number of samples that may remain.

    Returns
    -------
    dict, array, str
        Shorter channels, their times, and what was done in words.
    """
    factor = -(-time.size // most)
    rate = (time.size - 1) / (time[-1] - time[0])
    if not isfinite(frequency) or rate / factor < FEWEST_PER_PERIOD * frequency:
        remark = f"cut to the first {most} of {time.size} samples"
        return {name: samples[:most] for name, samples in columns.items()}, time[:most], remark
    return _thinned(columns, time, factor)


def _thinned(
    columns: Mapping[str, np.ndarray], time: np.ndarray, factor: int
) -> tuple[dict[str, np.ndarray], np.ndarray, str]:
    """Channels and their times after a low-pass, one sample in a factor, and a remark."""
    kept = slice(HALF_LENGTH, -HALF_LENGTH)
    thinned = {name: _decimated(samples, factor)[kept] for name, samples in columns.items()}
    remark = f"low-passed and decimated from {time.size} samples to one in {factor}"
    return thinned, time[::factor][kept], remark


def _decimated(samples: np.ndarray, factor: int) -> np.ndarray:
    from scipy.signal import firwin, resample_poly

    taps = firwin(2 * HALF_LENGTH * factor + 1, EDGE / factor, window=("kaiser", BETA))
    mean = samples.mean()
    return resample_poly(samples - mean, 1, factor, window=taps) + mean
