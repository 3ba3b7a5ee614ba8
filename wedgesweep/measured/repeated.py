"""Tests that repeat an earlier one: what the key ``repeat_of`` may name."""

from collections.abc import Mapping, Sequence
from typing import Any

from wedgesweep.hints import show
from wedgesweep.measured.declarations import STEADY


def faults(given: Mapping[str, Any], before: Sequence[Mapping[str, Any]]) -> list[str]:
    """Faults of the key that names the test which this one repeats, as "key: fault".

    ``given``: keys of a test; ``before``: those of the tests before it, and their names: file, file#2.
    """
    first = given.get("repeat_of")
    if first is None:
        return []
    for other in before:
        if other.get("name") == first and "repeat_of" not in other:
            same = other.get("kind", STEADY) == given.get("kind", STEADY)
            return [] if same else [f"repeat_of: {show(first)} is of another kind; a repeat is of the same"]
    fault = "is not the file of an earlier test that repeats none; name that one"
    return [f"repeat_of: {show(first)} {fault}"]
