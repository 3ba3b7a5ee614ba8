"""Tables and numbers in Markdown."""

from collections.abc import Iterable, Sequence
from typing import Any


def number(value: float | None) -> str:
    """A number with four significant digits, "-" for None."""
    return "-" if value is None else f"{value:.4g}"


def table(head: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    """Markdown table."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(map(str, line)) + " |" for line in lines)
