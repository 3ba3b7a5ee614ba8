"""Measured and simulated motion over one period of the input, test by test."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from wedgesweep.diagnosed import Diagnosed
from wedgesweep.figures import style
from wedgesweep.figures.diagnosis import look

NAME = "waveforms"
DESCRIPTION = "displacement and velocity over one period, measured and simulated"

STDS = 1.96  # half the band that holds 95 % of single samples


def _draw(ax, found: Diagnosed, test: int, channel: int) -> None:
    data = found.data
    phase = np.linspace(0.0, 1.0, data.sizes["phase"] + 1)
    measured = look.closed(look.motion(data, data["measured_waveform"], test)[channel]) * style.MM
    if channel < data.sizes["channel"]:
        half = STDS * data["waveform_noise"].values[test, channel] * style.MM
        ax.fill_between(phase, measured - half, measured + half, color="0.85", linewidth=0)
    ax.plot(phase, measured, **look.MEASURED)
    for model in found.models:
        signal = look.motion(data, data["simulated_waveform"].sel(model=model), test)[channel]
        ax.plot(phase, look.closed(signal) * style.MM, **look.line(model))
    ax.set_xlim(0.0, 1.0)


def draw(found: Diagnosed, tests: Sequence[int] | None = None) -> Figure:
    """Draw displacement above velocity for each test (default: the six with the largest misfit).

    To see: where in the period black (mean over the measured periods) leaves the dashed base model. A crest
    that is flat in one and round in the other is friction that holds; a shift in time is delay or mass.
    The grey band holds 95 % of single samples; the mean is known far better.
    """
    figure, panels = look.multiples(found, look.choose(found, tests), (2.5, 1.15), 2, between=0.16)
    for test, (upper, lower) in panels:
        _draw(upper, found, test, 0)
        _draw(lower, found, test, 1)
        upper.tick_params(labelbottom=False)
        lower.set_xlabel("time over period [1]", fontsize=8.5)
    look.label_sides(panels, "$x-y$ [mm]", "$x'-y'$ [mm/s]")
    look.legend(figure, found, dots=False)
    style.title(
        figure,
        "One period of relative displacement $x-y$ and velocity $x'-y'$, measured and simulated",
        "grey: 95 % of single samples; time 0: the input $u$ rises through 0",
    )
    return figure
