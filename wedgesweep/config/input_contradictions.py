"""Settings of a config with a table [input] that are valid alone, but contradict each other."""

from collections.abc import Iterator, Mapping
from typing import Any

from wedgesweep.formatting import counted
from wedgesweep.inputs.units import RECORDED

# Effects on a sine, or with a phase of their own against it.
OF_A_SINE = ("input_distortion", "cross_slip")
# An input that needs more samples than this fills the memory.
MOST_SAMPLES = 20_000_000


def is_force(given: Mapping[str, Any]) -> bool:
    """Whether the input of a table [input] is a force."""
    return given.get("quantity") == "force" or any(name.endswith("_N") for name in given)


def input_contradictions(document: Mapping[str, Any]) -> Iterator[str]:
    """Yield all contradictions, each as a line that names the key and a valid setting."""
    given = document["input"]
    yield from _of_kind(given)
    yield from _of_system(document)
    solver = document.get("solver", {})
    for key in ("settle", "continuation"):
        if solver.get(key):
            yield f"solver.{key}: an [input] does not repeat; remove it"
    for name in set(OF_A_SINE).intersection(document.get("effects", {})):
        yield f"effects.{name}: belongs to a sine, not to an [input]; remove it"


def _of_kind(given: Mapping[str, Any]) -> Iterator[str]:
    """Keys of one kind that contradict each other."""
    if 2.0 * given.get("fade_s", 0.0) > given.get("duration_s", 0.0) > 0.0:
        yield f"input.fade_s: {given['fade_s']:g} is more than half of duration_s"
    if given.get("kind") == "record" and {"quantity", "unit"} <= given.keys():
        units = RECORDED[given["quantity"]]
        if given["unit"] not in units:
            fault = f"{given['unit']} is no unit of {given['quantity']}"
            yield f"input.unit: {fault}; valid here: {', '.join(units)}"
    if given.get("kind") == "random":
        yield from _density(given)
    if given.get("sampling_hz", 0.0) * given.get("duration_s", 0.0) > MOST_SAMPLES:
        yield f"input.sampling_hz: more than {MOST_SAMPLES:g} samples in duration_s; lower it"
    highest = max([given.get("start_hz", 0.0), given.get("stop_hz", 0.0), *given.get("frequency_hz", ())])
    if 64.0 * highest * given.get("duration_s", 0.0) > MOST_SAMPLES:
        yield (
            f"input.duration_s: {given['duration_s']:g} s with frequencies up to {highest:g} Hz are too many "
            "periods to hold in memory; shorten it, or lower the frequencies"
        )


def _density(given: Mapping[str, Any]) -> Iterator[str]:
    """Faults of the band, or of the table, of a power spectral density."""
    band, table = ("start_hz", "stop_hz"), ("frequency_hz", "level")
    listed = [key for key in table if key in given]
    if listed and any(key in given for key in band):
        yield f"input.{listed[0]}: a band and a table exclude each other; keep start_hz and stop_hz, or it"
        return
    missing = [key for key in (table if listed else band) if key not in given]
    if missing:
        yield f"input.{missing[0]}: missing; write start_hz and stop_hz, or frequency_hz and level"
    elif listed and len(given["frequency_hz"]) != len(given["level"]):
        levels = counted(len(given["level"]), "level")
        frequencies = counted(len(given["frequency_hz"]), "frequency", "frequencies")
        yield f"input.level: {levels} for {frequencies}; write one for each"
    elif listed and len(given["frequency_hz"]) < 2:
        yield "input.frequency_hz: a single one has no band between; write two or more"
    else:
        ends = given["frequency_hz"] if listed else [given[key] for key in band]
        yield from _band(ends[0], ends[-1], given.get("duration_s", 1e9))


def _band(low: float, high: float, duration: float) -> Iterator[str]:
    """Faults of a band (Hz) of an input of some duration (s)."""
    if high <= low:
        yield f"input.stop_hz: {high:g} is not above {low:g}; write an increasing band"
    elif int(high * duration * (1.0 + 1e-12)) < low * duration:
        yield "input.duration_s: too short for the band: it holds no multiple of 1/duration_s"


def _of_system(document: Mapping[str, Any]) -> Iterator[str]:
    """Inputs that a system does not have."""
    given, own = document["input"], document.get("oscillator")
    if is_force(given) and own is None:
        yield "input: a suspension is driven by its side frame; write a motion, or [oscillator]"
    contact = "base" if own is None else own.get("contact", "base")
    if given.get("kind") == "ramp" and contact == "base":
        yield (
            "input.kind: a base at a constant velocity moves nothing that rubs on it; "
            'use contact = "ground", or "belt"'
        )
    at_rest = given.get("displacement_mm") == given.get("velocity_mm_per_s") == 0.0
    if given.get("kind") == "release" and at_rest and contact != "belt":
        yield "input.displacement_mm: 0 without a velocity is rest; write one of both"
    if is_force(given) and "stray_vibration" in document.get("effects", {}):
        yield "effects.stray_vibration: under a force the base does not move; remove it"
