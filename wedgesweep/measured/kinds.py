"""Checks of tests by their kind: which channels and keys they have, and what their records must show."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from wedgesweep.hints import show
from wedgesweep.measured.declarations import LOOP, MOTIONS, STEADY, TRANSIENT, columns_of
from wedgesweep.measured.measurement import TestRecord

# A motion that comes back by less than this share of its range goes one way.
RETURNS = 0.1
# Least swing in the first part of a free motion over that in the last one, and that part (share).
DECAYS, PART = 1.2, 0.25
# The same where the swing falls from each of PARTS parts to the next: noise and steady motions never do so.
DECAYS_SLOWLY, PARTS = 1.02, 8
# Swing of a period over that of two periods before, and over the largest one, from which a free motion was
# let go or struck again.
GROWS, LARGE = 2.0, 0.3
# Parts of a period over which samples are averaged before the swing is taken: noise swings as well.
PARTS_OF_PERIOD = 8
# What has fewer periods in a record is drift. Half the width of a band over its frequency.
SLOWEST, HALF_BAND = 3, 0.1
# Highest cut-off over the sampling rate: the motion of a loop is filtered at twice that.
HIGHEST = 0.2
# Fewest samples over which a filter settles.
FEWEST = 64
# Keys of a test under a sine, and of a loop.
OF_A_SINE, OF_A_LOOP = ("frequency_hz", "amplitude_mm", "amplitude_N"), ("lowpass_hz",)
OF_A_TRANSIENT, NOT_OF_A_SINE = ("undriven",), ("repeat_of",)
# Sizes in SI, and names, of the units in which they are shown.
DISPLAY_UNITS = {"displacement": (1e-3, "mm"), "velocity": (1e-3, "mm/s"), "acceleration": (1.0, "m/s^2")}
MEANING = {
    "transient": "a transient is a motion from some start, free or under a recorded input",
    "loop": "a loop is the force under a recorded displacement, or else under a velocity",
}


def column_faults(columns: Mapping[str, Any], kind: str) -> list[str]:
    """Faults of the channels of tests that are not steady, as "key: fault"."""
    missing = [f"force: missing; {MEANING[kind]}"] if kind == LOOP and "force" not in columns else []
    if kind == TRANSIENT and not any(name in columns for name in MOTIONS):
        missing = [f"displacement: missing, and so are velocity and acceleration; {MEANING[kind]}"]
    if kind == TRANSIENT and "displacement" not in columns and columns.get("velocity", {}).get("derived"):
        missing.append("velocity.derived: there is no displacement that it was computed from; give that one")
    if kind == LOOP and not {"displacement", "velocity"} & {*columns}:
        missing.insert(0, f"displacement: missing; {MEANING[kind]}")
    used = columns_of(columns, kind, alone=False)
    extra = [f"{name}: not used; {MEANING[kind]}, omit it" for name in columns if name not in used]
    return missing + extra


def key_faults(given: Mapping[str, Any]) -> list[str]:
    """Faults of the keys of a test that do not go with its kind, as "key: fault"."""
    kind = given["kind"]
    wrong = [] if kind == STEADY else [key for key in OF_A_SINE if key in given]
    wrong += [] if kind == LOOP else [key for key in OF_A_LOOP if key in given]
    wrong += [] if kind == TRANSIENT else [key for key in OF_A_TRANSIENT if given.get(key)]
    wrong += [key for key in NOT_OF_A_SINE if key in given] if kind == STEADY else []
    return [f'{key}: not for kind = "{kind}"; omit it' for key in wrong]


def repeat_faults(given: Mapping[str, Any], before: Sequence[Mapping[str, Any]]) -> list[str]:
    """Faults of ``repeat_of``, which names an earlier test that this one repeats, as "key: fault".

    ``given``: keys of a test; ``before``: those of the tests before it, and their names: file, file#2.
    """
    first = given.get("repeat_of")
    if first is None:
        return []
    for other in before:
        if other.get("name") == first and "repeat_of" not in other:
            same = other["kind"] == given["kind"]
            return [] if same else [f"repeat_of: {show(first)} is of another kind; a repeat is of the same"]
    fault = "is not the file of an earlier test that repeats none; name that one"
    return [f"repeat_of: {show(first)} {fault}"]


def loop_faults(test: TestRecord, file: str, at: str) -> list[str]:
    """Faults of a loop, in its data or by its keys at ``at``."""
    if test.displacement is None:  # a fault of the columns
        return []
    if test.time.size < FEWEST:
        return [f"{file}: has {test.time.size} samples; at least {FEWEST} make a loop"]
    if test.cutoff is not None and not test.cutoff <= HIGHEST * test.sampling_rate:
        fault = f"{test.cutoff:g} Hz is more than {HIGHEST:g} times the sampling rate"
        return [f"{at}.lowpass_hz: {fault} of {test.sampling_rate:g} Hz; lower it, or omit it"]
    return []


def goes_one_way(displacement: np.ndarray) -> bool:
    """Whether a motion (n,) hardly comes back."""
    steps = np.diff(displacement)
    there, back = steps[steps > 0.0].sum(), -steps[steps < 0.0].sum()
    return bool(min(there, back) < RETURNS * float(np.ptp(displacement)))


def transient_faults(test: TestRecord, file: str, at: str) -> list[str]:
    """Faults of a transient; without an input the motion must decay."""
    name, signal = next(iter(test.responses.items()), ("", None))
    if signal is None:  # a fault of the columns
        return []
    if test.time.size < FEWEST:
        return [f"{file}: has {test.time.size} samples; at least {FEWEST} make a transient"]
    if test.input is not None:
        return []
    if again := released_again(signal):
        when = ", ".join(f"{test.time[each]:.4g} s" for each in again)
        mend = "end the test before (to_s), and make another one of what follows (from_s)"
        return [f"{file}: the motion grows again at {when}, as if it was struck or let go once more; {mend}"]
    size = int(PART * signal.size)
    first, last = float(np.ptp(signal[:size])), float(np.ptp(signal[-size:]))
    if first < DECAYS * last and not _decays_slowly(signal):
        scale, unit = DISPLAY_UNITS[name]
        swings = f"it swings by {first / scale:.3g} {unit}, at last {last / scale:.3g} {unit}"
        fault = f"the motion does not decay ({swings})"
        better = f'add the column input if there is one; if it is steady write kind = "steady" ({at}.kind)'
        return [f"{file}: {fault}; {better}"]
    return []


def released_again(signal: np.ndarray) -> list[int]:
    """Samples at which a free motion (n,), after it has decayed, is struck, or pulled to be let go, again."""
    every = max(signal.size // periods(signal) // PARTS_OF_PERIOD, 1)
    rows = signal.size // (PARTS_OF_PERIOD * every)
    means = signal[: rows * PARTS_OF_PERIOD * every].reshape(rows, PARTS_OF_PERIOD, every).mean(axis=2)
    swing = np.ptp(means, axis=1)
    before, after = swing[:-2], swing[2:]
    grown = (after > GROWS * before) & (after > LARGE * swing.max())
    grown &= np.maximum.accumulate(before) > GROWS * before
    found, begun = [], 0
    for each in (np.flatnonzero(grown & ~np.r_[False, grown[:-1]]) + 1).tolist():
        # Before it is let go a mass is pulled one way, and perhaps held.
        if not goes_one_way(means[begun:each].ravel()):
            begun += _begins_anew(swing[begun : each + 1])
            found.append(PARTS_OF_PERIOD * every * begun)
    return found


def _begins_anew(swing: np.ndarray) -> int:
    """The first of the periods (n,) that is not quiet any more after a motion that has decayed."""
    largest = int(swing.argmax())
    quiet = largest + int((swing[largest:] <= GROWS * swing[largest:].min()).argmax())
    loud = swing[quiet:] > GROWS**2 * swing[largest:].min()
    return quiet + int(loud.argmax()) if loud.any() else swing.size - 1


def periods(signal: np.ndarray) -> int:
    """Periods in samples (n,) of the frequency about which their power is largest.

    That of a motion which decays is spread about its frequency. A drift, or a mass that is held between
    releases, has more at a few low frequencies, but falls with their square, noise not at all.
    """
    power = np.abs(np.fft.rfft(signal - signal.mean())) ** 2
    number = np.arange(SLOWEST, power.size)
    low, high = (np.rint(each * number).astype(int) for each in (1.0 - HALF_BAND, 1.0 + HALF_BAND))
    total = np.r_[0.0, np.cumsum(power)]
    high = np.minimum(high + 1, power.size)
    mean = (total[high] - total[low]) / (high - low)
    band = int((mean * number**1.5).argmax())
    return int(low[band] + power[low[band] : high[band]].argmax())


def _decays_slowly(signal: np.ndarray) -> bool:
    """Whether a free motion (n,) that is hardly damped swings less and less."""
    swing = np.array([np.ptp(part) for part in np.array_split(signal, PARTS)])
    return bool((np.diff(swing) < 0.0).all() and swing[0] > DECAYS_SLOWLY * swing[-1])
