"""The readable page on Chandiramani's experiment, from ``chandiramani.document``."""

from collections.abc import Iterable, Sequence
from typing import Any

from wedgesweep.reproduce.page import number, table

PICTURE = "chandiramani.png"
TITLE = "Chandiramani's experiment: which change of the model brings what was observed?"


def render(content: dict[str, Any]) -> str:
    """Markdown of the section as a page of its own."""
    sections = (
        f"# {TITLE}",
        answer(content),
        observed(content),
        f"![Peak-to-peak over frequency of each suspect at its best]({PICTURE})",
        "## The suspects at their best",
        _best(content["suspects"]),
        "## What each law, lean and reading of the inputs reaches",
        _reached(content["questions"]),
        "## What to measure next",
        _next(content),
        "## What counts as seen",
        "\n".join(f"- {each['words']}: {each['criterion']}." for each in content["observations"]),
    )
    return "\n\n".join(sections) + "\n"


def summary(content: dict[str, Any]) -> str:
    """Markdown of the section within another page, which has the details beside it."""
    return f"## {TITLE}\n\n{answer(content)} See [chandiramani.md](chandiramani.md).\n\n{observed(content)}"


def answer(content: dict[str, Any]) -> str:
    """Which suspects reproduce all that was observed, in a sentence or two."""
    total, suspects = len(content["observations"]), content["suspects"]
    words = {each["suspect"]: each["words"] for each in suspects}
    survivors = [words[name] for name in content["survivors"]]
    most = max(each["met"] for each in suspects)
    closest = [each["words"] for each in suspects if each["met"] == most]
    if survivors:
        return (
            f"All {total} observations are reproduced by {' and by '.join(survivors)}; "
            "the search found no other change that does."
        )
    return (
        f"The search found no single change that reproduces all {total} observations. "
        f"The most, {most}: {', '.join(closest)}."
    )


def observed(content: dict[str, Any]) -> str:
    """Table of suspects and observations: yes, or by how many tolerances it is missed."""
    names = [each["name"] for each in content["observations"]]
    head = ("suspect", *(each["words"] for each in content["observations"]), "met")
    rows = (
        (each["words"], *(_cell(each["distances"][name]) for name in names), f"**{each['met']}**")
        for each in content["suspects"]
    )
    note = (
        "Each suspect at its best point, law, lean and reading of the inputs. A number tells how many "
        "tolerances an observation is missed by; - that there is nothing of it at all. Responses with a "
        "negative normal force, where a real wedge would lift off, count for nothing, nor do recordings in "
        "which one period is not like the next."
    )
    return f"{table(head, rows)}\n\n{note}"


def _cell(distance: float | None) -> str:
    if distance is None:
        return "-"
    return "**yes**" if distance <= 1.0 else f"{distance:.2g}"


def _best(suspects: Sequence[dict[str, Any]]) -> str:
    rows = (
        (
            each["words"],
            each["law"],
            f"{each['column_angle_deg']:+g}",
            each["reading"],
            _values(each["values"]),
            f"{number(each['slow']['peak_to_peak'])}, {number(each['slow']['plateau'])}",
            f"{number(each['fast']['peak_to_peak'])}, {number(each['fast']['plateau'])}, "
            f"{number(each['fast']['distortion'])}",
        )
        for each in suspects
    )
    head = (
        "suspect",
        "law",
        "lean (deg)",
        "inputs",
        "numbers",
        "20 Hz: peak-to-peak (mm), plateau",
        "30 Hz: peak-to-peak (mm), plateau, distortion",
    )
    return table(head, rows)


def _values(values: dict[str, float]) -> str:
    return ", ".join(f"{name} {number(value)}" for name, value in values.items())


def _reached(questions: Sequence[dict[str, Any]]) -> str:
    """Most observations met by each suspect, by what was left open."""
    suspects = list(dict.fromkeys(each["suspect"] for each in questions))
    rows = ((name, *_most([each for each in questions if each["suspect"] == name])) for name in suspects)
    return table(("suspect", "by law", "by lean", "by reading of the inputs"), rows)


def _most(questions: Sequence[dict[str, Any]]) -> Iterable[str]:
    for key in ("law", "column_angle_deg", "reading"):
        values = dict.fromkeys(each[key] for each in questions)
        yield ", ".join(
            f"{value} {max(each['met'] for each in questions if each[key] == value)}" for value in values
        )


def _next(content: dict[str, Any]) -> str:
    test = content["next_test"]
    names = {each["suspect"]: each["words"] for each in content["suspects"]}
    rivals = [each for each in content["suspects"] if each["suspect"] in content["rivals"]]
    inputs = "; ".join(
        f"{each['words']} needs {number(each['values']['amplitude_20_hz_mm'])} mm at 20 Hz" for each in rivals
    )
    rows = (
        (
            " and ".join(names[name] for name in pair["suspects"]),
            number(pair["hertz"]),
            number(1e3 * pair["amplitude"]),
            number(pair["distance"]),
        )
        for pair in content["pairs"]
    )
    place = f"{number(test['hertz'])} Hz and {number(1e3 * test['amplitude'])} mm"
    told = (
        f"The input, first of all: {inputs}. With the input known, one recording at {place} puts each two of "
        f"these at least {number(test['distance'])} noise units apart (4 % of the motion on each harmonic, "
        "start phase free, whichever of the points that fit as well is true)."
    )
    return f"{told}\n\n{table(('suspects', 'best test: Hz', 'mm', 'noise units'), rows)}"
