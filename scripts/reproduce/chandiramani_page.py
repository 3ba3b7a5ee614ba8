"""The report on Chandiramani's experiment, from ``chandiramani.document``."""

from collections.abc import Iterable, Sequence
from typing import Any

from reproduce.writing import number, table

PICTURE = "chandiramani.png"
TITLE = "Chandiramani's experiment: which change of the model explains the observations?"
NOTE = (
    "Each hypothesis at its best point, law, column angle and interpretation of the inputs. A number says "
    "how many tolerances an observation is missed by; - means that nothing of it is there. Responses with a "
    "negative normal force, where a real wedge would lift off, are rejected, as are recordings whose "
    "periods differ."
)


def render(content: dict[str, Any]) -> str:
    """Markdown of the whole report."""
    sections = (
        f"# {TITLE}",
        answer(content),
        _observations(content),
        f"![Peak-to-peak over frequency of each hypothesis at its best]({PICTURE})",
        "## The hypotheses at their best",
        _best(content["hypotheses"]),
        "## Observations satisfied by law, column angle and interpretation of the inputs",
        _by_choice(content["scenarios"]),
        "## What to measure next",
        _next(content),
        "## Criteria of the observations",
        "\n".join(f"- {each['description']}: {each['criterion']}." for each in content["observations"]),
    )
    return "\n\n".join(sections) + "\n"


def summary(content: dict[str, Any]) -> str:
    """Markdown of a section of another report beside this one."""
    link = "See [chandiramani.md](chandiramani.md)."
    return f"## {TITLE}\n\n{answer(content)} {link}\n\n{_observations(content)}"


def answer(content: dict[str, Any]) -> str:
    """Which hypotheses explain all observations, in a sentence or two."""
    total, most = len(content["observations"]), max(each["satisfied"] for each in content["hypotheses"])
    best = [each["description"] for each in content["hypotheses"] if each["satisfied"] == most]
    if most == total:
        return f"All {total} observations are explained by {' and by '.join(best)} only."
    return f"No hypothesis explains all {total} observations. {most} are satisfied by {', '.join(best)}."


def _observations(content: dict[str, Any]) -> str:
    """Table of hypotheses and observations: yes, or by how many tolerances it is missed."""
    names = [each["name"] for each in content["observations"]]
    head = ("hypothesis", *(each["description"] for each in content["observations"]), "satisfied")
    rows = (
        (each["description"], *(_cell(each["distances"][name]) for name in names), f"**{each['satisfied']}**")
        for each in content["hypotheses"]
    )
    return f"{table(head, rows)}\n\n{NOTE}"


def _cell(distance: float | None) -> str:
    if distance is None:
        return "-"
    return "**yes**" if distance <= 1.0 else f"{distance:.2g}"


def _best(hypotheses: Sequence[dict[str, Any]]) -> str:
    rows = (
        (
            each["description"],
            each["law"],
            f"{each['column_angle_deg']:+g}",
            each["interpretation"],
            ", ".join(f"{name} {number(value)}" for name, value in each["values"].items()),
            _numbers(each["slow"], "peak_to_peak", "plateau"),
            _numbers(each["fast"], "peak_to_peak", "plateau", "distortion"),
        )
        for each in hypotheses
    )
    head = (
        *("hypothesis", "law", "column angle (deg)", "inputs", "parameters"),
        "20 Hz: peak-to-peak (mm), plateau",
        "30 Hz: peak-to-peak (mm), plateau, distortion",
    )
    return table(head, rows)


def _numbers(recording: dict[str, float | None], *names: str) -> str:
    return ", ".join(number(recording[name]) for name in names)


def _by_choice(scenarios: Sequence[dict[str, Any]]) -> str:
    """Most observations that each hypothesis satisfies with each choice."""
    names = dict.fromkeys(each["hypothesis"] for each in scenarios)
    rows = ((name, *_most([each for each in scenarios if each["hypothesis"] == name])) for name in names)
    return table(("hypothesis", "by law", "by column angle", "by interpretation of the inputs"), rows)


def _most(scenarios: Sequence[dict[str, Any]]) -> Iterable[str]:
    for key in ("law", "column_angle_deg", "interpretation"):
        most: dict[Any, int] = {}
        for each in scenarios:
            most[each[key]] = max(most.get(each[key], 0), each["satisfied"])
        yield ", ".join(f"{choice} {count}" for choice, count in most.items())


def _next(content: dict[str, Any]) -> str:
    test, rivals = content["next_test"], content["rivals"]
    names = {each["hypothesis"]: each["description"] for each in content["hypotheses"]}
    inputs = "; ".join(
        f"{each['description']} needs {number(each['values']['amplitude_20_hz_mm'])} mm at 20 Hz"
        for each in content["hypotheses"]
        if each["hypothesis"] in rivals
    )
    rows = (
        (
            " and ".join(names[name] for name in pair["hypotheses"]),
            number(pair["hertz"]),
            number(1e3 * pair["amplitude"]),
            number(pair["distance"]),
        )
        for pair in content["pairs"]
    )
    text = (
        f"The most important unknown is the input amplitude: {inputs}. With the input known, one recording "
        f"at {number(test['hertz'])} Hz and {number(1e3 * test['amplitude'])} mm separates each two of these "
        f"hypotheses by at least {number(test['distance'])} noise units (4 % of the motion on each harmonic, "
        "start phase free), whichever of their equally good points is true."
    )
    return f"{text}\n\n{table(('hypotheses', 'best test: Hz', 'mm', 'noise units'), rows)}"
