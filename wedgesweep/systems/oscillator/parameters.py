"""Everything that one case of the oscillator depends on, as one value: a record in SI units.

As for the suspension, Python holds the full record, and compiled code gets the smallest of three kits:
without effects that add forces, coefficients, states or events of their own, with all effects but that of
many states, or with all; with or without the Fourier series of a recorded input.
"""

from collections.abc import Iterable, Mapping
from functools import cache
from math import nan, sqrt
from types import MappingProxyType
from typing import Any

import numpy as np

from wedgesweep import effects as known
from wedgesweep.effects import base, load_dependent_friction
from wedgesweep.excitation import has_series
from wedgesweep.friction import code
from wedgesweep.friction import lugre_bristles as bristles
from wedgesweep.quantity import Quantity
from wedgesweep.systems import records
from wedgesweep.systems.oscillator import pendulum

EQUATIONS = ("m x'' + c (x' - u') + k (x - u) + mu N = F + R",)
OSCILLATOR = (
    Quantity("mass_kg", nan, "mass, m", above=0.0),
    Quantity("spring_N_per_mm", nan, "stiffness of the spring, k; 0: none", minimum=0.0),
    Quantity("damping_N_s_per_m", 0.0, "viscous damping beside the spring, c", minimum=0.0),
    Quantity("normal_force_N", 0.0, "normal force on the rubbing surface, N", minimum=0.0),
)
# Share of the input that acts, as behind a lever.
COUPLING = Quantity("input_coupling", nan, "share of the input that acts, as behind a driver arm", above=0.0)
BELT_VELOCITY = Quantity("belt_velocity_mm_per_s", nan, 'velocity of the belt, for contact = "belt"')
# Numbers of the bristles of the law "lugre".
BRISTLES = (
    Quantity("bristle_stiffness_N_per_mm", nan, 'stiffness of bristles, sigma_0, for "lugre"', above=0.0),
    Quantity("bristle_damping_N_s_per_m", nan, "damping of bristles, sigma_1; default: 0", minimum=0.0),
    Quantity(
        "bristle_viscous_N_s_per_m", nan, "viscous friction beside them, sigma_2; default: 0", minimum=0.0
    ),
)
# The bristles are a state, and a pendulum's sine is a force, as effects have them.
known.REGISTERED[bristles.NAME] = bristles
known.REGISTERED[pendulum.NAME] = pendulum
# How the restoring force grows with the displacement.
LINEAR, PENDULUM = RESTORING = ("linear", pendulum.NAME)
# What the rubbing surface moves with, and what the input moves.
BASE, GROUND, BELT = CONTACTS = ("base", "ground", "belt")
FORCE = "force"
EXCITATIONS = (BASE, FORCE)

# Effects that scale a number of the oscillator.
SCALED = {"bolster_stiffness": "spring", "bolster_mass": "mass", "damping_level": "damping"}
# An effect that scales the coefficients of friction, and all that have no part of their own in a record.
OF_LOAD = load_dependent_friction.EFFECT.name
ADJUSTED = (*SCALED, OF_LOAD)
# A motion of the base beside the input.
OF_BASE = "stray_vibration"
# Effects on the spring.
OF_SPRING = ("bolster_stiffness", "asymmetric_spring", "backlash")
# Friction beside that of the normal force, and effects on the latter.
LATERAL = "guide_friction"
# The first two scale its coefficients, the others change the law.
OF_FRICTION = (
    *("friction_level", "thermal_drift", "stribeck", "presliding", "ageing", "directional_friction"),
    "position_friction",
)
# Those that need a rod between the mass and what damps it, and those of them behind which all damping is.
OF_ROD = ("damper_play", "series_compliance", "maxwell_presliding")
WITH_DAMPING = ("series_compliance", "maxwell_presliding")
# Its states would slow down all other effects: it has a kit of its own.
OF_MANY_STATES = "maxwell_presliding"
# Effects that a law has no place for.
OF_LAW = {
    "lugre": ("stribeck", "presliding", "ageing", "guide_friction", *OF_ROD),
    "hyperbolic": ("stribeck",),
}
# Marks records of the kit without effects that have mechanics of their own.
PLAIN = "plain_oscillator"


def effect_names() -> tuple[str, ...]:
    """Effects that an oscillator may have, those that ``effects.register`` added among them."""
    return known.of_system(base.OSCILLATOR)


@cache
def _kits(names: tuple[str, ...], series: bool) -> tuple[np.dtype, np.dtype, np.dtype]:
    """Record types by kit, with or without the Fourier series of an input."""
    simple = [name for name in names if not known.EFFECTS[name].extends]
    part = records.SERIES if series else []
    more = [(own.NAME, [(name, np.float64) for name in own.NUMBERS]) for own in (bristles, pendulum)]
    few = [name for name in names if name != OF_MANY_STATES]
    kits = ([(PLAIN, np.int64), *part], simple), ([*part, *more], few), ([*part, *more], names)
    plain, most, everything = (_dtype(*each) for each in kits)
    return plain, most, everything


def _dtype(parts: list[tuple], names: Iterable[str]) -> np.dtype:
    # ``linear``: but for friction that depends on velocity; ``absolute``: the displacement is against the
    # ground, not against the base.
    own: list[tuple] = [(name, np.int64) for name in ("kit", "linear", "absolute", "forced")]
    own += [("belt_velocity", np.float64)]
    own += [(quantity.name, np.float64) for quantity in OSCILLATOR]
    effects = records.effect_parts(name for name in names if name not in ADJUSTED)
    return np.dtype([*parts, *effects, *records.COMMON, ("oscillator", own)])


def record_type() -> np.dtype:
    """Type of the full record."""
    return _kits(effect_names(), True)[-1]


def record(
    law: str,
    amplitude: float,
    omega: float,
    oscillator: Mapping[str, float | str],
    friction: Mapping[str, float] = MappingProxyType({}),
    effects: Mapping[str, Mapping[str, float]] = MappingProxyType({}),
    input_kind: str = BASE,
) -> np.ndarray:
    """Parameters of one case.

    Parameters
    ----------
    law : str
        Name of a friction law.
    amplitude, omega : float
        Of the input: m, or N under a force; rad/s.
    oscillator : mapping
        SI numbers by the names of their quantities; ``contact`` is one of CONTACTS (default: base),
        ``belt_velocity`` (m/s) goes with a belt, and those of BRISTLES with the law "lugre";
        ``restoring_force`` is one of RESTORING (default: linear), and ``nominal_load`` (N) the normal force
        at which coefficients are the nominal ones.
    friction, effects : mapping
        SI numbers by the names of their quantities; what is not given has its default.
    input_kind : str
        Whether the base moves or a force acts on the mass.

    Returns
    -------
    structured array, shape (1,)
        Of ``record_type()``.
    """
    names = effect_names()
    case = records.blank(_kits(names, True)[-1], names)
    p = case[0]
    contact, own = oscillator.get("contact", BASE), p["oscillator"]
    for quantity in OSCILLATOR:
        own[quantity.name] = oscillator.get(quantity.name, quantity.default * quantity.factor)
    own["absolute"], own["forced"] = contact != BASE, input_kind == FORCE
    own["belt_velocity"] = oscillator["belt_velocity"] if contact == BELT else 0.0
    records.set_common(case, law, friction, (amplitude, omega))
    for name in SCALED:
        own[SCALED[name]] *= effects.get(name, {}).get("scale", 1.0)
    parts = [name for name in names if name not in ADJUSTED]
    records.set_effects(p, parts, effects)
    _scale_friction(p, oscillator, effects.get(OF_LOAD, {}))
    swings = oscillator.get("restoring_force") == PENDULUM
    p["input_gain"]["scale"] *= oscillator.get(COUPLING.name, 1.0)
    p[pendulum.NAME]["stiffness"] = own["spring"] if swings else 0.0
    acting = records.acting(p, parts)
    own["kit"] = 2 if OF_MANY_STATES in acting else bool(acting) or law == bristles.NAME or swings
    plain_spring = law != bristles.NAME and not swings
    own["linear"] = plain_spring and all(records.is_linear(name) for name in acting)
    if law == bristles.NAME:
        _set_bristles(p, oscillator)
    if p["presliding"]["length"] > 0.0 or p["series_compliance"]["stiffness"] > 0.0:
        p["friction"]["set_valued"] = 0  # bristles and springs yield before they slip
    return case


def _scale_friction(p: np.void, oscillator: Mapping[str, Any], numbers: Mapping[str, float]) -> None:
    """Scale the coefficients of friction of a record by its normal force, in place."""
    normal = float(p["oscillator"]["normal_force"])
    factor = load_dependent_friction.factor(numbers, normal, oscillator.get("nominal_load", normal))
    for name in ("mu_s", "mu_d"):
        p["friction"][name] *= factor


def _set_bristles(p: np.void, oscillator: Mapping[str, Any]) -> None:
    """Fill in the bristles of a record, in place."""
    for quantity in BRISTLES:
        name = quantity.name.removeprefix("bristle_")
        p[bristles.NAME][name] = oscillator.get(quantity.name, 0.0)
    p[bristles.NAME]["coulomb"] = p["friction"]["mu_d"] * p["oscillator"]["normal_force"]


def compact(rows: np.ndarray) -> np.ndarray:
    """Full records, shape (n,), as records of the smallest kit for all of them, for compiled code."""
    kits = _kits(effect_names(), bool(has_series(rows).any()))
    return records.converted(rows, kits[int(rows["oscillator"]["kit"].max(initial=0))])


def resonance(p: np.void) -> float:
    """Angular frequency (rad/s) without friction and damping."""
    return sqrt(p["oscillator"]["spring"] / p["oscillator"]["mass"])


def breakaway_acceleration(p: np.void) -> float:
    """Amplitude of the base's acceleration (m/s^2) at which set-valued friction slips from rest.

    NaN where friction holds the mass to something else than the base, where nothing but a force moves it, and
    where an effect changes the law of friction.
    """
    own = p["oscillator"]
    if own["absolute"] or own["forced"] or _changes_friction(p):
        return nan
    return _breakaway_force(p) / float(own["mass"])


def friction_decay(p: np.void) -> float:
    """What a free motion loses a cycle by dry friction, 4F/k (m).

    NaN without a spring, and where dry friction is not constant.
    """
    spring = float(p["oscillator"]["spring"])
    if not spring or p["friction"]["law"] == code("hyperbolic") or _changes_friction(p):
        return nan
    return 4.0 * _breakaway_force(p) / spring


def _changes_friction(p: np.void) -> bool:
    """Whether an effect or bristles change the law of friction."""
    return bool(records.acting(p, (*OF_FRICTION[2:], *OF_ROD))) or bool(p[bristles.NAME]["stiffness"])


def _breakaway_force(p: np.void) -> float:
    """Force (N) at which set-valued friction lets go."""
    name = "mu_s" if p["friction"]["law"] == code("hyperbolic") else "mu_d"
    return float(p["friction"][name] * p["oscillator"]["normal_force"] + p["guide_friction"]["force"])
