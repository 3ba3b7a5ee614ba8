"""What parameter records of all systems have in common: friction, input, and a part for each effect."""

from collections.abc import Iterable, Mapping, Sequence
from functools import cache

import numpy as np

from wedgesweep import effects as known
from wedgesweep import excitation
from wedgesweep import friction as laws
from wedgesweep.effects import Numbers
from wedgesweep.friction.quantities import FRICTION, SYMBOLS

# Parts of a record type.
COMMON: list[tuple] = [
    (
        "friction",
        [
            ("law", np.int64),
            ("set_valued", np.int64),
            *((name, np.float64) for name in SYMBOLS.values()),
        ],
    ),
    ("input", [("amplitude", np.float64), ("omega", np.float64)]),
]
SERIES: list[tuple] = [("series", excitation.SERIES_FIELDS)]


def effect_parts(names: Iterable[str]) -> list[tuple]:
    """Parts of a record type for effects; effects that adjust other parts have none of their own."""
    parts: list[tuple] = []
    for name in names:
        module = known.REGISTERED[name]
        if not hasattr(module, "adjust"):
            numbers = [quantity.name for quantity in known.EFFECTS[name].quantities]
            numbers += getattr(module, "DERIVED", ())
            more = getattr(module, "FIELDS", ())
            parts.append((name, [*((each, np.float64) for each in numbers), *more]))
    return parts


def blank(kind: np.dtype, names: Iterable[str]) -> np.ndarray:
    """A full record, shape (1,), with a sine as input and these effects off."""
    # numpy copies records part by part, and bytes at once.
    return np.frombuffer(bytearray(_blank(kind, tuple(names))), kind)


@cache
def _blank(kind: np.dtype, names: tuple[str, ...]) -> bytes:
    case = np.zeros(1, kind)
    excitation.set_series(case, excitation.SINE)
    for name in set(names) & set(kind.names or ()):
        for number, value in known.EFFECTS[name].off.items():
            case[name][number] = value
    return case.tobytes()


def set_common(case: np.ndarray, law: str, friction: Mapping[str, float], given: tuple[float, float]) -> None:
    """Put the law, its numbers (SI by name) and the input into a full record, shape (1,), in place.

    ``given``: amplitude (m or N) and angular frequency (rad/s).
    """
    p = case[0]
    for quantity in FRICTION:
        value = friction.get(quantity.name, quantity.default * quantity.factor)
        p["friction"][SYMBOLS[quantity.name]] = value
    p["friction"]["law"], p["friction"]["set_valued"] = laws.code(law), laws.LAWS[law].SET_VALUED
    p["input"]["amplitude"], p["input"]["omega"] = given


def set_effects(p: np.void, names: Iterable[str], effects: Numbers) -> None:
    """Put the numbers (SI) of effects into their parts of a ``blank`` record, or adjust other parts by them.

    ``names``: of all effects that the record's system knows, in their order.
    """
    for name in names:
        module = known.REGISTERED[name]
        if name in effects and hasattr(module, "adjust"):
            module.adjust(p, **{**known.EFFECTS[name].off, **effects[name]})
        elif name in effects:
            for number, value in effects[name].items():
                p[name][number] = value
        if hasattr(module, "prepare"):
            module.prepare(p)


def acting(p: np.void, names: Iterable[str]) -> list[str]:
    """Those of some effects that act in a record and need mechanics of their own."""
    effects = [known.EFFECTS[name] for name in names]
    return [
        each.name
        for each in effects
        if each.extends and any(p[each.name][number] != each.off[number] for number in each.extends)
    ]


def is_linear(name: str) -> bool:
    """Whether an effect has no states, and its forces but friction are linear in x and x' in a mode."""
    return getattr(known.REGISTERED[name], "LINEAR", False)


def stacked(some: Sequence[np.ndarray]) -> np.ndarray:
    """Records of one type, one array after the other."""
    # numpy would compare the types part by part.
    return np.concatenate([each.view(np.uint8) for each in some]).view(some[0].dtype)


def converted(rows: np.ndarray, kind: np.dtype) -> np.ndarray:
    """Records, shape (n,), of another type: with those of its parts that the given ones have, and zeros."""
    if kind == rows.dtype:
        return rows
    small = np.zeros(rows.shape, kind)
    for name in set(kind.names or ()) & set(rows.dtype.names or ()):
        small[name] = rows[name]
    return small
