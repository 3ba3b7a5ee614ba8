"""Peak-to-peak over frequency, measured and simulated."""

import numpy as np
from matplotlib.figure import Figure

from wedgesweep.diagnosed import Diagnosed
from wedgesweep.figures import style
from wedgesweep.figures.diagnosis import look

NAME = "swing"
DESCRIPTION = "peak-to-peak over frequency, measured and simulated"

ALIKE = 0.1  # amplitudes this close, relatively, are joined by a line


def groups(amplitude: np.ndarray) -> list[np.ndarray]:
    """Indices of tests with like amplitudes (m), each group with its smallest amplitude first."""
    order = np.argsort(amplitude)
    jumps = np.flatnonzero(np.diff(np.log(amplitude[order])) > ALIKE) + 1
    return np.split(order, jumps)


def draw(found: Diagnosed) -> Figure:
    """Draw peak-to-peak of x - y over frequency; lines join tests of about the same input amplitude.

    To see: a measured peak at another frequency than the model's is stiffness or mass; a lower peak is
    energy loss; a jump that only one of them has is sticking, a stop, or a response that coexists.
    """
    data = found.data
    figure, (ax,) = style.panels(1, size=(6.2, 3.6), margin=(0.8, 0.8))
    frequency = data["frequency"].values
    amplitude = data["amplitude_fitted"].sel(model="extended").values
    for group in groups(amplitude):
        rows = group[np.argsort(frequency[group])]
        measured = data["measured_peak_to_peak"].values[rows] * style.MM
        ax.plot(frequency[rows], measured, color="black", linewidth=0.8)
        ax.plot(frequency[rows], measured, **look.MEASURED_DOT)
        place = {"textcoords": "offset points", "va": "center", "fontsize": 7.5, "color": style.GREY}
        words = f"$a$ {amplitude[rows].mean() * style.MM:.2g} mm"
        ax.annotate(words, (frequency[rows[-1]], measured[-1]), (8, 0), **place)
        for model in found.models:
            values = data["simulated_peak_to_peak"].sel(model=model).values[rows] * style.MM
            ax.plot(frequency[rows], values, **{**look.dot(model), **look.line(model), "linewidth": 0.8})
    if data["measured_peak_to_peak"].max() > 20.0 * data["measured_peak_to_peak"].min():
        ax.set_yscale("log")
        style.log_ticks(ax.yaxis)
    ax.margins(x=0.12)
    style.label([ax], "frequency [Hz]", "peak-to-peak of $x-y$ [mm]")
    look.legend(figure, found, dots=True)
    style.title(figure, "Peak-to-peak of $x-y$ over frequency, measured and simulated")
    return figure
