"""Warnings about usable records: trend, drift, outliers, flat tops."""

import numpy as np
from scipy.special import stdtrit

from wedgesweep.measured.cycles import Cycles, NoiseEstimate, cut, estimate_noise
from wedgesweep.measured.declarations import LOOP, MOTIONS, STEADY
from wedgesweep.measured.frequency import FEWEST_CYCLES, IMPROBABLE, estimate_frequency, stands_out
from wedgesweep.measured.kinds import goes_one_way, periods
from wedgesweep.measured.measurement import TestRecord
from wedgesweep.measured.signals import marked_runs
from wedgesweep.measured.stationarity import MEND, remedy

# Changes over the record that are worth a warning: of the amplitude, relative; of the mean, over the rms. A
# response whose amplitude changes by more than MOST_TREND is not steady.
TREND, DRIFT, MOST_TREND = 0.02, 0.1, 0.3
# Distance of an outlier from the periodic part, over the robust standard deviation of the noise. What
# occurs as often as once in two periods is a part of the response.
FAR, RARE = 10.0, 0.5
# Noise over the rms of a response below which there is none, and nothing to measure an outlier by.
NO_NOISE = 1e-4
# Times that outliers are looked for, the worst ones first.
MOST_TRIES = 30
# Rms of an acceleration (m/s^2) that few rigs reach, 1000 g, but a wrong unit of time does.
FAST, ACCELERATION = 1e4, MOTIONS.index("acceleration")
# Most cycles a sample of a loop whose drift is looked at.
MOST_CYCLES = 0.2
# Share of samples exactly at the extreme of a record, in runs of at least RUN, from which it is clipped.
CLIPPED, RUN = 0.01, 3
# Share above which flat tops are no clipping, and share of other samples that repeat where there is no noise.
MOST_CLIPPED, COARSE = 0.4, 0.05
# Difference over their range by which samples of one value may differ once they were interpolated.
SAME = 1e-9


def warnings(test: TestRecord) -> list[str]:
    """What is odd in each response of a test, as "channel: what, and what to do"."""
    found = [
        f"{name}: {warning}"
        for name, samples in test.responses.items()
        if test.kind == STEADY
        for warning in _of_channel(test, samples)
    ]
    if test.kind == LOOP and test.force is not None and test.displacement is not None:
        faults = _flat_tops(test.force), _drift_of_force(test.time, test.displacement, test.force)
        found += [f"force: {fault}" for fault in faults if fault]
    found += _too_fast(test)
    if test.kind == LOOP and test.displacement is not None and goes_one_way(test.displacement):
        fault = (
            "displacement: it goes one way only, so that constant friction looks like the zero of the force"
        )
        found.append(f"{fault}, and a spring like friction that rises; record at least one cycle")
    if test.recorded_s is not None:
        found.append(f"{test.duration:.4g} s of {test.recorded_s:.4g} s are used (from_s, to_s)")
    return found


def _of_channel(test: TestRecord, samples: np.ndarray) -> list[str]:
    noise = estimate_noise(test.time, samples, test.refined_frequency)
    cycles = cut(test.time, samples, test.refined_frequency)
    checks = (
        _trend(cycles, test.duration),
        _drift(cycles, test.duration, float(samples.std())),
        _outliers(test, samples, noise),
        _flat_tops(samples),
    )
    return [each for each in checks if each]


def trend_faults(test: TestRecord, file: str) -> list[str]:
    """Responses that grow or decay all along; one fault at most."""
    for name, samples in test.channels.items():
        if not stands_out(test.time, samples, test.refined_frequency):
            continue  # it sticks
        change = _growth(cut(test.time, samples, test.refined_frequency), test.duration)
        if abs(change) > MOST_TREND:
            fault = f"the amplitude of {name} changes by {100.0 * change:+.2g} % over the record"
            return [f"{file}: not steady: {fault}; {remedy('a ring-down') if change < 0.0 else MEND}"]
    return []


def _growth(cycles: Cycles, duration: float) -> float:
    """Change of the fundamental over a record, relative to its mean; 0 where chance explains it."""
    fundamental = cycles.harmonics[:, 0]
    return _change(cycles.times, (fundamental / fundamental.mean()).real, duration)


def _trend(cycles: Cycles, duration: float) -> str | None:
    """Amplitude of the fundamental that changes from period to period."""
    change = _growth(cycles, duration)
    if abs(change) < TREND:
        return None
    return f"its amplitude changes by {100.0 * change:+.2g} % over the record; cut it (from_s, to_s)"


def _drift(cycles: Cycles, duration: float, rms: float) -> str | None:
    """Mean of the periods that drifts."""
    change = _change(cycles.times, cycles.means, duration) / rms
    if abs(change) < DRIFT:
        return None
    return (
        f"its mean drifts by {100.0 * change:+.2g} % of its rms over the record; detrend = true removes that"
    )


def _drift_of_force(time: np.ndarray, displacement: np.ndarray, force: np.ndarray) -> str | None:
    """Mean over the cycles of a loop (n,) that drifts."""
    frequency = estimate_frequency(time, displacement)
    if not FEWEST_CYCLES <= frequency * (time[-1] - time[0]) <= MOST_CYCLES * time.size:
        return None
    return _drift(cut(time, force, frequency), float(time[-1] - time[0]), float(force.std()))


def _too_fast(test: TestRecord) -> list[str]:
    """A motion so fast that the unit of its time, or of itself, is likely another one."""
    name, samples = next(iter(test.responses.items()))
    omega = 2.0 * np.pi * periods(samples) / test.duration
    acceleration = omega ** (ACCELERATION - MOTIONS.index(name)) * float(samples.std())
    if acceleration < FAST:
        return []
    fault = f"its acceleration is about {acceleration:.2g} in SI units, at {omega / (2.0 * np.pi):.3g} Hz"
    return [f"{name}: {fault}; is its unit right, and that of the time?"]


def _change(times: np.ndarray, values: np.ndarray, duration: float) -> float:
    """Change of a straight line through values (P,) over a duration, 0 where chance explains it."""
    about = times - times.mean()
    slope = about @ values / (about @ about)
    left = values - values.mean() - slope * about
    freedom = values.size - 2
    std = np.sqrt(left @ left / freedom / (about @ about))
    return float(slope * duration) if abs(slope) > -stdtrit(freedom, IMPROBABLE) * std else 0.0


def _outliers(test: TestRecord, samples: np.ndarray, noise: NoiseEstimate) -> str | None:
    """Single samples far from where the other periods have theirs."""
    far, std = _far_off(test, samples, noise)
    count = np.count_nonzero(far)
    if not 0 < count < RARE * test.duration * test.refined_frequency:
        return None
    worst = int(np.abs(far).argmax())
    times = "sample is" if count == 1 else "samples are"
    at = f"{test.time[worst]:.6g} s by {abs(far[worst]) / std:.0f} standard deviations of the noise"
    fault = f"{count} {times} far from the other periods, the worst at {at}"
    return f"{fault}; correct them, or cut them off (from_s, to_s)"


def _far_off(test: TestRecord, samples: np.ndarray, noise: NoiseEstimate) -> tuple[np.ndarray, float]:
    """By how much samples, shape (n,), are off if that is far, else 0; and the noise of the others.

    An outlier has its share in the periodic part, and makes samples of all other periods seem far off. So the
    worst ones are moved to where they belong, and the periodic part is estimated again.
    """
    mended = samples
    for _ in range(MOST_TRIES):
        left = noise.residual - np.median(noise.residual)
        std = max(1.4826 * float(np.median(np.abs(left))), NO_NOISE * float(mended.std()))
        worst = np.abs(left) > max(FAR * std, 0.5 * np.abs(left).max())
        if not std or not worst.any():
            break
        mended = np.where(worst, mended - left, mended)
        noise = estimate_noise(test.time, mended, test.refined_frequency)
    off = samples - mended
    return np.where(np.abs(off) > FAR * std, off, 0.0), std


def _flat_tops(samples: np.ndarray) -> str | None:
    """Runs of samples exactly at the largest or smallest value, but for a few that were interpolated."""
    share = max(float(each.mean()) for each in _at_extremes(samples))
    if share < CLIPPED:
        return None
    fault = f"{100.0 * share:.2g} % of its samples are exactly at its extreme"
    return f"{fault}: the sensor or its amplifier clips, unless the motion sticks there"


def clipped(samples: np.ndarray) -> np.ndarray:
    """Which of samples (n,) a sensor or its amplifier clipped; none where others repeat as well.

    There numbers are coarse, or free of noise: friction alone is as flat.
    """
    none = np.zeros(samples.size, bool)
    found = np.logical_or.reduce([none, *(each for each in _at_extremes(samples) if each.mean() >= CLIPPED)])
    others = (np.diff(samples) == 0.0) & ~found[1:]
    return none if found.mean() > MOST_CLIPPED or others.mean() > COARSE else found


def _at_extremes(samples: np.ndarray) -> list[np.ndarray]:
    """Which of samples (n,) are at the smallest and which at the largest value, in runs of at least RUN."""
    ends, same = np.quantile(samples, [0.5 * CLIPPED, 1.0 - 0.5 * CLIPPED]), SAME * np.ptp(samples)
    return [_in_runs(np.abs(samples - end) <= same) for end in ends]


def _in_runs(marked: np.ndarray) -> np.ndarray:
    """Those of the marked samples (n,) that stand in runs of at least RUN."""
    found = np.zeros(marked.size, bool)
    for start, end in marked_runs(marked).tolist():
        found[start:end] = end - start >= RUN
    return found
