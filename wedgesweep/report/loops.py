"""Measured against simulated forces of tests with an imposed motion."""

from wedgesweep import formatting
from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.figures.diagnosis.selection import SHOWN, by_misfit
from wedgesweep.report import html, phrases
from wedgesweep.report.html import Markup
from wedgesweep.report.inline_figures import InlineFigures

CAPTION = (
    "Above, the thick line is the measured force, the dashed line that of the base model. Below, what the "
    "models leave: a step at zero velocity is dry friction, a slope over velocity a damper, a slope on one "
    "side only a damper that depends on the direction."
)
HEAD = ("test", "samples", "low-pass [Hz]", "noise [N]")


def section(result: DiagnosisResult, draw: InlineFigures, heading: str) -> Markup:
    """Section with the loops and a table of the tests."""
    order = by_misfit(result.data).tolist()
    head = [*HEAD, *(f"error, {model}" for model in result.models)]
    rows = [
        [
            test["name"],
            str(test["samples"]),
            formatting.short(test["lowpass_hz"]),
            formatting.short(test["noise_force_N"]),
            *(formatting.percent(test[f"error_{model}"]) for model in result.models),
        ]
        for test in result.document["misfit"]["tests"]
    ]
    return html.section(
        "misfit",
        heading,
        html.paragraph(_overall(result)),
        draw("loops", CAPTION, order[:SHOWN]),
        html.table("All tests; errors are rms over that of the measured force", head, rows),
    )


def _overall(result: DiagnosisResult) -> str:
    misfit = result.document["misfit"]
    blocks = phrases.counted(result.data.sizes["test"], "block")
    error = phrases.times_noise(misfit["chi2_base"], misfit["dof"])
    return (
        f"The motion is imposed, and the force is compared in {blocks} of whole cycles, below the cut-off "
        f"of a low-pass filter. With the zero of the force fitted, the base model leaves an error of {error}."
    )
