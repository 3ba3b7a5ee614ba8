"""Peak-to-peak over frequency, measured and simulated."""

import numpy as np

from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.figures import labels, style
from wedgesweep.figures.diagnosis import marks, selection
from wedgesweep.figures.panels import Panels, Target, panels

NAME = "swing"
DESCRIPTION = "peak-to-peak over frequency, measured and simulated"
TESTS = "steady"

ALIKE = 0.1  # amplitudes this close, relatively, are joined by a line


def groups(amplitude: np.ndarray) -> list[np.ndarray]:
    """Indices of tests grouped by amplitude, each group by increasing amplitude."""
    order = np.argsort(amplitude)
    jumps = np.flatnonzero(np.diff(np.log(amplitude[order])) > ALIKE) + 1
    return np.split(order, jumps)


def draw(target: Target, result: DiagnosisResult) -> Panels:
    """Draw peak-to-peak of x - y over frequency; lines join tests of about the same input amplitude.

    To see: lines join tests of about the same input amplitude. A measured peak at another frequency than
    the model's points to stiffness or mass, a lower peak to dissipation, and a jump that only one of them
    has to sticking, a stop or a coexisting response.
    """
    data, words = result.data, labels.of(result.data)
    made = panels(target, 1, size=(6.2, 3.6), margin=(0.8, 0.8))
    ax = made.axes[0]
    frequency = data["frequency"].values
    amplitude = data["amplitude_fitted"].sel(model="extended").values
    for group in groups(amplitude):
        rows = group[np.argsort(frequency[group])]
        measured = data["measured_peak_to_peak"].values[rows] * style.MM
        ax.plot(frequency[rows], measured, color="black", linewidth=0.8)
        ax.plot(frequency[rows], measured, **marks.MEASURED_DOT)
        place = {"textcoords": "offset points", "va": "center", "fontsize": 7.5, "color": style.GREY}
        text = f"${words.symbol}$ = {selection.amplitude(data, amplitude[rows].mean(), 2)}"
        ax.annotate(text, (frequency[rows[-1]], measured[-1]), (8, 0), **place)
        for model in result.models:
            values = data["simulated_peak_to_peak"].sel(model=model).values[rows] * style.MM
            ax.plot(frequency[rows], values, **{**marks.dot(model), **marks.line(model), "linewidth": 0.8})
    if data["measured_peak_to_peak"].max() > 20.0 * data["measured_peak_to_peak"].min():
        ax.set_yscale("log")
        style.log_ticks(ax.yaxis)
    ax.margins(x=0.12)
    style.label([ax], "frequency [Hz]", f"peak-to-peak of ${words.motion}$ [mm]")
    marks.legend(made, result, dots=True)
    made.title(f"Peak-to-peak of ${words.motion}$ over frequency, measured and simulated")
    return made
