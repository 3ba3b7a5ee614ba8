"""The method in short, and the settings of this diagnosis."""

from wedgesweep import formatting
from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.report import html, phrases
from wedgesweep.report.html import Markup

# What is compared, by the kind of the tests, and what is left out of a fit to measure the gain.
COMPARED = {
    "steady": "Steady tests: the forced response repeats in every period and noise does not. Least squares "
    "gives the harmonics of each test, and what does not repeat gives their noise (Pintelon and Schoukens "
    "2012).",
    "transient": "Transients: records are cut into windows whose starts are fitted. The cosine coefficients "
    "of each window are compared, under coloured noise.",
    "loop": "Loops: the force under the imposed motion is compared below the cut-off frequency of a "
    "low-pass. Its noise is what no smooth function of the motion explains, or what differs between repeats.",
}
LEFT_OUT = {
    "steady": "each frequency, then each amplitude, is left out of the fit and predicted",
    "transient": "records, or windows of a single one, are left out of the fit and predicted",
    "loop": "records, or blocks of a single one, are left out of the fit and predicted",
}
STEPS = (
    "Q is the squared distance between measurement and simulation in units of the noise, which for a "
    "correct model has a chi-squared distribution. Start phases, amplitudes and uncertain parameters are "
    "fitted first, for the base model too.",
    "Every candidate is fitted alone, and pairs of candidates if no single one is adequate; each fitted "
    "parameter costs a penalty. A cause must leave only noise, have the same parameters in all tests "
    "(Lagrange multiplier test), and lead its rivals by more than the tie width. To be named, it must be the "
    "only candidate that leaves only noise. A pair that many others imitate is not reported.",
)


def section(result: DiagnosisResult) -> Markup:
    """Section for readers who want to check or repeat the diagnosis."""
    kinds = [*result.parts] or [result.document.get("kind", "steady")]
    compared, left_out = [COMPARED[kind] for kind in kinds], [LEFT_OUT[kind] for kind in kinds]
    return html.section(
        "method",
        "How it was done",
        html.items([*compared, *STEPS, f"Gain on held-out tests: {'; '.join(left_out)}."]),
        html.table("Settings", ("setting", "value"), _settings(result)),
    )


def _of_harmonics(result: DiagnosisResult) -> list[list[str]]:
    harmonics = result.document["method"].get("harmonics")
    if harmonics is None or "channel" not in result.data.coords:
        return []
    channels = phrases.listing([str(name) for name in result.data["channel"].values])
    return [["harmonics of each channel", str(harmonics)], ["channels", channels]]


def _settings(result: DiagnosisResult) -> list[list[str]]:
    method, misfit = result.document["method"], result.document["misfit"]
    rows = [
        ["degrees of freedom, base model", str(misfit["dof"])],
        *_of_harmonics(result),
        ["penalty per fitted parameter", formatting.number(method["penalty_per_parameter"])],
        ["tie width", formatting.number(method.get("gap"))],
        ["excess needed to name a cause", formatting.number(method.get("strong_excess"))],
        ["thresholds", "calibrated for these tests" if method.get("calibrated") else "general"],
        ["friction law", result.document["model"]["law"]],
        ["wedgesweep version", result.document["version"]],
        ["created", result.document["created"]],
    ]
    return [row for row in rows if row[1] != formatting.NONE]
