"""Signals on clocks of their own, with jitter, gaps or doubled stamps, brought to one even grid."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import prod

import numpy as np

from wedgesweep.formatting import counted
from wedgesweep.measured.clock import EVEN, Clock, counted_clock, fit_clock, typical_step
from wedgesweep.measured.signals import Signal, reference

FEWEST = 8
# Error of interpolation in a gap, over the rms of a channel, up to which samples are made up; or the power
# which gaps as long add to a record, over that of its noise, by the error in gaps of one sample.
MOST_ERROR, ADDED = 0.02, 0.1
# Error of a cubic half way between samples, over that at a sample left out: 0.5^2 1.5^2 / (1^2 2^2).
HALF_WAY = 0.14
# Samples that remain beside a gap that is made in a record, at either side, and how often gaps are shifted.
BESIDE, SHIFTS = 5, 4
# Rounding of the stamps over their step from which a rate is fitted that they do not show one by one.
COARSE = 0.5
# Relative error of a rate (the rounding of n stamps over their span and the root of n) that is too large.
UNCERTAIN = 1e-3
# Roughness over the stamps, over that at even times, up to which the samples do not tell which is right. The
# stamps are followed there: a slow drift of the rate leaves 1.00001, stamps late by 3 % of a step 1.1.
ALIKE = 1.02
# Even samples per sample of the file: more are a fault of the stamps.
MOST = 4
# Place between two samples, from 0 at one of them to 1 half way, below which it is one of them.
NONE, TINY = 1e-3, 1e-300
# A signal sampled FASTER times as fast is low-passed (Butterworth) at EDGE of the slower Nyquist frequency.
FASTER, ORDER, EDGE = 2.0, 8, 0.8


class ClockError(ValueError):
    """Time stamps that give no clock."""

    def __init__(self, place: str, fault: str) -> None:
        super().__init__(f"{place}: {fault}")


@dataclass(frozen=True, eq=False)
class Even:
    """Channels (n,) over an even time (n,) in s, and what was done to them in words."""

    time: np.ndarray
    columns: Mapping[str, np.ndarray]
    remarks: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class _Placed:
    """A signal without missing samples at the times (n,) in s that are trusted, and its clock."""

    signal: Signal
    clock: Clock
    time: np.ndarray

    def error(self, lost: int) -> float:
        """Error (rms, in SI) of interpolation amid gaps of ``lost`` samples that are made in the signal.

        None is made near a gap that the record has, where there is room elsewhere.
        """
        period, size = lost + 2 * BESIDE, self.time.size
        before = np.concatenate([[0], np.cumsum(self.clock.gaps)])
        errors: list[np.ndarray] = []
        for shift in range(0, period, -(-period // SHIFTS)):
            starts = np.arange(shift, size - period + 1, period)
            whole = before[starts + period - 1] == before[starts]
            starts = BESIDE + (starts[whole] if whole.any() else starts)
            kept = np.delete(np.arange(size), starts[:, None] + np.arange(lost))
            amid = starts + lost // 2
            errors.append(self._spline(kept)(self.time[amid]) - self.signal.samples[amid])
        found = np.concatenate(errors)
        return float(np.sqrt(np.mean(found**2))) if found.size else float("inf")

    def _spline(self, kept: np.ndarray | slice = slice(None)) -> Callable[[np.ndarray], np.ndarray]:
        from scipy.interpolate import CubicSpline

        return CubicSpline(self.time[kept], self.signal.samples[kept])

    def long_gaps(self) -> np.ndarray:
        """Indices of the samples before gaps that are too long to be filled."""
        gaps = self.clock.gaps
        if not gaps.any():
            return np.flatnonzero(gaps)
        bound, noise = MOST_ERROR * float(self.signal.samples.std()), self.time.size * self.error(1) ** 2
        errors = {lost: self.error(lost) for lost in np.unique(gaps[gaps > 0]).tolist()}
        added = {lost: gaps[gaps == lost].sum() * error**2 for lost, error in errors.items()}
        long = [lost for lost in errors if errors[lost] > bound and added[lost] > ADDED * noise]
        return np.flatnonzero(np.isin(gaps, long))

    def at(self, time: np.ndarray) -> tuple[np.ndarray, float]:
        """Samples at times (m,) in s, and the largest error of interpolation over the signal's rms."""
        after = np.clip(np.searchsorted(self.time, time), 1, self.time.size - 1)
        gap = self.time[after] - self.time[after - 1]
        part = np.clip((time - self.time[after - 1]) / gap, 0.0, 1.0)
        lost = np.maximum(np.rint(gap / self.clock.step) - 1.0, 0.0)
        moved = 4.0 * part * (1.0 - part)
        inside = moved > NONE
        errors = {0.0: HALF_WAY * self.error(1)} | {
            each: self.error(int(each)) for each in set(lost[inside]) - {0.0}
        }
        worst = max(
            (size * float(moved[lost == each].max(initial=0.0)) for each, size in errors.items()), default=0.0
        )
        return self._spline()(time), worst / max(float(self.signal.samples.std()), TINY)


def evened(signals: Mapping[str, Signal]) -> Even:
    """Bring signals to the even clock of the first response; raises ClockError."""
    remarks: list[str] = []
    cleaned = {name: _cleaned(name, signal, remarks) for name, signal in signals.items()}
    placed: dict[str, _Placed] = {}
    for name, signal in cleaned.items():
        alike = [each for each in cleaned if np.array_equal(cleaned[each].time, signal.time)]
        first = placed.get(alike[0]) or _placed([cleaned[each] for each in alike], remarks)
        placed[name] = _Placed(signal, first.clock, first.time)
    leading = placed[reference(signals)]
    time = _grid(placed, leading, remarks)
    columns, errors = {}, {}
    for name, own in placed.items():
        columns[name], error = _sampled(own, leading, time)
        if error is not None:
            other = "" if own.clock is leading.clock else f" (recorded at {1.0 / own.clock.step:.6g} Hz)"
            errors[name] = f"{100.0 * error:.2g} % of {name}{other}"
    if errors:
        rate = f"{1.0 / leading.clock.step:.6g} Hz"
        remarks.append(f"interpolated evenly at {rate}, with an error of about {', '.join(errors.values())}")
    return Even(time, columns, tuple(dict.fromkeys(remarks)))


def _cleaned(name: str, signal: Signal, remarks: list[str]) -> Signal:
    """A signal without missing samples, whose time goes on; raises ClockError."""
    signal = signal.of(np.flatnonzero(np.isfinite(signal.time) & np.isfinite(signal.samples)))
    if signal.time.size < FEWEST:
        ends = signal.where(signal.time.size - 1) if signal.time.size else name
        fault = f"ends after {signal.time.size} samples; at least {FEWEST} are needed"
        raise ClockError(ends, fault)
    steps = np.diff(signal.time)
    back = np.flatnonzero(steps < 0.0)
    if back.size:
        row = int(back[0])
        fault = f"{signal.time[row + 1]:.12g} s follows {signal.time[row]:.12g} s"
        mend = "put the samples in order, or choose a part (from_s, to_s)"
        raise ClockError(signal.where(row + 1), f"time goes back ({fault}); {mend}")
    if (steps > 0.0).all() or (typical_step(signal.time) and _clock(signal).exact):
        return signal
    stamps, place, count = np.unique(signal.time, return_inverse=True, return_counts=True)
    if stamps.size < FEWEST:
        fault = f"time stands still at {stamps[0]:.12g} s; write it with more decimals"
        raise ClockError(signal.where(0), fault)
    rows = np.searchsorted(signal.time, stamps)
    remarks.append(f"{counted(int((count > 1).sum()), 'doubled time stamp')}: their samples are averaged")
    means = np.bincount(place, signal.samples) / count
    return Signal(stamps, means, signal.resolution[rows], signal.of(rows).where)


def _placed(signals: Sequence[Signal], remarks: list[str]) -> _Placed:
    """The first of signals with the same stamps at the times that are trusted: stamps, or an even clock.

    Software may have read the clock late; then the samples are smoother over even times.
    """
    signal = signals[0]
    clock = _clock(signal)
    rounding, off = float(np.median(signal.resolution)) / clock.step, float(np.sqrt(np.mean(clock.off**2)))
    if clock.exact:
        if rounding >= COARSE and off > EVEN:
            rate = f"{1.0 / clock.step:.6g} Hz"
            remarks.append(f"time stamps are rounded to {rounding:.2g} of a step: a rate of {rate} is fitted")
        return _with_losses(_Placed(signal, clock, clock.places), remarks)
    scatter = f"time stamps scatter by {100.0 * off:.2g} % of a step (rms)"
    # Nothing tells how many samples there would be in a pause.
    regular = clock if clock.even or clock.gaps.any() else counted_clock(signal.time, signal.resolution)
    rough = [(roughness(signal.time, s.samples), roughness(regular.places, s.samples)) for s in signals]
    followed = prod(stamps / max(even, TINY) for stamps, even in rough) <= ALIKE
    if followed or (regular is clock and not clock.even):
        remarks.append(f"{scatter} of {1.0 / clock.step:.6g} Hz")
        return _with_losses(_Placed(signal, clock, signal.time), remarks)
    rate = f"{1.0 / regular.step:.6g} Hz"
    remarks.append(f"{scatter}, but the samples do not: they are taken to be even, at {rate}")
    return _with_losses(_Placed(signal, regular, regular.places), remarks)


def _clock(signal: Signal) -> Clock:
    """The clock of a signal; raises ClockError if its stamps are rounded too far to tell the rate."""
    clock = fit_clock(signal.time, signal.resolution)
    rounding = float(np.median(signal.resolution))
    uncertain = rounding / (np.ptp(signal.time) * np.sqrt(signal.time.size))
    if (clock.exact and uncertain > UNCERTAIN) or ((np.diff(clock.places) <= 0.0).any() and clock.even):
        fault = f"time stamps that are rounded to {rounding:.2g} s do not tell the sampling rate"
        raise ClockError(signal.where(0), f"{fault}; leave the column time out, and write rate_hz")
    return clock


def _with_losses(placed: _Placed, remarks: list[str]) -> _Placed:
    gaps = placed.clock.gaps
    if placed.clock.even and gaps.any():
        first = float(placed.time[np.flatnonzero(gaps)[0]])
        remarks.append(f"{counted(int(gaps.sum()), 'sample')} lost, the first after {first:.6g} s")
    return placed


def roughness(time: np.ndarray, samples: np.ndarray) -> float:
    """Error (rms) of a cubic over time (n,) through two neighbours at either side of each sample (n,)."""
    nodes = [time[:-4], time[1:-3], time[3:-1], time[4:]]
    values = [samples[:-4], samples[1:-3], samples[3:-1], samples[4:]]
    guessed = np.zeros(samples.size - 4)
    for i, node in enumerate(nodes):
        weight = np.ones(guessed.size)
        for j, other in enumerate(nodes):
            if i != j:
                weight *= (time[2:-2] - other) / np.where(node == other, np.inf, node - other)
        guessed += weight * values[i]
    return float(np.sqrt(np.mean((guessed - samples[2:-2]) ** 2)))


def _grid(placed: Mapping[str, _Placed], leading: _Placed, remarks: list[str]) -> np.ndarray:
    """Even times (s) of the longest part without a long gap in any signal; raises ClockError."""
    start, end = max(each.time[0] for each in placed.values()), min(each.time[-1] for each in placed.values())
    if not start < end:
        spans = ", ".join(f"{name} from {p.time[0]:.6g} to {p.time[-1]:.6g} s" for name, p in placed.items())
        fault = f"channels have no time in common: {spans}; correct their clocks or delay_ms"
        raise ClockError(leading.signal.where(0), fault)
    pauses = sorted({(p.time[i], p.time[i + 1]) for p in placed.values() for i in p.long_gaps().tolist()})
    inside = [(a, b) for a, b in pauses if a >= start and b <= end]
    parts = list(zip([start, *(b for _, b in inside)], [*(a for a, _ in inside), end], strict=True))
    first, last = max(parts, key=lambda part: part[1] - part[0])
    if inside:
        a, b = max(inside, key=lambda pause: pause[1] - pause[0])
        longest = f"{counted(len(inside), 'pause')}, the longest of {b - a:.3g} s after {a:.6g} s"
        used = f"the part from {first:.6g} to {last:.6g} s is used (from_s, to_s choose another)"
        remarks.append(f"{longest}: {used}")
    clock = leading.clock
    low, high = (
        int(f((t - clock.start) / clock.step + e))
        for f, t, e in ((np.ceil, first, -EVEN), (np.floor, last, EVEN))
    )
    if high - low + 1 > MOST * leading.time.size:
        steps = np.diff(leading.time)
        fault = f"time stamps from {steps.min():.3g} to {steps.max():.3g} s apart; there is no sampling rate"
        raise ClockError(leading.signal.where(0), fault)
    if high - low + 1 < FEWEST:
        fault = f"only {high - low + 1} samples without a pause in common; at least {FEWEST} are needed"
        raise ClockError(leading.signal.where(0), fault)
    return clock.start + clock.step * np.arange(low, high + 1)


def _sampled(own: _Placed, leading: _Placed, time: np.ndarray) -> tuple[np.ndarray, float | None]:
    """Samples of a signal at even times (n,), and the error of interpolation; None where there was none."""
    clock = own.clock
    places = np.rint((time - clock.start) / clock.step).astype(int)
    if own.time.size and clock is leading.clock and np.array_equal(own.time, clock.places):
        kept = np.isin(clock.index, places)
        if np.count_nonzero(kept) == time.size:
            return own.signal.samples[kept], None
    ratio = leading.clock.step / clock.step
    if ratio >= FASTER:
        own = _Placed(_low_passed(own.signal, ratio), clock, own.time)
    return own.at(time)


def _low_passed(signal: Signal, ratio: float) -> Signal:
    """A signal without what a clock that is slower by a factor would show at other frequencies."""
    from scipy.signal import butter, sosfiltfilt

    samples = sosfiltfilt(butter(ORDER, EDGE / ratio, output="sos"), signal.samples)
    return Signal(signal.time, samples, signal.resolution, signal.where)
