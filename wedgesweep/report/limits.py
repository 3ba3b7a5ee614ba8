"""What these tests could have shown, and what they cannot."""

from wedgesweep import formatting
from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.effects import EFFECTS
from wedgesweep.report import html, phrases
from wedgesweep.report.html import Markup

CAPTION = "Weakest effect that these tests would have shown"


def section(result: DiagnosisResult) -> Markup:
    """Section on the detection limits of the tests."""
    rows = [
        [effect, name, phrases.with_unit(_weakest(name, value), unit)]
        for effect, weakest in result.document["detectable"].items()
        for (name, unit), value in [(phrases.split_key(key), value) for key, value in weakest.items()]
    ]
    table = html.table(CAPTION, ("effect", "parameter", "weakest value"), rows, 2)
    return html.section(
        "limits",
        "What these tests can show",
        table if rows else html.paragraph("These tests would not have shown any effect."),
        html.paragraph(_hidden(result.document["not_testable"])),
        _excluded(result),
    )


def _excluded(result: DiagnosisResult) -> Markup:
    """Effects of the system that were no candidates, and why."""
    system = phrases.system(result.document)
    excluded = result.document.get("excluded", {}).items()
    rows = [(name, why) for name, why in excluded if name in EFFECTS and system in EFFECTS[name].systems]
    if not rows:
        return Markup()
    return html.details(
        "Effects that were no candidates", html.table("No candidates", ("effect", "it"), rows, 2)
    )


def _weakest(name: str, value: float | None) -> str:
    """Two digits of a value, or of its distance from 1 if it is a factor."""
    if name != "scale" or value is None or value == 1.0:
        return formatting.short(value, 2)
    return formatting.fixed(value, formatting.decimals(value - 1.0, 2))


def _hidden(effects: list[str]) -> str:
    if not effects:
        return "These tests can show every candidate."
    one = len(effects) == 1
    return (
        f"Not testable: {phrases.listing(effects)}. These tests do not show what {'it' if one else 'they'} "
        "would change, or start phases, amplitudes and uncertain parameters can imitate it; the verdict says "
        f"nothing about {'it' if one else 'them'}."
    )
