"""Measured and simulated force along an imposed motion, and what the models leave of it."""

from collections.abc import Sequence

from matplotlib.axes import Axes

from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.figures import style
from wedgesweep.figures.diagnosis import marks, selection
from wedgesweep.figures.diagnosis.multiples import multiples
from wedgesweep.figures.panels import Panels, Target

NAME = "loops"
DESCRIPTION = "force over the imposed displacement, and what the models leave of it over velocity"
TESTS = "loop"


def _draw_loop(ax: Axes, result: DiagnosisResult, test: int) -> None:
    data = result.data.isel(test=test)
    position = data["displacement"].values * style.MM
    ax.plot(position, data["measured_force"].values, **marks.MEASURED)
    for model in result.models:
        ax.plot(position, data["simulated_force"].sel(model=model).values, **marks.line(model))
    ax.set_xlabel("displacement [mm]", fontsize=8.5)


def _draw_left(ax: Axes, result: DiagnosisResult, test: int) -> None:
    data = result.data.isel(test=test)
    velocity = data["velocity"].values * style.MM
    ax.axhline(0.0, color=style.GREY, linewidth=0.8)
    for model in result.models:
        left = data["measured_force"].values - data["simulated_force"].sel(model=model).values
        ax.plot(velocity, left, ".", color=marks.COLORS[model], markersize=2.0, alpha=0.6)
    ax.set_xlabel("velocity [mm/s]", fontsize=8.5)


def draw(target: Target, result: DiagnosisResult, tests: Sequence[int] | None = None) -> Panels:
    """Draw the loop of each test, and below it the force that the models leave (default: six tests).

    To see: above, the thick line is the measured force, the dashed line the base model. Below, what the
    models leave: a step at zero velocity is dry friction, a slope over velocity a damper, a slope or
    curve over displacement a spring, a slope on one side only a damper that depends on the direction.
    """
    made = multiples(target, result, tests, (2.5, 1.5), 2, between=0.46)
    for test, (loop, left) in made:
        _draw_loop(loop, result, test)
        _draw_left(left, result, test)
        loop.set_title(selection.errors(result, test), fontsize=8.5)
    made.label_sides("force [N]", "force left [N]")
    marks.legend(made, result, dots=False)
    made.title("Force along the imposed motion, measured and simulated", "the zero of the force is fitted")
    return made
