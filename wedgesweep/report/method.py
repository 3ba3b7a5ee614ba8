"""How it was done: the method in short, versions, degrees of freedom and penalties."""

from wedgesweep import digits
from wedgesweep.diagnosed import Diagnosed
from wedgesweep.report import html, words
from wedgesweep.report.html import Markup

STEPS = (
    "A forced response repeats each period, noise does not: least squares give the harmonics of each test "
    "and, from what does not repeat, their noise (Pintelon and Schoukens 2012).",
    "Q is the squared distance of measured and simulated harmonics over that noise, which is chi-squared "
    "for a right model. Start phase, amplitude and uncertain numbers are fitted first, for the base model "
    "too.",
    "Every candidate is fitted alone, then pairs of them; each fitted number costs a penalty. A cause must "
    "leave nothing but noise, with numbers that are the same in all tests (a Lagrange multiplier test), and "
    "lead its rivals by more than the tie width. To be named it must be the only one that leaves noise only; "
    "a pair that many imitate is not reported.",
    "The gain counts on held-out tests only: each frequency, then each amplitude, is left out of the fit and "
    "predicted.",
)


def section(found: Diagnosed) -> Markup:
    """Section for who wants to check or repeat it."""
    return html.section(
        "method",
        "How it was done",
        html.items(STEPS),
        html.table("Settings", ("setting", "value"), _settings(found)),
    )


def _settings(found: Diagnosed) -> list[list[str]]:
    method, misfit = found.document["method"], found.document["misfit"]
    rows = [
        ["degrees of freedom, base model", str(misfit["dof"])],
        ["harmonics of each channel", str(method["harmonics"])],
        ["channels", words.listing([str(name) for name in found.data["channel"].values])],
        ["penalty per fitted number", digits.number(method["penalty_per_parameter"])],
        ["tie width", digits.number(method.get("gap"))],
        ["excess needed to name a cause", digits.number(method.get("strong_excess"))],
        ["thresholds", "calibrated on these tests" if method.get("calibrated") else "general ones"],
        ["friction law", found.document["model"]["law"]],
        ["wedgesweep", found.document["version"]],
        ["made", found.document["created"]],
    ]
    return [row for row in rows if row[1] != digits.NONE]
