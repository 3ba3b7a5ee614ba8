"""Parts of a JSON schema that occur more than once, each written once: axes repeat every key of the model."""

import json
from collections import Counter
from collections.abc import Callable
from typing import Any

# Characters of a part from which on a reference is shorter.
LEAST = 60
# Keywords whose values are schemas by name, in a list, and alone.
NAMED, LISTED, ALONE = ("properties",), ("anyOf", "oneOf", "allOf"), ("items", "additionalProperties")


def with_shared_parts(schema: dict[str, Any]) -> dict[str, Any]:
    """The same schema with its repeated parts in ``$defs``."""
    counts: Counter[str] = Counter()

    def count(part: dict[str, Any]) -> dict[str, Any]:
        counts[text := _text(part)] += 1
        # What is inside of a part that was met before is written once with it.
        return part if counts[text] > 1 else _mapped(part, count)

    names: dict[str, str] = {}
    definitions: dict[str, Any] = {}

    def refer(part: dict[str, Any]) -> dict[str, Any]:
        text = _text(part)
        if counts[text] < 2 or len(text) < LEAST:
            return _mapped(part, refer)
        if text not in names:
            names[text] = f"part{len(names) + 1}"
            definitions[names[text]] = _mapped(part, refer)
        return {"$ref": f"#/$defs/{names[text]}"}

    _mapped(schema, count)
    return {**_mapped(schema, refer), "$defs": definitions}


def _text(part: dict[str, Any]) -> str:
    return json.dumps(part, sort_keys=True)


def _mapped(part: dict[str, Any], change: Callable[[dict[str, Any]], dict[str, Any]]) -> dict[str, Any]:
    """A schema with each schema in it changed."""
    changed = dict(part)
    for key in NAMED:
        if key in part:
            changed[key] = {name: change(each) for name, each in part[key].items()}
    for key in LISTED:
        if key in part:
            changed[key] = [change(each) for each in part[key]]
    for key in ALONE:
        if isinstance(part.get(key), dict):
            changed[key] = change(part[key])
    return changed
