"""Compares a verdict with the truth."""

from typing import TYPE_CHECKING, Any

import blind_outside_files as outside
import blind_strength as strength

from wedgesweep.effects import EFFECTS

if TYPE_CHECKING:
    from blind_draft import Draft

Record = dict[str, Any]
NAMING = ("named", "consistent-with")
ABSTAINING = ("tied", "data-insufficient", "none-of-mine")


def causes(record: Record) -> list[str]:
    """Effects that are reported as the cause; none where the verdict abstains."""
    return sorted(cause["effect"] for cause in record["causes"])


def exact(record: Record) -> bool:
    """Named, and right."""
    return record["verdict"] in NAMING and causes(record) == record["truth"]


def wrongly_named(record: Record) -> bool:
    """The worst outcome: sure and wrong."""
    return record["verdict"] == "named" and causes(record) != record["truth"]


def reported(record: Record) -> bool:
    """Whether the truth is the cause or one of the rivals."""
    return record["truth"] in [causes(record), *(sorted(rival["effects"]) for rival in record["rivals"])]


def exact_or_tied(record: Record) -> bool:
    return exact(record) or (record["verdict"] == "tied" and reported(record))


def families(names: list[str]) -> list[str]:
    return sorted({EFFECTS[name].family if name in EFFECTS else "outside" for name in names})


def right_family(record: Record) -> bool:
    return bool(causes(record)) and families(causes(record)) == families(record["truth"])


def coverage(record: Record) -> list[tuple[str, bool]]:
    """Whether the 95 % interval of each number of a right cause holds the true one."""
    found = []
    for cause in record["causes"]:
        true = record["numbers"][cause["effect"]]
        for key, estimate in cause["parameters"].items():
            low, high = estimate["ci95"]
            value, middle = true.get(key), 0.5 * ((low or 0.0) + (high or 0.0))
            if value is None:
                continue
            quantity = next(q for q in EFFECTS[cause["effect"]].quantities if q.key == key)
            value = quantity.nearest(value, middle)
            inside = low is not None and high is not None and low <= value <= high
            found.append((f"{cause['effect']}.{key}", inside))
    return found


def gain_in_truth(draft: "Draft", found: Record) -> float | None:
    """Share of the excess that the extended model removes from responses without noise."""
    if not found["causes"]:
        return None
    known = {
        cause["effect"]: {
            quantity.key: cause["parameters"].get(quantity.key, {}).get("value", quantity.default)
            for quantity in EFFECTS[cause["effect"]].quantities
        }
        for cause in found["causes"]
    }
    if draft.foreign:
        mean, tone = outside.harmonics(draft, draft.foreign)[0], None
    else:
        mean, tone = strength.harmonics(draft.model(draft.hidden), draft.law, draft.tests)
    base = draft.excess(mean, tone, {})
    return 1.0 - draft.excess(mean, tone, known) / base if base > 0.0 else None
