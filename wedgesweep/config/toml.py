"""TOML writer; the standard library only reads TOML."""

import json
from typing import Any


def inline(value: Any) -> str:
    """Format a value; floats with full precision."""
    if isinstance(value, str):
        # A JSON string is a TOML basic string, except that TOML requires DEL to be escaped.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, list):
        return f"[{', '.join(inline(item) for item in value)}]"
    if isinstance(value, dict):
        return f"{{ {', '.join(f'{key} = {inline(item)}' for key, item in value.items())} }}"
    return str(value)


def dumps(document: dict[str, Any], path: str = "") -> str:
    """Format a document of nested tables as TOML; its keys must be bare keys."""
    plain, tables = "", ""
    for key, value in document.items():
        if isinstance(value, dict):
            inside = dumps(value, f"{path}{key}.")
            needs_header = inside and not inside.startswith("\n")
            tables += f"\n[{path}{key}]\n{inside}" if needs_header else inside
        elif isinstance(value, list) and isinstance(value[0], dict):
            tables += "".join(f"\n[[{path}{key}]]\n{dumps(item)}" for item in value)
        else:
            plain += f"{key} = {inline(value)}\n"
    return plain + tables
