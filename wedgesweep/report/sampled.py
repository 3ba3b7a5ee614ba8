"""Measured against simulated samples: forces of loops, free motions in time."""

from collections.abc import Mapping
from typing import Any

from wedgesweep import formatting
from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.figures.diagnosis import spectrogram
from wedgesweep.figures.diagnosis.selection import SHOWN, by_misfit
from wedgesweep.report import html, phrases
from wedgesweep.report.html import Markup
from wedgesweep.report.inline_figures import InlineFigures

FIGURES = {"loop": "loops", "transient": "decays"}
CAPTIONS = {
    "loop": "Above, the thick line is the measured force, the dashed line the base model. Below, what the "
    "models leave: a step at zero velocity is dry friction, a slope over velocity a damper, a slope on one "
    "side only a damper that depends on the direction.",
    "transient": "Above, the thick line is the measured motion, the dashed line the base model. In between, "
    "the size of each swing: on a straight line that falls, friction is dry; with a damper it falls by the "
    "same share each time. Below, what the models leave, over the grey band of the noise.",
}
SPECTROGRAM = (
    "Dark is strong. What the base model leaves along the strongest line of the measured motion is a wrong "
    "amplitude or phase, what it leaves at multiples of it is friction, a stop or play."
)
# Headings of the table, and keys of diagnosis.json.
COLUMNS = {
    "loop": {"low-pass [Hz]": "lowpass_hz", "noise [N]": "noise_force_N"},
    "transient": {
        "duration [s]": "duration_s",
        "start [mm]": "start_mm",
        "start [mm/s]": "start_mm_per_s",
        "noise [mm]": "noise_displacement_mm",
    },
}
COMPARED = {
    "loop": "The motion is imposed, and the force is compared in {tests} of whole cycles, below the cut-off "
    "of a low-pass filter. With the zero of the force fitted",
    "transient": "The free motion of {tests} is compared in time. With the start of each and the zero of the "
    "displacement fitted",
}


def section(result: DiagnosisResult, draw: InlineFigures, heading: str, place: str) -> Markup:
    """Section with the samples and a table of the tests."""
    kind, order = result.document["kind"], by_misfit(result.data).tolist()
    head = ["test", "samples", *COLUMNS[kind], *(f"error, {model}" for model in result.models)]
    rows = [_row(test, kind, result.models) for test in result.document["misfit"]["tests"]]
    return html.section(
        place,
        heading,
        html.paragraph(_overall(result, kind)),
        draw(FIGURES[kind], CAPTIONS[kind], order[:SHOWN]),
        draw("spectrogram", SPECTROGRAM) if spectrogram.possible(result) else Markup(),
        html.table("All tests; errors are rms over that of the response", head, rows),
    )


def _row(test: Mapping[str, Any], kind: str, models: tuple[str, ...]) -> list[str]:
    own = [formatting.short(test[key]) for key in COLUMNS[kind].values()]
    errors = [formatting.error(test[f"error_{model}"]) for model in models]
    return [test["name"], str(test["samples"]), *own, *errors]


def _overall(result: DiagnosisResult, kind: str) -> str:
    misfit, count = result.document["misfit"], result.data.sizes["test"]
    tests = formatting.counted(count, "block" if kind == "loop" else "test")
    error = phrases.times_noise(misfit["chi2_base"], misfit["dof"])
    return f"{COMPARED[kind].format(tests=tests)}, the base model leaves an error of {error}."
