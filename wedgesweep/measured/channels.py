"""Which channels go together: what a measurement must have, and what a system cannot show."""

from collections.abc import Mapping, Sequence
from typing import Any

from wedgesweep.measured.declarations import ABSOLUTE, COLUMNS, INPUT, RELATIVE, RESPONSES

# Responses that are compared at a time.
MOST_RESPONSES = 2
STRAY = "stray_vibration"


def channel_faults(columns: Mapping[str, Mapping[str, Any]], gain_std: float) -> list[str]:
    """Faults of the declared channels as "key: fault", those of single keys aside."""
    if "force" in columns:
        return ["force: a suspension has no measured force; leave the column out"]
    if columns.get(INPUT, {}).get("quantity") == "force":
        return [
            "input.quantity: the base of a suspension moves, no force drives it; give the motion of the base"
        ]
    responses = [name for name in RESPONSES if name in columns]
    if INPUT not in columns:
        return _with_stated_amplitude(columns, responses, gain_std)
    if not responses:
        named = ", ".join(name for name in RESPONSES if name != "force")
        return [f"{INPUT}: there is no response; give at least one of {named}"]
    if columns.get("velocity", {}).get("derived") and responses == ["velocity"]:
        return ["velocity.derived: there is no displacement that it was computed from; give that one"]
    compared = [name for name in responses if not columns[name].get("derived")]
    if len(compared) > MOST_RESPONSES:
        told = f"{', '.join(compared)} are given"
        return [f"{compared[-1]}: {told}; at most {MOST_RESPONSES} are compared, leave the others out"]
    return []


def _with_stated_amplitude(
    columns: Mapping[str, Mapping[str, Any]], responses: Sequence[str], gain_std: float
) -> list[str]:
    faults = [
        f"{name}.of: without a recorded input nothing tells the absolute motion; add the column input"
        for name in responses
        if columns[name].get("of", RELATIVE) == ABSOLUTE
    ]
    if "displacement" not in columns:
        faults.append(f"displacement: missing; write {COLUMNS.keys['displacement'].written}")
    if "acceleration" in columns:
        faults.append("acceleration: it is compared beside a recorded input only; add the column input")
    if gain_std:
        faults.append("input_gain_std: there is no recorded input; add the column input, or omit it")
    return faults


def keys_faults(given: Mapping[str, Any], columns: Mapping[str, Any]) -> list[str]:
    """Faults of the keys of a test beside the channels, as "key: fault"."""
    return [
        f"{key}: the input is recorded, which tells more; omit it, or the column input"
        for key in ("amplitude_mm",)
        if INPUT in columns and key in given
    ]


def model_faults(effects: Mapping[str, Any], columns: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """Faults of the base model beside the channels."""
    if INPUT not in columns:
        return []
    faults = []
    if STRAY in effects:
        faults.append(f"effects.{STRAY}: a recorded input repeats each period; remove it from the model")
    absolute = any(each.get("of") == ABSOLUTE for each in columns.values())
    if absolute and "fixture_resonance" in effects:
        told = "the absolute motion of the bolster does not follow from that of the table"
        faults.append(f"effects.fixture_resonance: {told}; measure the motion against the side frame")
    return faults
