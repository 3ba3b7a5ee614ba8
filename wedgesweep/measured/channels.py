"""Which channels go together: what a measurement must have, and what a system cannot show."""

from collections.abc import Iterable, Mapping
from typing import Any

from wedgesweep.config import Config
from wedgesweep.measured import kinds
from wedgesweep.measured.declarations import (
    ABSOLUTE,
    AMPLITUDE,
    COLUMNS,
    DELAY_STD,
    FORCE_AMPLITUDE,
    INPUT,
    INPUT_GAIN_STD,
    INPUT_HARMONICS_STD,
    KNOWN_FORCE,
    LOOP,
    NORMAL_FORCE,
    RELATIVE,
    RESPONSES,
    STEADY,
    TRANSIENT,
    UNCERTAIN,
)
from wedgesweep.uncertain import DISTORTION
from wedgesweep.units import angular

# Responses that are compared at a time.
MOST_RESPONSES = 2
STRAY, OSCILLATOR = "stray_vibration", "oscillator"
FORCE = "force"


def faults(
    by_kind: Mapping[str, Mapping[str, Mapping[str, Any]]], stds: Mapping[str, Any], model: Config | None
) -> list[str]:
    """Faults of the channels of each kind of test, as "key: fault"; without any, those beside the model.

    ``stds``: what is unknown, by the names of INPUT_STDS and in the table ``uncertain``.
    """
    gain_std = stds[INPUT_GAIN_STD.key]
    found = [fault for kind, own in by_kind.items() for fault in channel_faults(own, gain_std, kind)]
    found += [fault for kind, own in by_kind.items() for fault in _known_force_faults(own, kind)]
    found += _delay_faults(by_kind)
    if stds[INPUT_HARMONICS_STD.key]:
        found += [f"{INPUT_HARMONICS_STD.key}: {fault}" for fault in _harmonics_faults(by_kind)]
    if DISTORTION in stds[UNCERTAIN.key]:
        faults = _harmonics_faults(by_kind) or _other_kinds_faults(by_kind)
        found += [f"{UNCERTAIN.key}.{DISTORTION}: {fault}" for fault in faults]
    if found or model is None:
        return found
    return [fault for kind, own in by_kind.items() for fault in excitation_faults(own, model, kind)]


def _known_force_faults(columns: Mapping[str, Mapping[str, Any]], kind: str) -> list[str]:
    """Why a known force has nothing to be added to."""
    recorded = columns.get(INPUT, {}).get("quantity")
    if KNOWN_FORCE not in columns or kind == LOOP or recorded == FORCE:
        return []
    mend = f'record loops, or an {INPUT} with quantity = "{FORCE}" (this one, if there is no other)'
    return [f"{KNOWN_FORCE}: it is not simulated beside a base that moves, in tests of kind {kind}; {mend}"]


def _delay_faults(by_kind: Mapping[str, Mapping[str, Mapping[str, Any]]]) -> list[str]:
    """Why a delay cannot be fitted: fits know one, between all responses and a force or an input."""
    late: dict[str, None] = {}
    for own in by_kind.values():
        responses = [name for name in RESPONSES if name in own and name != FORCE]
        fitted = (FORCE, INPUT, *(responses if len(responses) == 1 else ()))
        late |= dict.fromkeys(name for name in own if DELAY_STD.key in own[name] and name not in fitted)
    fault = f"only a delay of {FORCE}, {INPUT} or their only response is fitted; omit it"
    return [f"{name}.{DELAY_STD.key}: {fault}" for name in late]


def _harmonics_faults(by_kind: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """Why harmonics of the input cannot be uncertain: those of stated inputs of steady tests are."""
    if STEADY not in by_kind:
        return [f"there is no test of kind {STEADY}, and inputs of other kinds are no sines; omit it"]
    if INPUT in by_kind[STEADY]:
        return [f"the input is recorded, and its harmonics with it; omit it, or the column {INPUT}"]
    return []


def _other_kinds_faults(by_kind: Mapping[str, Any]) -> list[str]:
    """Why harmonics of the input cannot be the same in all tests."""
    others = [kind for kind in by_kind if kind != STEADY]
    return [f"tests of kind {kind} have other inputs; diagnose them by themselves" for kind in others]


def channel_faults(
    columns: Mapping[str, Mapping[str, Any]], gain_std: float, kind: str = STEADY
) -> list[str]:
    """Faults of the declared channels as "key: fault", those of single keys aside."""
    if kind != STEADY:
        return kinds.column_faults(columns, kind)
    responses = [name for name in RESPONSES if name in columns]
    if INPUT not in columns:
        return _with_stated_amplitude(columns, gain_std)
    if NORMAL_FORCE in columns:
        return [f"{NORMAL_FORCE}: it is not compared beside a recorded input; leave one of them out"]
    if not responses:
        named = ", ".join(name for name in RESPONSES if name != "force")
        return [f"{INPUT}: there is no response; give at least one of {named}"]
    if columns.get("velocity", {}).get("derived") and responses == ["velocity"]:
        return ["velocity.derived: there is no displacement that it was computed from; give that one"]
    compared = [name for name in responses if not columns[name].get("derived")]
    if len(compared) > MOST_RESPONSES:
        fault = f"{', '.join(compared)} are given"
        return [f"{compared[-1]}: {fault}; at most {MOST_RESPONSES} are compared, leave the others out"]
    return []


def _with_stated_amplitude(columns: Mapping[str, Mapping[str, Any]], gain_std: float) -> list[str]:
    faults = []
    if "displacement" not in columns:
        faults.append(f"displacement: missing; write {COLUMNS.keys['displacement'].written}")
    if "acceleration" in columns:
        faults.append("acceleration: it is compared beside a recorded input only; add the column input")
    if gain_std:
        faults.append("input_gain_std: there is no recorded input; add the column input, or omit it")
    return faults


def excitation_faults(
    columns: Mapping[str, Mapping[str, Any]], model: Config, kind: str = STEADY
) -> list[str]:
    """Faults of the channels of a model with this excitation, as "key: fault"."""
    if kind == LOOP or (kind == TRANSIENT and INPUT not in columns):
        return []
    faults = []
    if FORCE in columns:
        fault = "no force acts on a mass whose base moves; leave the column out"
        if model.forced:
            fault = f'the force that drives the mass is the column {INPUT}, with quantity = "{FORCE}"'
        faults.append(f"{FORCE}: {fault}")
    if INPUT not in columns:
        return faults + _unknown_motion(columns, model)
    recorded = columns[INPUT]["quantity"]
    if (recorded == FORCE) != model.forced:
        moves = "a force drives the mass" if model.forced else "the base moves, and no force drives the mass"
        fault = f'in the model {moves} (sweep.excitation = "{model.excitation}"); record that'
        faults.append(f"{INPUT}.quantity: {recorded}, but {fault}")
    return faults


def _unknown_motion(columns: Mapping[str, Mapping[str, Any]], model: Config) -> list[str]:
    """Responses that cannot be compared without a recorded input."""
    known = model.simulated_motion
    return [
        f"{name}.of: without a recorded input nothing tells the {of} motion; "
        f'add the column input, or measure and write of = "{known[0]}"'
        for name, of in ((name, columns[name].get("of", RELATIVE)) for name in RESPONSES if name in columns)
        if of not in known
    ]


def keys_faults(given: Mapping[str, Any], columns: Mapping[str, Any], model: Config | None) -> list[str]:
    """Faults of the keys of a test beside the channels, as "key: fault"."""
    if wrong := kinds.key_faults(given):
        return wrong
    stated = [key for key in (AMPLITUDE.key, FORCE_AMPLITUDE.key) if key in given]
    if INPUT in columns:
        fault = "the input is recorded, which tells more; omit it, or the column input"
        return [f"{key}: {fault}" for key in stated]
    if model is None:
        return []
    right = model.amplitude_unit.key
    fault = f'sweep.excitation of the model is "{model.excitation}"; write {right}'
    return [f"{key}: {fault}" for key in stated if key != right]


def model_faults(
    model: Config, columns: Mapping[str, Mapping[str, Any]], kinds: Iterable[str] = (STEADY,)
) -> list[str]:
    """Faults of the base model beside the channels and kinds of the tests."""
    faults, effects = _unit_faults(model, columns), model.effects
    if NORMAL_FORCE in columns and model.turns:
        fault = "what turns has a torque of friction; state oscillator.friction_N_m of each test by model"
        faults.append(f"measurement.columns.{NORMAL_FORCE}: {fault}")
    if NORMAL_FORCE in columns and model.system != OSCILLATOR and STRAY in effects:
        faults.append(f"effects.{STRAY}: beside a {NORMAL_FORCE} a response repeats each period; remove it")
    if model.opens and {*kinds} != {STEADY}:
        faults.append(f"joints that lift off are simulated in tests of kind {STEADY} only; let them hold")
    if INPUT not in columns:
        return faults
    if STRAY in effects:
        faults.append(f"effects.{STRAY}: a recorded input repeats each period; remove it from the model")
    absolute = any(each.get("of") == ABSOLUTE for each in columns.values())
    if absolute and "fixture_resonance" in effects:
        fault = "the absolute motion of the bolster does not follow from that of the table"
        faults.append(f"effects.fixture_resonance: {fault}; measure the motion against the side frame")
    return faults


def _unit_faults(model: Config, columns: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """Channels in units of the other motion: angles of a mass that moves, or lengths of one that turns."""
    wanted = "an angle or a torque" if model.turns else "a length or a force"
    mend = "oscillator.motion of the model, or the unit"
    return [
        f"measurement.columns.{name}.unit: {each['unit']} is not a unit of {wanted}; correct {mend}"
        for name, each in columns.items()
        if name != "time" and "unit" in each and angular(each["unit"]) != model.turns
    ]
