"""Parts of error messages: a value as a user wrote it, and the name that was probably meant."""

from collections.abc import Iterable
from difflib import get_close_matches
from typing import Any

from wedgesweep import toml


def show(value: Any) -> str:
    """Format a value for an error message, shortened."""
    text = toml.inline(value)
    return text if len(text) <= 40 else f"{text[:37]}..."


def hint(name: str, valid: Iterable[str]) -> str:
    """Suggest the nearest valid name, or list all of them."""
    valid = tuple(valid)
    close = get_close_matches(name.lower(), valid, n=1, cutoff=0.55)
    return f'did you mean "{close[0]}"?' if close else f"valid here: {', '.join(valid)}"
