"""Measured and simulated motion over one period of the input, test by test."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from wedgesweep.diagnosed import Diagnosed
from wedgesweep.figures import style
from wedgesweep.figures.diagnosis import look

NAME = "waveforms"
DESCRIPTION = "displacement and velocity over one period, measured and simulated, and the difference"

STDS = 1.96  # half the band that holds 95 % of the noise
UM = 1e6  # of a metre


def _draw(ax, found: Diagnosed, test: int, channel: int) -> None:
    data = found.data
    measured = look.motion(data, data["measured_waveform"], test)[channel]
    ax.plot(_phase(found), look.closed(measured) * style.MM, **look.MEASURED)
    for model in found.models:
        signal = look.motion(data, data["simulated_waveform"].sel(model=model), test)[channel]
        ax.plot(_phase(found), look.closed(signal) * style.MM, **look.line(model))
    ax.set_xlim(0.0, 1.0)


def _draw_difference(ax, found: Diagnosed, test: int) -> None:
    data = found.data
    measured = data["measured_waveform"].values[test, 0]
    half = STDS * np.sqrt(np.nansum(data["noise_std"].values[test, 0] ** 2)) * UM
    ax.axhspan(-half, half, color="0.85", linewidth=0)
    for model in found.models:
        simulated = data["simulated_waveform"].sel(model=model).values[test, 0]
        ax.plot(_phase(found), look.closed(simulated - measured) * UM, **look.line(model))
    ax.set_xlim(0.0, 1.0)


def _phase(found: Diagnosed) -> np.ndarray:
    return np.linspace(0.0, 1.0, found.data.sizes["phase"] + 1)


def draw(found: Diagnosed, tests: Sequence[int] | None = None) -> Figure:
    """Draw displacement, velocity and what is left for each test (default: the six with the largest misfit).

    To see: where in the period the models leave black, the mean of the measured periods. A crest that is flat
    in one and round in the other is friction that holds; a shift in time is delay or mass. At the bottom
    models less measured: what stays within the grey band (95 % of the noise of the mean) is noise.
    """
    figure, panels = look.multiples(found, look.choose(found, tests), (2.5, 1.05), 3, between=0.16)
    for test, (upper, middle, lower) in panels:
        _draw(upper, found, test, 0)
        _draw(middle, found, test, 1)
        _draw_difference(lower, found, test)
        for ax in (upper, middle):
            ax.tick_params(labelbottom=False)
        lower.set_xlabel("time over period [1]", fontsize=8.5)
    look.label_sides(panels, "$x-y$ [mm]", "$x'-y'$ [mm/s]", "difference [µm]")
    look.legend(figure, found, dots=False)
    style.title(
        figure,
        "One period of relative displacement $x-y$ and velocity $x'-y'$, measured and simulated",
        "below: models less measured $x-y$, grey: 95 % of its noise; time 0: the input $u$ rises through 0",
    )
    return figure
