"""TOML: a reader that refuses what nothing here can hold, and a writer, which the standard library lacks."""

import json
import re
import tomllib
from pathlib import Path
from typing import Any

from wedgesweep.errors import InputError
from wedgesweep.files import read_text

# Tables and lists of a config are nested less deeply.
DEEPEST = 20
# A longer whole number is shown in hexadecimal: Python writes decimals of limited length only.
MOST_BITS = 4096


def load(path: Path, wanted: str) -> dict[str, Any]:
    """Read a TOML file; raises InputError, which names the file and what is ``wanted`` in its place."""
    try:
        return loads(read_text(path))
    except UnicodeDecodeError as error:
        problem = f"{path}: not UTF-8 text (byte {error.start}); save it as UTF-8"
    except OSError as error:
        problem = f"{path}: {error.strerror}; give the path of {wanted}"
    except ValueError as error:
        problem = f"{path}: not valid TOML: {error}"
    raise InputError([problem])


def loads(text: str) -> dict[str, Any]:
    """Read TOML text; raises ValueError."""
    message = f"nested more than {DEEPEST} deep"
    try:
        document = tomllib.loads(text)
    except RecursionError as error:
        raise ValueError(message) from error
    level: list[Any] = [document]
    for _ in range(DEEPEST):
        level = [
            inner
            for each in level
            for inner in (each.values() if isinstance(each, dict) else each)
            if isinstance(inner, dict | list)
        ]
    if level:
        raise ValueError(message)
    return document


def inline(value: Any) -> str:
    """Format a value; floats with full precision."""
    if isinstance(value, str):
        # A JSON string is a TOML basic string, except that TOML requires DEL to be escaped.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int) and value.bit_length() > MOST_BITS:
        return hex(value)
    if isinstance(value, list):
        return f"[{', '.join(inline(item) for item in value)}]"
    if isinstance(value, dict):
        return f"{{ {', '.join(f'{_name(key)} = {inline(item)}' for key, item in value.items())} }}"
    return str(value)


def dumps(document: dict[str, Any], path: str = "") -> str:
    """Format a document of nested tables as TOML."""
    plain, tables = [], []
    for key, value in document.items():
        if isinstance(value, dict):
            inside = dumps(value, f"{path}{_name(key)}.")
            needs_header = inside and not inside.startswith("\n")
            tables.append(f"\n[{path}{_name(key)}]\n{inside}" if needs_header else inside)
        elif isinstance(value, list) and isinstance(value[0], dict):
            tables += (f"\n[[{path}{_name(key)}]]\n{dumps(item)}" for item in value)
        else:
            plain.append(f"{_name(key)} = {inline(value)}\n")
    return "".join(plain + tables)


def _name(key: str) -> str:
    """A key, in quotes where TOML needs them."""
    return key if re.fullmatch(r"[A-Za-z0-9_-]+", key) else inline(key)
