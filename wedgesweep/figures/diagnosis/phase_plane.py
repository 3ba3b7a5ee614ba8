"""Measured and simulated motion in the plane of displacement and velocity, test by test."""

from collections.abc import Sequence

from matplotlib.figure import Figure

from wedgesweep.diagnosed import Diagnosed
from wedgesweep.figures import style
from wedgesweep.figures.diagnosis import look

NAME = "phase-plane"
DESCRIPTION = "velocity over displacement, measured and simulated"


def _draw(ax, found: Diagnosed, test: int) -> None:
    data = found.data
    x, v = look.motion(data, data["measured_waveform"], test)
    ax.plot(look.closed(x) * style.MM, look.closed(v) * style.MM, **look.MEASURED)
    for model in found.models:
        x, v = look.motion(data, data["simulated_waveform"].sel(model=model), test)
        ax.plot(look.closed(x) * style.MM, look.closed(v) * style.MM, **look.line(model))
    ax.locator_params(nbins=5)
    ax.set_xlabel("$x-y$ [mm]", fontsize=8.5)


def draw(found: Diagnosed, tests: Sequence[int] | None = None) -> Figure:
    """Draw a loop per test (default: the six with the largest misfit).

    To see: a loop pressed flat along velocity 0 sticks there; a jump of velocity at one displacement is a
    stop or a slip that breaks loose; a tilted or swollen loop has another stiffness or energy loss.
    """
    figure, panels = look.multiples(found, look.choose(found, tests), (2.5, 1.9))
    for test, (ax,) in panels:
        _draw(ax, found, test)
    look.label_sides(panels, "$x'-y'$ [mm/s]")
    look.legend(figure, found, dots=False)
    style.title(
        figure,
        "Phase plane of one period, measured and simulated",
        "$x-y$: side frame minus bolster, mean removed",
    )
    return figure
