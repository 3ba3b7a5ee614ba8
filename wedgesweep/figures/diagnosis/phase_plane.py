"""Measured and simulated motion in the plane of displacement and velocity, test by test."""

from collections.abc import Sequence

from matplotlib.axes import Axes

from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.figures import labels, style
from wedgesweep.figures.diagnosis import marks
from wedgesweep.figures.diagnosis.multiples import multiples
from wedgesweep.figures.diagnosis.selection import closed, motion
from wedgesweep.figures.panels import Panels, Target

NAME = "phase-plane"
DESCRIPTION = "velocity over displacement, measured and simulated"
TESTS = "steady"


def _draw(ax: Axes, result: DiagnosisResult, test: int) -> None:
    data = result.data
    x, v = motion(data, data["measured_waveform"], test)
    ax.plot(closed(x) * style.MM, closed(v) * style.MM, **marks.MEASURED)
    for model in result.models:
        x, v = motion(data, data["simulated_waveform"].sel(model=model), test)
        ax.plot(closed(x) * style.MM, closed(v) * style.MM, **marks.line(model))
    ax.locator_params(nbins=5)
    ax.set_xlabel(f"${labels.of(data).motion}$ [mm]", fontsize=8.5)


def draw(target: Target, result: DiagnosisResult, tests: Sequence[int] | None = None) -> Panels:
    """Draw a loop per test (default: the six with the largest misfit).

    To see: a loop that is flat along zero velocity sticks there; a jump of velocity at one displacement
    is a stop or a breakaway; a tilted or wider loop has another stiffness or dissipation.
    """
    made = multiples(target, result, tests, (2.5, 1.9))
    for test, (ax,) in made:
        _draw(ax, result, test)
    words = labels.of(result.data)
    made.label_sides(f"${words.rate}$ [mm/s]")
    marks.legend(made, result, dots=False)
    made.title(
        "Phase plane over one period, measured and simulated",
        f"${words.motion}$: {words.whose}, mean removed",
    )
    return made
