"""How the measurement and the models are drawn and named in the figures of a diagnosis."""

from typing import Any

from matplotlib.lines import Line2D

from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.figures import style
from wedgesweep.figures.panels import Panels

MEASURED = {"color": "black", "linewidth": 2.8}
MEASURED_DOT = {"marker": "o", "linestyle": "none", "color": "black", "markersize": 4.5}
BAR = {"marker": "|", "linestyle": "none", "color": "black", "markersize": 11, "markeredgewidth": 1.6}
STDS = 1.96  # half the band that holds 95 % of the noise
COLORS = {"base": style.VERMILLION, "extended": style.BLUE}
LINES = {"base": "--", "extended": "-"}
MARKERS = {"base": "x", "extended": "+"}


def names(result: DiagnosisResult) -> dict[str, str]:
    """Return the name of each model that is shown, for a legend."""
    extended = "best attempt" if not result.document["causes"] else "extended"
    named = {"base": "base model", "extended": f"{extended}: {' + '.join(result.added)}"}
    return {model: named[model] for model in result.models}


def dot(model: str) -> dict[str, Any]:
    """Draw a number of a model as an open mark, so that the measured dot behind it stays visible."""
    size = {"markersize": 8.5 if model == "extended" else 6, "markeredgewidth": 1.6}
    return {"marker": MARKERS[model], "linestyle": "none", "color": COLORS[model], **size}


def line(model: str) -> dict[str, Any]:
    """Draw a signal of a model."""
    return {"linestyle": LINES[model], "color": COLORS[model], "linewidth": 1.2}


def legend(made: Panels, result: DiagnosisResult, dots: bool) -> None:
    """Write the legend of the measurement and of the models, as dots or as lines."""
    measured: dict[str, Any] = MEASURED_DOT if dots else MEASURED
    looks = [measured, *(dot(model) if dots else line(model) for model in result.models)]
    handles = [Line2D([], [], **look) for look in looks]
    made.legend(handles, ["measured", *names(result).values()])
