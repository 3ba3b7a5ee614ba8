"""The extended model: equations and numbers of what was added to the base model."""

from importlib import import_module
from importlib.util import find_spec
from inspect import cleandoc
from typing import Any

from wedgesweep import digits
from wedgesweep.diagnosed import Diagnosed
from wedgesweep.effects import EFFECTS
from wedgesweep.friction.names import LAW_NAMES
from wedgesweep.report import html, words
from wedgesweep.report.html import Markup

HEAD = ("number", "value", "95 % interval")


def section(found: Diagnosed) -> Markup:
    """Section with equations, numbers and where the config is."""
    model = found.document["model"]
    return html.section(
        "model",
        "The extended model",
        html.paragraph(_introduction(found)),
        *(_effect(found, effect) for effect in found.added),
        _uncertain(found),
        html.details(f"The base model's friction law: {model['law']}", _law(model["law"])),
    )


def _introduction(found: Diagnosed) -> Markup:
    base = found.document["model"]
    start = f"The model on trial, “{base['title']}” with {base['law']} friction, "
    if not found.added:
        return html.text(f"{start}stays as it is.")
    link = html.element("a", "extended.toml", href="extended.toml")
    command = html.element("code", "wedgesweep run extended.toml -o extended.nc")
    what = f"{start}with {words.together(found.added)} added. "
    if not found.document["causes"]:
        what = (
            f"{start}has no extension that can be trusted. The best attempt, {words.together(found.added)}: "
        )
    return html.join([what, link, " holds it, ready to run: ", command, "."], "")


def _effect(found: Diagnosed, effect: str) -> Markup:
    equation = explained(f"wedgesweep.effects.{effect}")
    return html.join(
        [
            html.element("h3", f"{effect}: {words.meaning(effect)}"),
            html.element("pre", equation) if equation else Markup(),
            html.table(f"Numbers of {effect}", HEAD, [_row(*each) for each in _numbers(found, effect)]),
            html.paragraph(_place(found, effect)),
        ]
    )


def explained(module: str) -> str:
    """The equation of an effect or a law, which its module's docstring holds; empty for an unknown one."""
    return cleandoc(import_module(module).__doc__ or "") if find_spec(module) else ""


def _place(found: Diagnosed, effect: str) -> str:
    """Family of an effect, and which of the two models, the bench or the simulation, is to be mended."""
    for cause in found.document["causes"]:
        if cause["effect"] == effect:
            return f"Family: {cause['family']}; branch: {cause['branch']}."
    return f"Family: {EFFECTS[effect].family}." if effect in EFFECTS else ""


def _numbers(found: Diagnosed, effect: str) -> list[tuple[str, dict[str, Any]]]:
    """Keys and fitted numbers of an effect, of the causes or of the best attempt."""
    for cause in found.document["causes"]:
        if cause["effect"] == effect:
            return list(cause["parameters"].items())
    for each in found.document["candidates"]:
        if tuple(each["effects"]) == found.added:
            mine = [(key.split(".", 1), value) for key, value in each["parameters"].items()]
            return [(key, value) for (name, key), value in mine if name == effect]
    return []


def _row(key: str, found: dict[str, Any]) -> list[str]:
    name, unit = words.split_key(key)
    value, low, high = words.spread(found) or (digits.number(found["value"]), "", "")
    return [name, words.with_unit(value, unit), f"{low} to {high}" if low else digits.NONE]


def _uncertain(found: Diagnosed) -> Markup:
    """Numbers of the model that were only known to some spread, as the fit leaves them."""
    rows = [
        [name, digits.number(each["scale"], 4), digits.number(each["std"], 2)]
        for name, each in found.document.get("uncertain", {}).items()
    ]
    if not rows:
        return Markup()
    return html.table("Uncertain numbers of the model, as fitted", ("scale of", "value", "std"), rows)


def _law(law: str) -> Markup:
    if law not in LAW_NAMES:
        return html.paragraph("This version does not know that law.")
    return html.element("pre", explained(f"wedgesweep.friction.{law.replace('-', '_')}"))
