"""Equations in the page, with a list of their symbols."""

from types import ModuleType

from wedgesweep import equations
from wedgesweep.effects import EFFECTS, REGISTERED
from wedgesweep.equations import notation
from wedgesweep.equations.symbols import Meaning
from wedgesweep.friction import LAWS
from wedgesweep.friction.quantities import FRICTION
from wedgesweep.quantity import Quantity
from wedgesweep.report import html
from wedgesweep.report.html import Markup
from wedgesweep.systems import SYSTEMS

A_RATE = "A prime (′) is a rate of change."


def of_effect(name: str, system: str) -> Markup:
    """Equations of an effect; nothing for one that this version does not know."""
    return _set(REGISTERED[name], EFFECTS[name].quantities, system) if name in REGISTERED else Markup()


def of_law(name: str, system: str) -> Markup:
    """Equations of a friction law; nothing for one that this version does not know."""
    return _set(LAWS[name], FRICTION, system) if name in LAWS else Markup()


def of_system(name: str) -> Markup:
    """Equations of motion of a base model."""
    return _set(SYSTEMS[name], (), name)


def _set(module: ModuleType, quantities: tuple[Quantity, ...], system: str) -> Markup:
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
