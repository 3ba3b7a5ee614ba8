"""An oscillator that turns: the same equations, with angles for lengths and torques for forces.

Inside of the package an angle of 1 rad is a length of 1 m, a torque of 1 N m a force of 1 N, an inertia of
1 kg m^2 a mass of 1 kg. Files, figures and reports have the keys and units of a rotation: this module renames
and scales them.
"""

import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import xarray as xr

TRANSLATION, ROTATION = MOTIONS = ("translation", "rotation")
# Keys with names of their own in a rotation.
KEYS = {"mass_kg": "inertia_kg_m2", "normal_force_N": "friction_N_m"}
# Endings of keys in a translation and in a rotation, and the number of the latter over that of the former.
ENDINGS = {
    "_N_per_mm3": ("_N_m_per_rad3", 1e9),
    "_N_per_mm": ("_N_m_per_rad", 1e3),
    "_N_s2_per_m2": ("_N_m_s2_per_rad2", 1.0),
    "_N_s_per_m": ("_N_m_s_per_rad", 1.0),
    "_m_per_s2": ("_rad_per_s2", 1.0),
    "_mm_per_s": ("_rad_per_s", 1e-3),
    "_kg": ("_kg_m2", 1.0),
    "_mm": ("_rad", 1e-3),
    "_N": ("_N_m", 1.0),
}
LENGTH = "_mm"
# Key of a distribution that has no unit: the standard deviation of a logarithm.
RELATIVE = "sigma"
# Units in texts, and what a rotation has in their place.
UNITS = {
    **{"mm/s": "mrad/s", "mm": "mrad", "µm": "µrad", "m/s²": "rad/s²", "m/s^2": "rad/s^2", "m/s": "rad/s"},
    **{"m or m/s": "rad or rad/s", "m, m/s or m/s^2": "rad, rad/s or rad/s^2"},
    **{"m s-1": "rad s-1", "m s-2": "rad s-2", "m": "rad", "N s": "N m s", "N": "N m"},
    **{"N/m": "N m/rad", "N s/m": "N m s/rad", "N s²/m²": "N m s²/rad²", "kg": "kg m²"},
}
# Words of quantities, and what a rotation has in their place.
WORDS = {
    **{"a displacement": "an angle", "displacement": "angle", "Displacement": "Angle"},
    **{"force": "torque", "Force": "Torque", "forces": "torques", "Forces": "Torques"},
}
_WORD = re.compile(rf"(?<![\w.-])(?:{'|'.join(sorted(WORDS, key=len)[::-1])})(?![\w-]|\.\w)")
_KEY = re.compile(rf"\b(?:{'|'.join([*KEYS, *(rf'[a-z_]+{ending}' for ending in ENDINGS)])})\b")
# Units of keys of a rotation, as CF writes them; they and those above stay what they are.
_OWN = ("kg m2", "N m rad-1", "N m s rad-1", "N m s2 rad-2", "N m rad-3", *UNITS.values())
_UNITS = "|".join(sorted(map(re.escape, (*UNITS, *_OWN)), key=len)[::-1])
_UNIT = re.compile(rf"(?<=[\[\d ])(?:{_UNITS})(?=[\],;. ]|$)")
_UNIT_OF_SYMBOL = re.compile(rf"(?<=\()(?:{_UNITS})(?=\))")


def turns(document: Mapping[str, Any]) -> bool:
    """Whether a config is one of an oscillator that turns."""
    own = document.get("oscillator")
    return isinstance(own, Mapping) and own.get("motion") == ROTATION


def turned_key(key: str) -> tuple[str, float]:
    """Key of a rotation, and its number over that of a translation."""
    if key in KEYS:
        return KEYS[key], 1.0
    for ending, (other, factor) in ENDINGS.items():
        if key.endswith(ending):
            return key.removesuffix(ending) + other, factor
    return key, 1.0


def turned_path(key: str) -> tuple[str, float]:
    """A dotted key in a rotation, and its number over that of a translation."""
    table, dot, name = key.rpartition(".")
    name, factor = turned_key(name)
    return f"{table}{dot}{name}", factor


def written(document: Any) -> Any:
    """A document of a translation with the keys and numbers of a rotation; texts name its keys, too."""
    if isinstance(document, list):
        return [written(value) for value in document]
    if isinstance(document, str):
        return text(document)
    if not isinstance(document, Mapping):
        return document
    turned = {}
    for key, value in document.items():
        renamed, factor = turned_path(key)
        turned[renamed] = scaled(value, factor) if renamed != key else written(value)
    return turned


def scaled(value: Any, factor: float) -> Any:
    """Numbers times a factor, to the 15 digits that come back when they are divided by it."""
    if isinstance(value, list):
        return [scaled(each, factor) for each in value]
    if isinstance(value, Mapping):
        return {key: each if key == RELATIVE else scaled(each, factor) for key, each in value.items()}
    if factor == 1.0 or isinstance(value, bool) or not isinstance(value, int | float):
        return value
    return float(f"{value * factor:.15g}")


def text(words: str) -> str:
    """A text with the keys of a rotation."""
    return _KEY.sub(lambda match: turned_key(match.group())[0], words)


def in_units(words: str) -> str:
    """A text in the units of a rotation."""
    if words in UNITS:
        return UNITS[words]
    return _UNIT.sub(lambda match: UNITS.get(match.group(), match.group()), words)


def prose(words: str) -> str:
    """A text of a report or a figure in the words of a rotation; names of files and keys stay as they are.

    A unit by itself in brackets, as the meaning of a symbol has it, is that of a rotation, too.
    """
    turned = _WORD.sub(lambda match: WORDS[match.group()], words)
    return _UNIT_OF_SYMBOL.sub(lambda match: UNITS.get(match.group(), match.group()), turned)


def with_units(dataset: "xr.Dataset") -> "xr.Dataset":
    """A dataset of a translation with the units of a rotation, in place."""
    for values in dataset.variables.values():
        if (si := values.attrs.get("units")) in UNITS:
            values.attrs["units"] = UNITS[si]
    return dataset
