"""The extended model: equations and parameters of what was added to the base model."""

from types import ModuleType
from typing import Any

from wedgesweep import equations, formatting
from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.effects import EFFECTS, REGISTERED
from wedgesweep.equations import notation
from wedgesweep.equations.symbols import Meaning
from wedgesweep.friction import LAWS
from wedgesweep.friction.quantities import FRICTION
from wedgesweep.quantity import Quantity
from wedgesweep.report import html, phrases
from wedgesweep.report.html import Markup
from wedgesweep.systems import SYSTEMS

A_RATE = "A prime (′) is a rate of change."
HEAD = ("parameter", "value", "95 % interval")


def section(result: DiagnosisResult) -> Markup:
    """Section with the equations, the parameters and a link to the config."""
    law, system = result.document["model"]["law"], phrases.system(result.document)
    return html.section(
        "model",
        "The extended model",
        *_introduction(result),
        *(_effect(result, effect) for effect in result.added),
        _uncertain(result),
        html.details(
            "Equations of the base model",
            _of_system(system),
            html.paragraph(f"Friction law: {law}."),
            _of_law(law, system),
        ),
    )


def _introduction(result: DiagnosisResult) -> list[Markup]:
    model = result.document["model"]
    base = f"“{model['title']}” with {model['law']} friction"
    if not result.added:
        return [html.paragraph(f"The base model, {base}, stays as it is.")]
    added = phrases.combination(result.added)
    what = f"The extended model adds {added} to the base model, {base}."
    if not result.document["causes"]:
        what = f"No extension of the base model, {base}, can be trusted. The best attempt adds {added}."
    link = html.element("a", "extended.toml", href="extended.toml")
    command = html.element("pre", "wedgesweep run extended.toml -o extended.nc")
    return [html.paragraph(what, " It is in ", link, ", ready to run:"), command]


def _effect(result: DiagnosisResult, effect: str) -> Markup:
    rows = [_row(*each) for each in _parameters(result, effect)]
    return html.join(
        [
            html.element("h3", f"{effect}: {phrases.meaning(effect, result.document)}"),
            _of_effect(effect, phrases.system(result.document)),
            html.table(f"Parameters of {effect}", HEAD, rows),
            html.paragraph(_place(result, effect)),
        ]
    )


def _place(result: DiagnosisResult, effect: str) -> str:
    """Family of an effect, and which of the two is to be corrected, the bench or the simulation."""
    for cause in result.document["causes"]:
        if cause["effect"] == effect:
            return f"Family: {cause['family']}; branch: {cause['branch']}."
    return f"Family: {EFFECTS[effect].family}." if effect in EFFECTS else ""


def _parameters(result: DiagnosisResult, effect: str) -> list[tuple[str, dict[str, Any]]]:
    """Keys and fitted values of an effect, as a cause or in the best attempt."""
    for cause in result.document["causes"]:
        if cause["effect"] == effect:
            return list(cause["parameters"].items())
    for each in result.document["candidates"]:
        if tuple(each["effects"]) == result.added:
            mine = [(key.split(".", 1), value) for key, value in each["parameters"].items()]
            return [(key, value) for (name, key), value in mine if name == effect]
    return []


def _row(key: str, fitted: dict[str, Any]) -> list[str]:
    name, unit = phrases.split_key(key)
    value, low, high = phrases.rounded(fitted)
    interval = f"{low} to {high}" if low else formatting.NONE
    if "searched" in fitted:
        searched = " to ".join(map(formatting.number, fitted["searched"]))
        interval += f"; outside of the searched range, {searched}"
    return [name, phrases.with_unit(value, unit), interval]


def _uncertain(result: DiagnosisResult) -> Markup:
    """Parameters that the measurement declares uncertain, as the fit leaves them."""
    rows = [row for name, each in result.document.get("uncertain", {}).items() for row in _fitted(name, each)]
    if not rows:
        return Markup()
    return html.table("Uncertain parameters of the model, as fitted", ("", "value", "std"), rows)


def _fitted(name: str, numbers: dict[str, float]) -> list[list[str]]:
    """Rows of an effect: its scale, or its harmonics of the input."""
    if "scale" in numbers:
        labelled = {f"scale of {name}": (numbers["scale"], numbers["std"])}
    else:
        labelled = {
            quantity.meaning: (numbers[quantity.key], numbers[f"{quantity.key}_std"])
            for quantity in EFFECTS[name].quantities
            if f"{quantity.key}_std" in numbers
        }
    return [
        [label, formatting.number(value, 4), formatting.number(std, 2)]
        for label, (value, std) in labelled.items()
    ]


def _of_effect(name: str, system: str) -> Markup:
    """Equations of an effect; nothing for one that this version does not know."""
    return _equations(REGISTERED[name], EFFECTS[name].quantities, system) if name in REGISTERED else Markup()


def _of_law(name: str, system: str) -> Markup:
    """Equations of a friction law; nothing for one that this version does not know."""
    return _equations(LAWS[name], FRICTION, system) if name in LAWS else Markup()


def _of_system(name: str) -> Markup:
    """Equations of motion of a base model."""
    return _equations(SYSTEMS[name], (), name)


def _equations(module: ModuleType, quantities: tuple[Quantity, ...], system: str) -> Markup:
    stated = equations.of(module, quantities, system)
    if not stated.lines:
        return Markup()
    lines = [Markup(notation.display(line)) for line in stated.lines]
    parts = [
        html.element("div", *lines, class_="equations", tabindex=0, role="region", aria_label="Equations")
    ]
    if stated.remark:
        parts.append(html.paragraph(Markup(notation.prose(stated.remark))))
    rates = A_RATE if any("'" in line for line in stated.lines) else ""
    parts.append(html.details("What the symbols mean", _symbols(stated.meanings), html.paragraph(rates)))
    return html.join(parts)


def _symbols(meanings: dict[str, Meaning]) -> Markup:
    rows = [
        (html.element("dt", Markup(notation.symbol(name))), html.element("dd", _explained(meaning)))
        for name, meaning in meanings.items()
    ]
    return html.element("dl", *(part for row in rows for part in row))


def _explained(meaning: Meaning) -> str:
    return f"{meaning.text} ({meaning.unit})" if meaning.unit else meaning.text
