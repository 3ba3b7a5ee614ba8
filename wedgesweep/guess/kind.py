"""Which kind of test a record is, and which part of it: by what its signals do."""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from wedgesweep.measured.cycles import cut, estimate_noise
from wedgesweep.measured.declarations import LOOP, STEADY, TRANSIENT
from wedgesweep.measured.frequency import FEWEST_CYCLES, estimate_frequency
from wedgesweep.measured.stationarity import MOST_LEVEL_RATIO, MOST_MOVED, stationarity

# What does not repeat, over what does, in a steady record; samples that tell it.
NOISE, MOST = 0.5, 20_000
# A pause of PAUSE steps of the clock parts runs that have FEWEST samples and this SHARE of the longest one.
PAUSE, FEWEST, SHARE = 20.0, 200, 0.1
# Part of a free motion in which it must be at its largest. Shares of the largest swing above which the swing
# before that counts as a push, and below which the mass was let go. Part at the end that shows its rest.
BEGINNING, PUSH, LET_GO, TAIL = 0.6, 0.9, 0.7, 0.1
# Distance of a period from the median one, over the median of these distances, beyond which it belongs to the
# run-up or the run-down: a trend doubles it, and noise of one number in thousands of periods makes it 5.
RUN_UP = 5.0
# Least swing of a free motion to the other side over its largest one.
SWINGS_BACK = 0.1


@dataclass(frozen=True)
class Part:
    """Times (s) between which a record is used; None: its beginning, its end."""

    start: float | None = None
    end: float | None = None

    def holds(self, time: np.ndarray) -> np.ndarray:
        """Which of the times (n,) in s are in this part."""
        return ((self.start is None) | (time >= (self.start or 0.0))) & (
            (self.end is None) | (time <= (self.end or 0.0))
        )


WHOLE = Part()


def kind_of(signals: Mapping[str, np.ndarray], time: np.ndarray) -> tuple[str, str]:
    """Kind of a test and the reason, by its signals (n,) and even times (n,) in s.

    A force beside a displacement is compared along that motion, whatever imposes it: the force of a damper
    rig, or all forces on a mass. Without a displacement a force is what drives the mass.
    """
    if "displacement" in signals and "force" in signals and "input" not in signals:
        return LOOP, "a force under a recorded displacement"
    leading = signals.get("input", next(iter(signals.values())))
    response = next((each for name, each in signals.items() if name != "input"), leading)
    used = steady_part(response, time).holds(time) if "input" in signals else np.ones(time.size, bool)
    if 2 * used.sum() > time.size and all(is_steady(each[used], time[used]) for each in (leading, response)):
        return STEADY, "it repeats from period to period"
    driven = "under a recorded input" if "input" in signals else "free: it decays"
    return TRANSIENT, f"a motion from some start, {driven}"


def is_steady(signal: np.ndarray, time: np.ndarray) -> bool:
    """Whether a signal (n,) over even times (n,) in s repeats all along, from period to period."""
    signal, time = signal[:MOST], time[:MOST]
    if signal.size < FEWEST or not signal.std():
        return False
    rate = (time.size - 1) / float(time[-1] - time[0])
    changes = stationarity(signal, rate)
    if not (changes.moved <= MOST_MOVED and changes.level_ratio <= MOST_LEVEL_RATIO):
        return False
    frequency = estimate_frequency(time, signal)
    cycles = frequency * float(time[-1] - time[0])
    if not FEWEST_CYCLES <= cycles <= 0.2 * time.size:
        return False
    return bool(estimate_noise(time, signal, frequency).share < NOISE)


def parts_of(time: np.ndarray) -> list[Part]:
    """Parts of a record between long pauses of its stamps (n,) in s."""
    stamps = time[np.isfinite(time)]
    steps = np.diff(stamps)
    if not steps.size or (steps < 0.0).any():
        return [WHOLE]
    step = float(np.median(steps))
    ends = [0, *(np.flatnonzero(steps > PAUSE * step) + 1).tolist(), stamps.size]
    fewest = max(FEWEST, SHARE * max(b - a for a, b in pairwise(ends)))
    runs = [(a, b) for a, b in pairwise(ends) if b - a >= fewest]
    if len(runs) < 2:
        return [WHOLE]
    return [
        Part(down(stamps[a], step) if a else None, None if b == stamps.size else down(stamps[b - 1], -step))
        for a, b in runs
    ]


def down(time: float, step: float) -> float:
    """A time less half a step, in few decimals."""
    return float(np.round(time - 0.5 * step, max(0, 1 - int(np.floor(np.log10(abs(step)))))))


def from_release(signal: np.ndarray, time: np.ndarray) -> float | None:
    """When a free motion (n,) begins, if it was held or pushed before: let go, or at its largest swing."""
    place = signal - np.median(signal[-max(int(TAIL * signal.size), 1) :])
    swing = np.abs(place)
    largest, high = int(swing.argmax()), swing >= PUSH * swing.max()
    first = int(high.argmax())
    low = first + int((swing[first:] < LET_GO * swing.max()).argmax())
    last = first + int(np.flatnonzero(high[first : low + 1])[-1])  # noise does not let it go before
    to_rest = int((place[last:] * place[first] <= 0.0).argmax())
    if last - first > to_rest > 0:  # a swing is as long at its top as from there to the rest position
        return down(float(time[last]), float(time[1] - time[0]))
    pushed = largest > 2 and not high[0] and largest < BEGINNING * signal.size
    return down(float(time[largest]), float(time[1] - time[0])) if pushed else None


def swings_back(signal: np.ndarray) -> bool:
    """Whether a free motion (n,) swings to the other side of where it rests: a pull by hand does not."""
    place = signal - np.median(signal[-max(int(TAIL * signal.size), 1) :])
    place = place[np.abs(place).argmax() :]
    return bool((-np.sign(place[0]) * place).max() > SWINGS_BACK * abs(place[0]))


def steady_part(signal: np.ndarray, time: np.ndarray) -> Part:
    """Part in which a driven motion (n,) is as in most of its record, without run-up and run-down.

    The frequency is that of the middle half: periods that grow have other lines as well.
    """
    quarter = signal.size // 4
    middle = slice(quarter, 3 * quarter)
    frequency = estimate_frequency(time[middle], signal[middle])
    if not frequency * (time[quarter] - time[0]) >= FEWEST_CYCLES:
        return WHOLE
    cycles = cut(time, signal, frequency)
    parts = np.column_stack([cycles.harmonics.real, cycles.harmonics.imag])
    away = np.linalg.norm(parts - np.median(parts, axis=0), axis=1)
    like = np.flatnonzero(away <= RUN_UP * np.median(away))
    half, step = 0.5 * (cycles.times[1] - cycles.times[0]), float(time[1] - time[0])
    first, last = (float(cycles.middle + cycles.times[each]) for each in like[[0, -1]])
    return Part(
        down(first - half, step) if like[0] else None,
        down(last + half, step) if like[-1] < away.size - 1 else None,
    )
