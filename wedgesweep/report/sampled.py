"""Measured against simulated samples: forces of loops, motions in time."""

from collections.abc import Mapping, Sequence
from typing import Any

from wedgesweep import formatting
from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.figures.diagnosis import spectrogram
from wedgesweep.figures.diagnosis.selection import TESTS_SHOWN, by_misfit
from wedgesweep.report import html, phrases
from wedgesweep.report.html import Markup
from wedgesweep.report.inline_figures import InlineFigures

FIGURES = {"loop": "loops", "transient": "decays"}
# Headings of the table, and keys of diagnosis.json.
COLUMNS = {
    "loop": {
        "low-pass [Hz]": "lowpass_hz",
        "noise [N]": "noise_force_N",
        "noise as fitted [N]": "noise_force_fitted_N",
    },
    "transient": {
        "duration [s]": "duration_s",
        "start [mm]": "start_mm",
        "start [mm/s]": "start_mm_per_s",
        "noise [mm]": "noise_displacement_mm",
        "noise [mm/s]": "noise_velocity_mm_per_s",
        "noise [m/s²]": "noise_acceleration_m_per_s2",
    },
}
# What the noise is taken from (``noise_from``), and what that assumes.
NOISE = {
    "repeats": "The noise is what differs between repeats of a test, which assumes that the rig did not "
    "change from one to the next.",
    "frequencies without motion": "The noise is read where the motion has no frequencies, where it is over, "
    "and from what two channels do not share. This assumes noise of one shape for a sensor in all tests, "
    "a smooth function of frequency.",
    "what an explanation leaves": "The noise is read likewise from what an explanation leaves of the "
    "records, where less shows there than in the records themselves.",
    "what no smooth function of the motion explains": "The noise is what no smooth function of displacement, "
    "velocity, acceleration and forces of springs with sliders explains, which assumes that what is missing "
    "in the model is such a function; anything else counts as noise.",
}
COMPARED = {
    "loop": "The motion is imposed, and the force is compared in {parts} of whole cycles, below the cut-off "
    "of a low-pass filter. With the zero of the force fitted",
    "transient": "The motion in {parts} of the records is compared in time, under the recorded input where "
    "there is one. With the start of each and the zero of the displacement fitted",
}


def section(result: DiagnosisResult, draw: InlineFigures, heading: str, place: str) -> Markup:
    """Section with the samples and a table of the tests."""
    kind, order = result.document["kind"], by_misfit(result.data).tolist()
    tests = result.document["misfit"]["tests"]
    # Channels that no test has are left out.
    named = phrases.columns(COLUMNS[kind], result.document)
    columns = {name: key for name, key in named.items() if any(each.get(key) is not None for each in tests)}
    head = ["test", "samples", *columns, *(f"error, {model}" for model in result.models)]
    rows = [_row(test, list(columns.values()), result.models) for test in tests]
    return html.section(
        place,
        heading,
        html.paragraph(_overall(result, kind)),
        html.paragraph(noise_source(tests)),
        draw(FIGURES[kind], tests=order[:TESTS_SHOWN]),
        draw("spectrogram") if spectrogram.possible(result) else Markup(),
        html.table("All tests; errors are rms over that of the response", head, rows),
    )


def noise_source(tests: Sequence[Mapping[str, Any]]) -> str:
    """Where the noise of the tests comes from, and what that assumes."""
    # Results of older versions do not tell it.
    sources = dict.fromkeys(each["noise_from"] for each in tests if each.get("noise_from"))
    return " ".join(NOISE.get(source, f"The noise is taken from {source}.") for source in sources)


def _row(test: Mapping[str, Any], keys: Sequence[str], models: tuple[str, ...]) -> list[str]:
    own = [formatting.short(test.get(key)) for key in keys]
    errors = [formatting.error(test[f"error_{model}"]) for model in models]
    return [test["name"], str(test["samples"]), *own, *errors]


def _overall(result: DiagnosisResult, kind: str) -> str:
    error, parts = phrases.error_of(result, "base"), phrases.compared(result)
    return f"{COMPARED[kind].format(parts=parts)}, the base model leaves an error of {error} times the noise."
