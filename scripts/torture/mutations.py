"""Mutations of bytes, of lines of text, and of nested documents, drawn from a random generator."""

import datetime
import json
import re
from copy import deepcopy
from math import inf, isfinite, isinf, isnan, nan
from random import Random
from typing import Any

WHEN = datetime.datetime(1979, 5, 27, 7, 32, tzinfo=datetime.UTC)
# Values that a key may be given; lists that are long or deep are made when they are drawn.
NUMBERS = (
    *(0, -0.0, 1, -1, 2, 3, 0.5, 1e-3, 1e3, 1e5, 1e9, 2**31, 2**63, -(2**63), 10**30),
    *(1e200, -1e200, 1e-200, 5e-324, 1.7e308, nan, inf, -inf),
)
OTHERS: tuple[Any, ...] = (
    *(True, False, "", "x", "1.0", "nan", "\0", "ümläut ☃", "../..", "/dev/null", "/", "a" * 5000, "\n"),
    *("%s{}", [], {}, [[]], [{}], {"x": 1}, [1, "x"], [nan], [1e200, 1e-200], [0], [1, 1]),
    *(WHEN, WHEN.date(), WHEN.time()),
)
# Pieces of text that upset parsers.
TOKENS = (
    *("\0", "\ufeff", "\r", "\n\n", "\t"),
    *('"', "'", '"""', ",", ",,", ";", "=", "[", "]", "[[", "{", "}", "#", "\\", "nan", "inf", "-inf"),
    *("1e200", "1e-200", "1e999", "-1"),
    *("0x" + "f" * 5000, "9" * 5000),
    *("0.1.2", "1,5", "ü"),
    *("\x1b[31m", "[" * 3000, "a." * 3000),
    *("true", "1979-05-27", "\u2028", "\ud7ff", "１", "=" * 2000),
)
BYTES = (
    *(b"\0", b"\xff", b"\xff\xfe", b"\xfe\xff", b"\xef\xbb\xbf", b"\x89HDF\r\n\x1a\n", b"PAR1"),
    *(b"\x80", b"\xc3(", b"\x1f\x8b"),
)


def value(draw: Random) -> Any:
    """Return an absurd value."""
    kind = draw.random()
    if kind < 0.55:
        return draw.choice(NUMBERS)
    if kind < 0.9:
        return deepcopy(draw.choice(OTHERS))
    if kind < 0.95:
        nested: Any = 1
        for _ in range(draw.choice((5, 19, 60))):
            nested = [nested] if draw.random() < 0.5 else {"a": nested}
        return nested
    return [draw.choice((0.5, 1e200, 1)) * (i + 1) for i in range(draw.choice((300, 3000)))]


def document(given: dict[str, Any], draw: Random) -> dict[str, Any]:
    """Change a few places of a document of nested tables and lists."""
    changed = deepcopy(given)
    for _ in range(draw.choice((1, 1, 1, 2, 3, 6))):
        places = list(_places(changed))
        if not places:
            return changed
        _change(*draw.choice(places), draw)
    return changed


def _places(inside: Any) -> Any:
    """Every table or list with a key or index in it."""
    each = inside.items() if isinstance(inside, dict) else enumerate(inside)
    for key, found in list(each):
        yield inside, key
        if isinstance(found, dict | list) and len(found) < 100:
            yield from _places(found)


def _change(inside: Any, key: Any, draw: Random) -> None:
    found, kind = inside[key], draw.random()
    number = isinstance(found, int | float) and not isinstance(found, bool)
    if kind < 0.35 and number:
        inside[key] = _other_number(found, draw)
    elif kind < 0.7:
        inside[key] = value(draw)
    elif kind < 0.8:
        del inside[key]
    elif isinstance(inside, list):
        inside.insert(key, deepcopy(draw.choice(inside)))
    elif kind < 0.9:
        inside[draw.choice(("x", key + "x", "", "ü", "a.b", "\0"))] = inside.pop(key)
    else:
        inside[draw.choice(list(inside))] = deepcopy(found)


def _other_number(found: float, draw: Random) -> float:
    """Return a number near the valid ones, where checks of single keys do not help."""
    if isinstance(found, float) and not isfinite(found):
        return draw.choice(NUMBERS)
    kind = draw.random()
    if kind < 0.2:
        return -found
    if kind < 0.4:
        return found + draw.choice((1, -1, 1e-9))
    return float(found) * 10.0 ** draw.uniform(-6.0, 6.0)


def toml(given: dict[str, Any]) -> str:
    """Write a document as TOML: outer tables with headers, all others inline."""
    plain = {key: each for key, each in given.items() if not isinstance(each, dict)}
    tables = {key: each for key, each in given.items() if isinstance(each, dict)}
    parts = [_lines(plain), *(f"\n[{_key(key)}]\n{_lines(each)}" for key, each in tables.items())]
    return "".join(parts)


def _lines(given: dict[str, Any]) -> str:
    return "".join(f"{_key(key)} = {_inline(each)}\n" for key, each in given.items())


def _key(key: str) -> str:
    return key if re.fullmatch(r"\w+", key, re.ASCII) else json.dumps(key)


def _inline(given: Any) -> str:
    if isinstance(given, str):
        return json.dumps(given).replace("\x7f", "\\u007f")
    if isinstance(given, bool):
        return str(given).lower()
    if isinstance(given, float) and (isnan(given) or isinf(given)):
        return str(given)
    if isinstance(given, list):
        return f"[{', '.join(map(_inline, given))}]"
    if isinstance(given, dict):
        return "{" + ", ".join(f"{json.dumps(key)} = {_inline(each)}" for key, each in given.items()) + "}"
    return given.isoformat() if hasattr(given, "isoformat") else str(given)


def text(given: str, draw: Random) -> str:
    """Insert, delete and repeat pieces of text, at random or by lines."""
    changed = given
    for _ in range(draw.choice((1, 1, 2, 4))):
        lines, kind = changed.split("\n"), draw.random()
        place = draw.randrange(len(lines))
        if kind < 0.4:
            at = draw.randrange(len(changed) + 1)
            changed = changed[:at] + draw.choice(TOKENS) + changed[at:]
            continue
        if kind < 0.55:
            del lines[place]
        elif kind < 0.7:
            lines.insert(place, draw.choice(lines))
        elif kind < 0.85:
            cells = lines[place].split(",")
            cells[draw.randrange(len(cells))] = draw.choice((*TOKENS, *map(str, NUMBERS)))
            lines[place] = ",".join(cells)
        else:
            del lines[place:]
        changed = "\n".join(lines)
    return changed


def raw(given: bytes, draw: Random) -> bytes:
    """Flip, insert, cut and double some bytes."""
    changed = bytearray(given)
    for _ in range(draw.choice((1, 2, 4, 16))):
        if not changed:
            return draw.choice(BYTES)
        at, kind = draw.randrange(len(changed)), draw.random()
        if kind < 0.6:
            changed[at] = draw.randrange(256)
        elif kind < 0.75:
            changed[at:at] = draw.choice(BYTES)
        elif kind < 0.85:
            del changed[at : at + draw.choice((1, 8, 512))]
        elif kind < 0.92:
            del changed[at:]
        else:
            changed[at:at] = changed[at : at + draw.choice((8, 512))]
    return bytes(changed)
