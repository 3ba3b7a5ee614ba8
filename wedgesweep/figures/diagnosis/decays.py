"""Measured and simulated free motion in time, and what the models leave of it."""

from collections.abc import Sequence

from matplotlib.axes import Axes

from wedgesweep import formatting
from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.figures import style
from wedgesweep.figures.diagnosis import marks, selection
from wedgesweep.figures.diagnosis.multiples import multiples
from wedgesweep.figures.panels import Panels, Target

NAME = "decays"
DESCRIPTION = "free motion in time, measured and simulated, and what the models leave of it"


def _draw_motion(ax: Axes, result: DiagnosisResult, test: int) -> None:
    data = result.data.isel(test=test, channel=0)
    time = data["time"].values
    ax.plot(time, data["measured"].values * style.MM, **marks.MEASURED)
    for model in result.models:
        ax.plot(time, data["simulated"].sel(model=model).values * style.MM, **marks.line(model))


def _draw_left(ax: Axes, result: DiagnosisResult, test: int) -> None:
    data = result.data.isel(test=test, channel=0)
    noise = float(data["sample_noise"]) * style.MM
    ax.axhspan(-2.0 * noise, 2.0 * noise, color="0.85", linewidth=0.0)
    for model in result.models:
        left = (data["measured"] - data["simulated"].sel(model=model)).values * style.MM
        ax.plot(data["time"].values, left, color=marks.COLORS[model], linewidth=0.8)
    ax.set_xlabel("time [s]", fontsize=8.5)


def draw(target: Target, result: DiagnosisResult, tests: Sequence[int] | None = None) -> Panels:
    """Draw the motion of each test, and below it what the models leave (default: six tests).

    To see: amplitudes that fall by the same step in every cycle are dry friction, those that fall by the same
    share a damper; a difference that grows and turns over is a frequency that is off.
    """
    if "time" not in result.data:
        message = "the tests are no transients"
        raise ValueError(message)
    made = multiples(target, result, selection.choose(result, tests), (2.9, 1.3), 2, between=0.3)
    for test, (motion, left) in made:
        _draw_motion(motion, result, test)
        _draw_left(left, result, test)
        row = result.document["misfit"]["tests"][test]
        errors = " → ".join(formatting.error(row[f"error_{model}"]) for model in result.models)
        motion.set_title(f"{selection.label(result.data, test)}\nerror {errors}", fontsize=8.5)
    made.label_sides("displacement [mm]", "left [mm]")
    marks.legend(made, result, dots=False)
    made.title("Free motion, measured and simulated", "grey: two standard deviations of the noise")
    return made
