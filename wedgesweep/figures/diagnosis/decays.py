"""Measured and simulated motion in time, the size of its swings, and what the models leave of it."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from scipy.signal import find_peaks

from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.figures import style
from wedgesweep.figures.diagnosis import marks, selection
from wedgesweep.figures.diagnosis.multiples import multiples
from wedgesweep.figures.panels import Panels, Target

NAME = "decays"
DESCRIPTION = "motion in time and the size of its swings, measured and simulated, and what the models leave"
TESTS = "transient"

# Of a longer motion the beginning is drawn: more would run together.
SWINGS = 40
# Amplitudes below CLEAR standard deviations of the noise are not drawn.
CLEAR = 5.0
# Units of the first channel, and what turns SI into them.
UNITS = {"displacement": ("mm", style.MM), "velocity": ("mm/s", style.MM), "acceleration": ("m/s²", 1.0)}


def _unit(result: DiagnosisResult) -> tuple[str, float]:
    return UNITS[str(result.data["channel"].values[0])]


def swings(time: np.ndarray, signal: np.ndarray, noise: float) -> tuple[np.ndarray, np.ndarray]:
    """Times of the swings from one turning point to the next, and half of their lengths.

    So the middle of the motion may move, as it does where friction holds the mass beside its rest. ``noise``:
    standard deviation, of which swings stand out.
    """
    clear = 2.0 * CLEAR * noise
    tops, bottoms = (find_peaks(each, prominence=max(clear, 1e-300))[0] for each in (signal, -signal))
    turns = np.unique(np.r_[0, tops, bottoms])
    when, size = 0.5 * (time[turns[:-1]] + time[turns[1:]]), 0.5 * np.abs(np.diff(signal[turns]))
    # A release begins with its longest swing, any other motion in the middle of one.
    whole = int(size.size > 1 and size[0] < size[1])
    return when[whole:], size[whole:]


def _signals(result: DiagnosisResult, test: int) -> dict[str, np.ndarray]:
    """Times (s) and motions of the measurement and of each model, as far as there are any; see UNITS."""
    data = result.data.isel(test=test, channel=0)
    there = np.isfinite(data["measured"].values)
    found = {model: data["simulated"].sel(model=model).values for model in result.models}
    found["measured"] = data["measured"].values
    motions = {name: each[there] * _unit(result)[1] for name, each in found.items()}
    return {"time": data["time"].values[there], **motions}


def _draw_motion(ax: Axes, result: DiagnosisResult, signals: dict[str, np.ndarray], end: float) -> None:
    shown = signals["time"] <= end
    time = signals["time"][shown]
    ax.plot(time, signals["measured"][shown], **marks.MEASURED)
    for model in result.models:
        ax.plot(time, signals[model][shown], **marks.line(model))


def _draw_swings(ax: Axes, result: DiagnosisResult, signals: dict[str, np.ndarray], noise: float) -> None:
    for name in ("measured", *result.models):
        look = {**marks.MEASURED_DOT, "markersize": 3.0} if name == "measured" else marks.line(name)
        ax.plot(*swings(signals["time"], signals[name], noise), **look)
    ax.set_ylim(bottom=0.0)


def _draw_left(ax: Axes, result: DiagnosisResult, signals: dict[str, np.ndarray], noise: float) -> None:
    ax.axhspan(-2.0 * noise, 2.0 * noise, color="0.85", linewidth=0.0)
    for model in result.models:
        left = signals["measured"] - signals[model]
        ax.plot(signals["time"], left, color=marks.COLORS[model], linewidth=0.8)
    ax.set_xlabel("time [s]", fontsize=8.5)


def _end(signals: dict[str, np.ndarray], noise: float) -> float:
    """Time up to which the motion is drawn."""
    when, _ = swings(signals["time"], signals["measured"], noise)
    return float(when[SWINGS] if when.size > SWINGS else signals["time"][-1])


def draw(target: Target, result: DiagnosisResult, tests: Sequence[int] | None = None) -> Panels:
    """Draw the motion of each test, the size of its swings, and what the models leave (default: six tests).

    To see: above, the thick line is the measured motion, the dashed line the base model. In between, the
    size of each swing: on a straight line that falls, friction is dry; with a damper it falls by the same
    share each time. Below, what the models leave, over the grey band of the noise: a difference that
    grows and turns over is a frequency that is off.
    """
    made = multiples(target, result, tests, (2.9, 1.15), 3, between=0.42)
    cut = False
    for test, (motion, sizes, left) in made:
        signals = _signals(result, test)
        noise = float(result.data["sample_noise"].values[test, 0]) * _unit(result)[1]
        end = _end(signals, noise)
        cut |= end < signals["time"][-1]
        _draw_motion(motion, result, signals, end)
        _draw_swings(sizes, result, signals, noise)
        _draw_left(left, result, signals, noise)
        motion.set_title(selection.errors(result, test), fontsize=8.5)
    name, (unit, _) = str(result.data["channel"].values[0]), _unit(result)
    made.label_sides(f"{name} [{unit}]", f"swings [{unit}]", f"left [{unit}]")
    marks.legend(made, result, dots=False)
    first = f" (first {SWINGS} swings)" if cut else ""
    made.title(
        f"Motion in time{first}, measured and simulated",
        "below: size of each swing, and what is left; grey: noise (2 std)",
    )
    return made
