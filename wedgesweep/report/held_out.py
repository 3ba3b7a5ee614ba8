"""Before and after on tests that were held out of the fit."""

from typing import Any

from wedgesweep import digits
from wedgesweep.diagnosed import Diagnosed
from wedgesweep.report import html, words
from wedgesweep.report.html import Markup
from wedgesweep.report.pictures import Pictures

HEAD = ("test", "left out with", "error before", "error after", "noise floor")


def section(found: Diagnosed, draw: Pictures) -> Markup:
    """Section with the gain and its interval."""
    gain = found.gain
    if gain is None:
        content: tuple[Markup, ...] = (html.paragraph(_why_not(found)),)
    else:
        rows = [_row(found, each) for each in gain["held_out"]]
        content = (
            html.paragraph(_summary(found, gain)),
            draw(
                "gain",
                "Each test predicted by models that were fitted to the others. Errors in units of the noise.",
            ),
            html.details("Table of the held-out tests", html.table("Held-out tests", HEAD, rows, 2)),
        )
    return html.section("gain", "Before and after, on held-out tests", *content)


def _why_not(found: Diagnosed) -> str:
    if not found.added:
        return "Nothing was added to the model, so there is no gain to measure."
    return "There are too few tests to hold one out."


def _summary(found: Diagnosed, gain: dict[str, Any]) -> str:
    interval = (
        f"{words.INTERVAL} {digits.percent(gain['ci95'][0])} to {digits.percent(gain['ci95'][1])}"
        if gain["ci95"]
        else "too few tests for an interval"
    )
    before, after, floor = (digits.number(gain[f"rmse_{kind}"]) for kind in ("base", "extended", "noise"))
    claim = "" if found.document["causes"] else " This is the best attempt only; the verdict names no cause."
    return (
        f"Scheme: {gain['scheme']}. The error goes from {before} to {after} times the noise, with {floor} as "
        f"floor: a gain of {digits.percent(gain['gain'])}, and {digits.percent(gain['excess_removed'])} of "
        f"the excess over noise is removed ({interval}).{claim}"
    )


def _row(found: Diagnosed, each: dict[str, Any]) -> list[str]:
    errors = [digits.number(each[f"rmse_{kind}"]) for kind in ("base", "extended", "noise")]
    return [str(found.data["test"].values[found.place(each["test"])]), f"its {each['scheme']}", *errors]
