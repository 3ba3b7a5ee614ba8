"""Measured against simulated, from the total misfit down to the residual force."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from wedgesweep import formatting
from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.figures import diagnosis
from wedgesweep.figures.diagnosis.selection import TESTS_SHOWN, by_misfit
from wedgesweep.report import html, phrases
from wedgesweep.report.html import Markup
from wedgesweep.report.inline_figures import InlineFigures

BY_TEST = ("waveforms", "phase-plane", "harmonics", "leftover-force")
# Headings of the noise, and keys of diagnosis.json.
NOISE = {
    "noise, displacement [mm]": "noise_displacement_mm",
    "noise, velocity [mm/s]": "noise_velocity_mm_per_s",
}
# The same of the load of a column, where that was recorded.
LOAD = {
    "noise, load [N]": "noise_normal_force_N",
    "mean load [N]": "mean_normal_force_N",
    "fitted mean load [N]": "mean_normal_force_fitted_N",
}


def section(result: DiagnosisResult, draw: InlineFigures, place: str = "misfit") -> Markup:
    """Section with all that is measured against simulated."""
    order = by_misfit(result.data).tolist()
    return html.section(
        place,
        heading(result),
        html.paragraph(_overall(result)),
        draw("misfit", _extremes(result)),
        _table(result),
        html.element("h3", "Motion and forces, test by test"),
        html.paragraph(_selected(result)),
        *(draw(kind, tests=order[:TESTS_SHOWN]) for kind in BY_TEST),
        *([draw("column-load")] if _has_load(result) else []),
        _rest(draw, order[TESTS_SHOWN:]),
        html.element("h3", "Plateaus, energy and peak-to-peak"),
        draw("plateaus", _plateaus(result)),
        draw("energy", _energy(result)),
        draw("swing"),
    )


def _has_load(result: DiagnosisResult) -> bool:
    return "measured_load" in result.data


def heading(result: DiagnosisResult) -> str:
    """Heading of the section."""
    return "Measured and simulated" if result.verdict == "nothing-missing" else "What is wrong"


def _ratio(test: dict[str, Any], model: str) -> float:
    q = test[f"q_{model}"]
    return float("inf") if q is None else q / max(test["dof"], 1)


def _overall(result: DiagnosisResult) -> str:
    misfit = result.document["misfit"]
    tests = formatting.counted(result.data.sizes["test"], "test")
    q, dof = formatting.number(misfit["chi2_base"]), misfit["dof"]
    p = phrases.p_value(misfit["p_base"]).replace(" ", formatting.NO_BREAK)
    return (
        f"With start phases, amplitudes and uncertain parameters fitted to {tests}, the base model leaves a "
        f"misfit of Q = {q} on {dof} degrees of freedom, where noise alone leaves about {dof} ({p}). That is "
        f"an error of {phrases.error_of(result, 'base')} times the noise."
    )


def _extremes(result: DiagnosisResult) -> str:
    tests = sorted(result.document["misfit"]["tests"], key=lambda test: _ratio(test, "base"))
    best, worst = _described(tests[0]), _described(tests[-1])
    fits = f"fits worst in {worst} and best in {best}" if len(tests) > 1 else f"was compared with {best}"
    return f"The base model {fits}; noise alone leaves Q/dof = 1."


def _described(test: dict[str, Any]) -> str:
    ratio = formatting.number(_ratio(test, "base"))
    return f"{test['name']} ({formatting.short(test['frequency_hz'])} Hz, Q/dof = {ratio})"


def _table(result: DiagnosisResult) -> Markup:
    unit = phrases.amplitude_unit(result.document["misfit"]["tests"][0])
    size = phrases.split_key(f"amplitude_{unit}")[1]
    noise = phrases.columns(NOISE, result.document) | (LOAD if _has_load(result) else {})
    head = ["test", "frequency [Hz]", f"amplitude [{size}]", f"fitted amplitude [{size}]", "periods"]
    head += [*noise, *(f"Q/dof {model}" for model in result.models)]
    rows = [_row(test, [*noise.values()], result.models) for test in result.document["misfit"]["tests"]]
    return html.details("Table of all tests", html.table("All tests and their misfit", head, rows))


def _row(test: dict[str, Any], noise: Sequence[str], models: Sequence[str]) -> list[str]:
    unit = phrases.amplitude_unit(test)
    keys = ("frequency_hz", f"amplitude_{unit}", f"amplitude_fitted_{unit}", "periods")
    numbers = [formatting.short(test[key]) for key in (*keys, *noise)]
    return [test["name"], *numbers, *(formatting.number(_ratio(test, model)) for model in models)]


def _selected(result: DiagnosisResult) -> str:
    count = result.data.sizes["test"]
    if count <= TESTS_SHOWN:
        return "Tests in order of decreasing misfit." if count > 1 else "The only test."
    return f"The {TESTS_SHOWN} of {count} tests with the largest misfit; the others are folded below."


def _rest(draw: InlineFigures, tests: Sequence[int]) -> Markup:
    if not tests:
        return Markup()
    summary = "The other test" if len(tests) == 1 else f"The other {len(tests)} tests"
    return html.details(
        summary,
        *(draw(kind, f"{diagnosis.FIGURES[kind].description.capitalize()}.", tests) for kind in BY_TEST),
    )


def _plateaus(result: DiagnosisResult) -> str:
    measured = result.data["measured_plateau"].values
    if not np.isfinite(measured).any():
        return "The share of the period near rest is not known for any test."
    test = int(np.nanargmax(measured))
    simulated = result.data["simulated_plateau"].sel(model="base").values[test]
    return (
        f"The longest measured plateau takes {formatting.percent(measured[test])} of the period "
        f"({result.data['test'].values[test]}), that of the base model in the same test "
        f"{formatting.percent(simulated)}; a sine has 3{formatting.NO_BREAK}%."
    )


def _energy(result: DiagnosisResult) -> str:
    ratio = (result.data["simulated_energy"].sel(model="base") / result.data["measured_energy"]).values
    known = ratio[np.isfinite(ratio)]
    if not known.size:
        return "No test gives the energy: it follows from a known input amplitude."
    low, high = (formatting.number(each) for each in (known.min(), known.max()))
    times = low if low == high else f"{low} to {high}"
    return f"The base model dissipates {times} times the measured energy."
