"""The force that the base model lacks, over displacement and over velocity."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from scipy.special import chdtrc

from wedgesweep.diagnosed import Diagnosed
from wedgesweep.figures import style
from wedgesweep.figures.diagnosis import look

NAME = "leftover-force"
DESCRIPTION = "force on the bolster that the base model lacks, over displacement and velocity"

PARTS = 16  # of the period, a colour each
PALE = "0.7"


def _is_noise(found: Diagnosed, test: int) -> bool:
    """Whether noise alone may leave what the base model leaves of a test."""
    q, dof = (found.data[name].values for name in ("q", "dof"))
    return bool(chdtrc(dof[test], q[0, test]) >= found.document["method"]["adequate_p"])


def _draw(ax, signal: np.ndarray, force: np.ndarray, pale: bool) -> None:
    ax.axhline(0.0, color=style.GREY, linewidth=0.8)
    around = np.append(np.arange(force.size), 0)
    for place, part in enumerate(np.array_split(around, PARTS)):
        joined = np.append(part, around[min(part[-1] + 1, force.size)]) if part[-1] else part
        color = PALE if pale else style.SEQUENTIAL(place / (PARTS - 1))
        ax.plot(signal[joined] * style.MM, force[joined], color=color, linewidth=1.4)
    ax.locator_params(axis="x", nbins=5)


def draw(found: Diagnosed, tests: Sequence[int] | None = None) -> Figure:
    """Draw leftover force over displacement, below it over velocity (default: six tests, largest misfit).

    To see: a step at zero velocity is dry friction, a slope over velocity a damper, a slope or curve over
    displacement a spring, a loop over both something with a memory. Colour runs through the period from
    violet to green; grey is a test in which nothing is missing, so that its force may be noise.
    """
    data = found.data
    available = np.isfinite(data["leftover_force"].values).all(axis=-1)
    chosen = [test for test in look.choose(found, tests) if available[test]]
    if not chosen:
        message = f"{NAME}: the tests do not give the force on the bolster"
        raise ValueError(message)
    figure, panels = look.multiples(found, chosen, (2.5, 1.3), 2, between=0.46)
    for test, (upper, lower) in panels:
        x, v = look.motion(data, data["measured_waveform"], test)
        force = data["leftover_force"].values[test]
        for ax, signal in ((upper, x), (lower, v)):
            _draw(ax, signal, force, _is_noise(found, test))
        upper.set_xlabel("$x-y$ [mm]", fontsize=8.5)
        lower.set_xlabel("$x'-y'$ [mm/s]", fontsize=8.5)
    look.label_sides(panels, "force [N]", "force [N]")
    style.title(
        figure,
        "Force on the bolster (up positive) that the base model lacks",
        "over displacement, below over velocity; violet to green: through the period; grey: may be noise",
    )
    return figure
