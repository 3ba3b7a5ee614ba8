"""Parts of error messages: a value as a user wrote it, and the name that was probably meant."""

from collections.abc import Iterable
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from wedgesweep import toml

# Characters of a path that are shown whole: Linux's limit of a name.
LONGEST_PATH = 255


def show(value: Any) -> str:
    """Format a value for an error message, shortened."""
    text = toml.inline(value)
    return text if len(text) <= 40 else f"{text[:37]}..."


def shortened(path: Path) -> str:
    """Format a path for an error message: of one that is very long, both ends."""
    text, half = str(path), LONGEST_PATH // 2
    return text if len(text) <= LONGEST_PATH else f"{text[:half]}...{text[-half:]}"


def hint(name: str, valid: Iterable[str]) -> str:
    """Suggest the nearest valid name, or list all of them."""
    valid = tuple(valid)
    close = get_close_matches(name.lower(), valid, n=1, cutoff=0.55)
    return f'did you mean "{close[0]}"?' if close else f"valid here: {', '.join(valid)}"
