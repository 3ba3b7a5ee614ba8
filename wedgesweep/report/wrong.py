"""What is wrong: measured against simulated, from the whole to the single force."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from wedgesweep import digits
from wedgesweep.diagnosed import Diagnosed
from wedgesweep.figures.diagnosis import DESCRIPTIONS
from wedgesweep.report import html, words
from wedgesweep.report.html import Markup
from wedgesweep.report.pictures import Pictures

SHOWN = 6  # tests whose signals are drawn at once, those with the largest misfit
SIGNALS = ("waveforms", "phase-plane", "harmonics", "leftover-force")


def section(found: Diagnosed, draw: Pictures) -> Markup:
    """Section with all that is measured against simulated."""
    ratios = [-_ratio(test, "base") for test in found.document["misfit"]["tests"]]
    order = np.argsort(ratios, kind="stable").tolist()
    return html.section(
        "wrong",
        heading(found),
        html.paragraph(_overall(found)),
        draw("misfit", _worst(found)),
        _tests(found),
        html.element("h3", "Motion and forces, test by test"),
        html.paragraph(_selected(found)),
        *(draw(kind, SEE[kind], order[:SHOWN]) for kind in SIGNALS),
        _rest(found, draw, order[SHOWN:]),
        html.element("h3", "Plateaus, energy and swing"),
        draw("plateaus", _plateaus(found)),
        draw("energy", _energy(found)),
        draw("swing", "Peak-to-peak over frequency; lines join tests of about the same input amplitude."),
    )


def heading(found: Diagnosed) -> str:
    """What the section is called."""
    return "Measured and simulated" if found.verdict == "nothing-missing" else "What is wrong"


SEE = {
    "waveforms": "The thick line is measured (mean of the periods), the dashed one is the base model. "
    "A flat crest is friction that holds. Below: models less measured; within grey is noise.",
    "phase-plane": "A loop pressed flat along zero velocity sticks there; "
    "a tilted or swollen one has another stiffness or energy loss.",
    "harmonics": "A mark off the measured dot by more than its bar is misfit. Odd harmonics come from what "
    "acts alike in both directions, even ones from what does not.",
    "leftover-force": "The force that the base model lacks to move as measured. A step at zero velocity is "
    "dry friction, a slope over velocity a damper, a slope over displacement a spring; a loop over both has "
    "a memory. Grey: the misfit of the test may be noise, and so may the force.",
}


def _ratio(test: dict[str, Any], model: str) -> float:
    left = test[f"q_{model}"]
    return float("inf") if left is None else left / max(test["dof"], 1)


def _overall(found: Diagnosed) -> str:
    misfit = found.document["misfit"]
    tests = words.counted(found.data.sizes["test"], "test")
    p_base = words.p_value(misfit["p_base"]).replace(" ", digits.NO_BREAK)
    return (
        f"Over {tests}, with start phases, amplitudes and uncertain numbers fitted, the base model leaves a "
        f"misfit of Q = {digits.number(misfit['chi2_base'])} on {misfit['dof']} degrees of freedom; noise "
        f"alone leaves about {misfit['dof']} ({p_base}). That is an "
        f"error of {words.times_noise(misfit['chi2_base'], misfit['dof'])}."
    )


def _worst(found: Diagnosed) -> str:
    tests = found.document["misfit"]["tests"]
    worst = max(tests, key=lambda test: _ratio(test, "base"))
    least = min(tests, key=lambda test: _ratio(test, "base"))
    return f"The base model is worst in {_told(worst)} and best in {_told(least)}; noise alone leaves 1."


def _told(test: dict[str, Any]) -> str:
    ratio = digits.number(_ratio(test, "base"))
    return f"{test['name']} ({digits.short(test['frequency_hz'])} Hz, Q/dof {ratio})"


def _tests(found: Diagnosed) -> Markup:
    both = len(found.models) > 1
    head = ["test", "frequency [Hz]", "amplitude [mm]", "as fitted [mm]", "periods", "noise x − y [mm]"]
    head += ["noise x′ − y′ [mm/s]", "Q/dof base", *(["Q/dof extended"] if both else [])]
    rows = [_row(test, both) for test in found.document["misfit"]["tests"]]
    return html.details("Table of all tests", html.table("All tests and what is left of them", head, rows))


def _row(test: dict[str, Any], both: bool) -> list[str]:
    keys = ("frequency_hz", "amplitude_mm", "amplitude_fitted_mm", "periods", "noise_displacement_mm")
    numbers = [digits.short(test[key]) for key in (*keys, "noise_velocity_mm_per_s")]
    ratios = [digits.number(_ratio(test, model)) for model in ("base", "extended")[: 1 + both]]
    return [test["name"], *numbers, *ratios]


def _selected(found: Diagnosed) -> str:
    count = found.data.sizes["test"]
    if count <= SHOWN:
        return "The tests, the one with the largest misfit first."
    return f"The {SHOWN} of {count} tests with the largest misfit; the others are folded below."


def _rest(found: Diagnosed, draw: Pictures, tests: Sequence[int]) -> Markup:
    if not tests:
        return Markup()
    summary = f"The other {words.counted(len(tests), 'test')}"
    return html.details(
        summary, *(draw(kind, f"{DESCRIPTIONS[kind].capitalize()}.", tests) for kind in SIGNALS)
    )


def _plateaus(found: Diagnosed) -> str:
    measured = found.data["measured_plateau"].values
    if not np.isfinite(measured).any():
        return "No test gives the share of the period near rest."
    test = int(np.nanargmax(measured))
    simulated = found.data["simulated_plateau"].sel(model="base").values[test]
    return (
        f"The longest measured plateau is {digits.percent(measured[test])} of the period, in "
        f"{found.data['test'].values[test]}; there the base model has {digits.percent(simulated)}. "
        "A sine has 3 %."
    )


def _energy(found: Diagnosed) -> str:
    ratio = found.data["simulated_energy"].sel(model="base") / found.data["measured_energy"]
    known = ratio.values[np.isfinite(ratio.values)]
    if not known.size:
        return "No test tells the energy: that takes a known input of the side frame itself."
    low, high = (digits.number(each) for each in (known.min(), known.max()))
    return f"The base model takes {low} to {high} times the energy that was measured."
