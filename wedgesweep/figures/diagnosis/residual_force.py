"""The force that the base model lacks, over displacement and over velocity."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from scipy.special import chdtrc

from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.figures import labels, style
from wedgesweep.figures.diagnosis import selection
from wedgesweep.figures.diagnosis.multiples import multiples
from wedgesweep.figures.diagnosis.selection import motion
from wedgesweep.figures.panels import Panels, Target

NAME = "leftover-force"
DESCRIPTION = "force that the base model lacks, over displacement and velocity"
TESTS = "steady"

PARTS = 16  # of the period, a colour each
PALE = "0.7"


def _is_noise(result: DiagnosisResult, test: int) -> bool:
    """Tell whether noise alone may explain what the base model leaves of a test."""
    q, dof = (result.data[name].values for name in ("q", "dof"))
    return bool(chdtrc(dof[test], q[0, test]) >= result.document["method"]["adequate_p"])


def _draw(ax: Axes, signal: np.ndarray, force: np.ndarray, pale: bool) -> None:
    ax.axhline(0.0, color=style.GREY, linewidth=0.8)
    around = np.append(np.arange(force.size), 0)
    for place, part in enumerate(np.array_split(around, PARTS)):
        joined = np.append(part, around[min(part[-1] + 1, force.size)]) if part[-1] else part
        color = PALE if pale else style.SEQUENTIAL(place / (PARTS - 1))
        ax.plot(signal[joined] * style.MM, force[joined], color=color, linewidth=1.4)
    ax.locator_params(axis="x", nbins=5)


def draw(target: Target, result: DiagnosisResult, tests: Sequence[int] | None = None) -> Panels:
    """Draw the residual force over displacement, below it over velocity (default: six tests, largest misfit).

    To see: the residual force is what the base model lacks to move as measured. A step at zero velocity
    is dry friction, a slope over velocity a damper, a slope or curve over displacement a spring; a loop
    over both has memory. Colour runs through the period from violet to green. Grey: the misfit of the
    test may be noise, and so may the force.
    """
    data = result.data
    available = np.isfinite(data["leftover_force"].values).all(axis=-1)
    chosen = [test for test in selection.choose(result, tests) if available[test]]
    if not chosen:
        raise ValueError(f"the tests do not give the force on the {labels.of(data).body}")
    words = labels.of(data)
    made = multiples(target, result, chosen, (2.5, 1.3), 2, between=0.46)
    for test, (upper, lower) in made:
        x, v = motion(data, data["measured_waveform"], test)
        force = data["leftover_force"].values[test]
        for ax, signal in ((upper, x), (lower, v)):
            _draw(ax, signal, force, _is_noise(result, test))
        upper.set_xlabel(f"${words.motion}$ [mm]", fontsize=8.5)
        lower.set_xlabel(f"${words.rate}$ [mm/s]", fontsize=8.5)
    made.label_sides("residual force [N]", "residual force [N]")
    made.title(
        f"Residual force on the {words.body} ({words.positive}), which the base model lacks",
        "violet to green: through one period; grey: may be noise",
    )
    return made
