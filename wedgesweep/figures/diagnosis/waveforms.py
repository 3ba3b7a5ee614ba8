"""Measured and simulated motion over one period of the input, test by test."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.figures import labels, style
from wedgesweep.figures.diagnosis import marks
from wedgesweep.figures.diagnosis.multiples import multiples
from wedgesweep.figures.diagnosis.selection import closed, motion
from wedgesweep.figures.panels import Panels, Target

NAME = "waveforms"
DESCRIPTION = "displacement and velocity over one period, measured and simulated, and the difference"
TESTS = "steady"

UM = 1e6  # of a metre


def _draw(ax: Axes, result: DiagnosisResult, test: int, channel: int) -> None:
    data = result.data
    measured = motion(data, data["measured_waveform"], test)[channel]
    ax.plot(_phase(result), closed(measured) * style.MM, **marks.MEASURED)
    for model in result.models:
        signal = motion(data, data["simulated_waveform"].sel(model=model), test)[channel]
        ax.plot(_phase(result), closed(signal) * style.MM, **marks.line(model))
    ax.set_xlim(0.0, 1.0)


def _draw_difference(ax: Axes, result: DiagnosisResult, test: int) -> None:
    data = result.data
    measured = data["measured_waveform"].values[test, 0]
    half = marks.STDS * np.sqrt(np.nansum(data["noise_std"].values[test, 0] ** 2)) * UM
    ax.axhspan(-half, half, color="0.85", linewidth=0)
    for model in result.models:
        simulated = data["simulated_waveform"].sel(model=model).values[test, 0]
        ax.plot(_phase(result), closed(simulated - measured) * UM, **marks.line(model))
    ax.set_xlim(0.0, 1.0)


def _phase(result: DiagnosisResult) -> np.ndarray:
    return np.linspace(0.0, 1.0, result.data.sizes["phase"] + 1)


def draw(target: Target, result: DiagnosisResult, tests: Sequence[int] | None = None) -> Panels:
    """Draw displacement, velocity and the difference for each test (default: the six that misfit most).

    To see: the thick line is measured (mean over the periods), the dashed line is the base model. A crest
    that is flat in one and round in the other means sticking, a shift in time a delay or another mass.
    The lowest panels show the difference; within the grey band (95 %) it is noise.
    """
    made = multiples(target, result, tests, (2.5, 1.05), 3, between=0.16)
    for test, (upper, middle, lower) in made:
        _draw(upper, result, test, 0)
        _draw(middle, result, test, 1)
        _draw_difference(lower, result, test)
        for ax in (upper, middle):
            ax.tick_params(labelbottom=False)
        lower.set_xlabel("time over period [1]", fontsize=8.5)
    words = labels.of(result.data)
    made.label_sides(f"${words.motion}$ [mm]", f"${words.rate}$ [mm/s]", "difference [µm]")
    marks.legend(made, result, dots=False)
    made.title(
        f"One period of ${words.motion}$ and ${words.rate}$, measured and simulated",
        f"below: simulated minus measured; grey: 95 % of the noise; time 0: ${words.input}$ = 0, rising",
    )
    return made
