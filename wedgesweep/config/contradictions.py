"""Settings of a config that are valid alone, but contradict each other."""

from collections.abc import Iterator, Mapping
from math import inf, nan
from typing import Any

from wedgesweep.config.input_contradictions import input_contradictions, is_force
from wedgesweep.effects import EFFECTS, jamming, lift_off, of_system, with_lift_off
from wedgesweep.effects.base import OSCILLATOR, SUSPENSION
from wedgesweep.friction.names import LAW_NAMES, OSCILLATOR_LAWS
from wedgesweep.rotation import ROTATION
from wedgesweep.systems.oscillator.parameters import OF_BASE, OF_LAW, OF_ROD, PENDULUM, WITH_DAMPING
from wedgesweep.systems.suspension.parameters import CONSTANT, LOCKED_IN, UNILATERAL

# What some laws of oscillators do without an effect.
OF_ITSELF = {"lugre": "has bristles of its own", "hyperbolic": "falls with velocity by itself"}


def contradictions(document: Mapping[str, Any]) -> Iterator[str]:
    """Yield all contradictions, each as a line that names the key and a valid setting."""
    yield from _geometry(document)
    yield from _laws(document)
    yield from _excitation(document)
    if "oscillator" in document:
        yield from _oscillator(document)
    else:
        yield from _damping(document)
        yield from _joints(document)
    yield from _effects(document)
    yield from _settling(document)
    if "input" in document:
        yield from input_contradictions(document)


def _geometry(document: Mapping[str, Any]) -> Iterator[str]:
    suspension, sweep = document.get("suspension", {}), document.get("sweep", {})
    wedge, column = (suspension.get(f"{name}_angle_deg", nan) for name in ("wedge", "column"))
    if wedge + column <= 0.0:
        yield (
            f"suspension.column_angle_deg: {column} closes a wedge of {wedge} deg; "
            "the sum of both angles must be positive"
        )
    if (
        "coulomb" in _named_laws(sweep)
        and column == 0.0
        and document.get("friction", {}).get("dynamic", 0.0) > 0.0
    ):
        yield (
            "suspension.column_angle_deg: at 0 the bolster face does not slip, and coulomb "
            "does not determine its friction; use friction.dynamic = 0, another law, or another angle"
        )


def _cases(sweep: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    return list(filter(None, sweep.get("case", ())))


def _named_laws(sweep: Mapping[str, Any]) -> list[str]:
    return [*sweep.get("friction_law", ()), *(case.get("friction_law", "") for case in _cases(sweep))]


def _laws(document: Mapping[str, Any]) -> Iterator[str]:
    """Laws that a suspension does not have."""
    if "oscillator" in document:
        return
    for law in set(OSCILLATOR_LAWS).intersection(_named_laws(document.get("sweep", {}))):
        yield f"sweep.friction_law: {law} is a law of [oscillator]; valid here: {', '.join(LAW_NAMES)}"


def _excitation(document: Mapping[str, Any]) -> Iterator[str]:
    """Amplitudes in the unit of the other excitation."""
    sweep = document.get("sweep", {})
    forced = sweep.get("excitation") == "force"
    if forced and "oscillator" not in document:
        yield 'sweep.excitation: a suspension is driven by its side frame; write "base", or [oscillator]'
        return
    right, wrong = ("amplitude_N", "amplitude_mm") if forced else ("amplitude_mm", "amplitude_N")
    for place, given in (("sweep", sweep), *(("sweep.case", case) for case in _cases(sweep))):
        if wrong in given:
            kind = "force" if forced else "base"
            other = "base" if forced else "force"
            yield f'{place}.{wrong}: excitation is "{kind}"; write {right}, or excitation = "{other}"'


def _oscillator(document: Mapping[str, Any]) -> Iterator[str]:
    own, sweep = document["oscillator"], document.get("sweep", {})
    given = [sweep, *_cases(sweep)]
    yield from _rotation(own, sweep)
    no_reference = own.get("spring_N_per_mm") == 0.0 and "omega_n_rad_per_s" not in sweep
    if no_reference and any("beta" in each for each in given):
        yield "sweep.beta: without a spring there is no omega_n; write frequency_hz"
    on_belt = own.get("contact") == "belt"
    if on_belt and "belt_velocity_mm_per_s" not in own:
        yield 'oscillator.belt_velocity_mm_per_s: missing; contact = "belt" needs it, as in 200.0'
    if not on_belt and "belt_velocity_mm_per_s" in own:
        yield f'oscillator.belt_velocity_mm_per_s: contact is "{own.get("contact")}"; write contact = "belt"'
    yield from _bristles(document)
    for law in set(OF_LAW).intersection(_named_laws(sweep)):
        for name in set(OF_LAW[law]).intersection(document.get("effects", {})):
            yield f"effects.{name}: {law} {OF_ITSELF[law]}; remove it, or choose another law"
    forces = [force for each in given for force in _listed(each.get("amplitude_N", inf))]
    if not on_belt and 0.0 in forces:
        yield 'sweep.amplitude_N: 0 moves nothing without contact = "belt"; it must be greater than 0'
    if OF_BASE in document.get("effects", {}) and sweep.get("excitation") == "force":
        yield f"effects.{OF_BASE}: under a force the base does not move; remove it"
    if on_belt:
        for name in set(OF_ROD).intersection(document.get("effects", {})):
            yield f"effects.{name}: a mass on a belt has no rod; remove it"
    yield from _with_damping(document)


def _with_damping(document: Mapping[str, Any]) -> Iterator[str]:
    """What a damper needs whose damping and friction are both behind a spring."""
    own = document["oscillator"]
    moves = document.get("sweep", {}).get("excitation") != "force" and not is_force(document.get("input", {}))
    for name in set(WITH_DAMPING).intersection(document.get("effects", {})):
        if own.get("contact") != "ground" or not moves:
            continue
        yield (
            f"effects.{name}: damping follows the base, friction the ground: no rod has both; write "
            'contact = "base", or excitation = "force"'
        )


def _effects(document: Mapping[str, Any]) -> Iterator[str]:
    """Effects on parts that the system does not have, and those that cannot be in one model."""
    given = document.get("effects", {})
    system = OSCILLATOR if OSCILLATOR in document else SUSPENSION
    possible = of_system(system)
    article = "an" if system == OSCILLATOR else "a"
    for name in given:
        if name not in possible:
            yield f"effects.{name}: {article} {system} has no such part; valid here: {', '.join(possible)}"
        for other in set(given).intersection(EFFECTS[name].excludes):
            yield f"effects.{name}: does not go with effects.{other}; remove one of them"
    suspension = document.get("suspension", {})
    if LOCKED_IN.key in suspension:
        for other in set(given).intersection((jamming.NAME, *jamming.EFFECT.excludes)):
            yield f"suspension.{LOCKED_IN.key}: does not go with effects.{other}; remove one of them"
        if suspension.get("joints") == UNILATERAL:
            yield f"suspension.{LOCKED_IN.key}: does not go with unilateral joints; remove one of them"


def _damping(document: Mapping[str, Any]) -> Iterator[str]:
    """Constant damping without the force that presses the wedges: no load does."""
    suspension = document.get("suspension", {})
    force = suspension.get("wedge_preload_N", inf)
    if suspension.get("damping") == CONSTANT and force <= 0.0:
        yield (
            f'suspension.wedge_preload_N: {force:g} presses no wedge; with damping = "constant" it must be '
            "greater than 0, as in 4.0"
        )


def _joints(document: Mapping[str, Any]) -> Iterator[str]:
    """What unilateral joints need, or do not go with."""
    suspension, friction = document.get("suspension", {}), document.get("friction", {})
    effects, unilateral = document.get("effects", {}), suspension.get("joints") == UNILATERAL
    if not unilateral and "restitution" in suspension:
        yield 'suspension.restitution: held joints do not hit; write joints = "unilateral", or remove it'
    if not unilateral and lift_off.NAME not in effects:
        return
    key, held = "suspension.joints", 'joints = "bilateral"'
    if lift_off.NAME in effects:
        key, held = f"effects.{lift_off.NAME}", "remove it"
        if unilateral:
            yield f'{key}: joints = "unilateral" says the same; remove one of them'
    if suspension.get("wedge_mass_kg") == 0.0:
        yield "suspension.wedge_mass_kg: a wedge that lifts off needs a mass; it must be greater than 0"
    if suspension.get("column_angle_deg") == 0.0:
        yield (
            "suspension.column_angle_deg: at 0 the bolster face does not slip, and an impact does not "
            f"determine its friction; use another angle, or {held}"
        )
    static, dynamic = friction.get("static", inf), friction.get("dynamic", 0.0)
    if static < dynamic and set(_named_laws(document.get("sweep", {}))) - {"coulomb"}:
        yield (
            f"friction.static: {static:g} is below friction.dynamic, which unilateral joints do not go with; "
            f"it must be at least {dynamic:g}, or {held}"
        )
    possible = [name for name in with_lift_off() if name != lift_off.NAME]
    for name in effects:
        if name not in (*possible, lift_off.NAME):
            yield f"effects.{name}: does not go with unilateral joints; valid here: {', '.join(possible)}"


def _rotation(own: Mapping[str, Any], sweep: Mapping[str, Any]) -> Iterator[str]:
    """What only a rotation, or only a mass that does not rub on its base, has."""
    if own.get("restoring_force") == PENDULUM and own.get("motion") != ROTATION:
        yield 'oscillator.restoring_force: a pendulum turns; write motion = "rotation", or "linear"'
    on_base = own.get("contact") == "base" and sweep.get("excitation") != "force"
    if own.get("input_coupling", 1.0) != 1.0 and on_base:
        yield (
            "oscillator.input_coupling: a mass that rubs on its base moves with all of it; "
            'write contact = "ground", or remove it'
        )


def _bristles(document: Mapping[str, Any]) -> Iterator[str]:
    """What the law of bristles needs."""
    own, lugre = document["oscillator"], "lugre" in _named_laws(document.get("sweep", {}))
    given = [key for key in own if key.startswith("bristle_")]
    if not lugre:
        yield from (f'oscillator.{key}: belongs to friction_law = "lugre"; remove it' for key in given)
        return
    if "bristle_stiffness_N_per_mm" not in own:
        yield "oscillator.bristle_stiffness_N_per_mm: missing; lugre needs it, as in 100.0"


def _listed(value: Any) -> list[Any]:
    return value if isinstance(value, list) else [value]


def _settling(document: Mapping[str, Any]) -> Iterator[str]:
    solver = document.get("solver", {})
    event_driven, steady = solver.get("method") == "event-driven", "settle" in solver
    if steady and not event_driven:
        yield 'solver.settle: "steady" needs solver.method = "event-driven"; or give settle_periods'
    if not solver.get("continuation"):
        return
    if not (event_driven and steady):
        yield (
            "solver.continuation: needs steady states, which only the event-driven solver finds; "
            'write method = "event-driven" and settle = "steady"'
        )
    if "case" in document.get("sweep", {}):
        yield (
            "solver.continuation: needs a grid, not a list of cases; "
            "write [sweep] with lists of frequencies and amplitudes"
        )
