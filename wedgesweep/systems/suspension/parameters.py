"""Everything that one case of the suspension depends on, as one value: a record in SI units.

The record is a one-element structured array with a part for each subject (``suspension``, ``friction``,
``input``, one for each effect, and ``geometry`` for what follows from them). Python always holds the full
record; compiled code gets the smallest sufficient kit of parts (``compact``), so that effects which are
off cost nothing, nor does the Fourier series of a recorded input (part ``series``).
"""

from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from math import cos, isfinite, sin
from types import MappingProxyType
from typing import Any

import numpy as np

from wedgesweep import effects as known
from wedgesweep import excitation
from wedgesweep import friction as laws
from wedgesweep.effects import base, jamming, lift_off
from wedgesweep.natural_units import VELOCITY, NaturalUnits, natural_units
from wedgesweep.quantity import Quantity
from wedgesweep.systems import records
from wedgesweep.systems.suspension.equilibrium import determinant, equilibrium

EQUATIONS = (
    "M_w (u'' e_z + r z'' t_c) = (F_w - M_w g) e_z - (N_c n_c + mu_c |N_c| t_c) + (N_b p_b - mu_b |N_b| t_b)",
    "M_b (u'' + z'') = F_b - M_b g - 2 (N_b p_b - mu_b |N_b| t_b) . e_z - 2 s_b F_w",
    "F_b = -k_b z + R",
    "F_w = F_w0 - k_w (r cos(gamma) - s_b) z",
)
SUSPENSION = (
    Quantity("bolster_mass_kg", 0.70, "mass of the bolster, M_b", above=0.0),
    Quantity("wedge_mass_kg", 0.17, "mass of one wedge, M_w", minimum=0.0),
    Quantity("side_frame_mass_kg", 0.46, "mass of the side frame, M_sf", above=0.0),
    Quantity("bolster_spring_N_per_mm", 5.10, "stiffness under the bolster, k_b", above=0.0),
    Quantity("wedge_spring_N_per_mm", 2.55, "stiffness under one wedge, k_w", minimum=0.0),
    Quantity("wedge_angle_deg", 37.5, "wedge angle from the vertical, alpha", above=0.0, below=90.0),
    Quantity(
        "column_angle_deg",
        4.0,
        "column angle, gamma; positive: the faces close upward",
        above=-45.0,
        below=45.0,
    ),
    Quantity("wedge_preload_N", 0.0, "force of each wedge spring at z = 0"),
    Quantity("gravity_m_per_s2", 9.80665, "acceleration of gravity", minimum=0.0),
    Quantity("wear_mm", 0.0, "wear of each column face", minimum=0.0),
)

# Numbers that follow from the others.
GEOMETRY = (
    "column_ratio",  # r: wedge travel along the column per z
    "bolster_ratio",  # q: slip on the bolster face per z'
    "sin_wedge",
    "cos_wedge",
    "sin_column",
    "cos_column",
    "sin_included",  # of alpha + gamma
    "cos_included",
    "column_slip_ratio",  # slip on the column face per Q
    "bolster_slip_ratio",  # slip on the bolster face per Q
    "lift_ratio",  # rise of a wedge per Q
    "rest",  # z of the frictionless equilibrium (m)
    "spring_on_bolster",  # 1 where the springs of the wedges stand on the bolster, 0: on the side frame
)
# Kinds of the paper's Figure 1: the spring of a wedge stands on the side frame, so that its force and thus
# friction vary with the load, or in a pocket of the bolster.
VARIABLE, CONSTANT = DAMPING = ("variable", "constant")

# Whether a contact between wedge and column or bolster can pull, or opens: then it is the effect lift_off.
BILATERAL, UNILATERAL = JOINTS = ("bilateral", "unilateral")
RESTITUTION = lift_off.EFFECT.quantities[0]
# Share of the band of rest that a wedge holds (rest.py): the effect jamming.
LOCKED_IN = jamming.EFFECT.quantities[0]

# Kits of parts, by the effects with mechanics of their own that they have room for: none; those that
# ``effects.register`` added; all; none, and those that go with unilateral joints, for joints that can open.
BASE, OWN, ALL, JOINTS_OPEN, JOINTS_OPEN_WITH_EFFECTS = range(5)
OPENING = JOINTS_OPEN, JOINTS_OPEN_WITH_EFFECTS
# Velocity (m/s) at which regularised Coulomb friction reaches mu_d, on the bench (see natural_units).
REGULARISED_VELOCITY = 1e-6


@cache
def _kits(names: tuple[str, ...], series: bool) -> tuple[np.dtype, ...]:
    """Record types by kit, with or without the part for an input that is not a sine.

    No type is the beginning of another: numba would mistake one for the other.
    """
    own = [name for name in names if name not in known.NAMES]
    plain = [name for name in names if not known.EFFECTS[name].extends and name not in own]
    go_with_opening = [*plain, *(name for name in names if name in lift_off.GO_WITH)]
    all_but_opening = [name for name in names if name != lift_off.NAME]
    opens = records.effect_parts([lift_off.NAME])
    part = records.SERIES if series else []
    return (
        _dtype(part, plain),
        _dtype(part, own + plain),
        _dtype(part, all_but_opening),
        _dtype(opens + part, plain),
        _dtype(opens + part, go_with_opening),
    )


def _dtype(marker: list[tuple], names: Iterable[str]) -> np.dtype:
    own = [(quantity.name, np.float64) for quantity in SUSPENSION]
    geometry = [
        ("kit", np.int64),
        ("opens", np.int64),  # whether contacts may open
        ("always_well_posed", np.int64),
        ("linear", np.int64),  # but for friction that depends on velocity
        ("each_face_well_posed", np.int64),  # with the other one open
        *((name, np.float64) for name in GEOMETRY),
    ]
    effects = records.effect_parts(names)
    return np.dtype([*marker, *effects, *records.COMMON, ("suspension", own), ("geometry", geometry)])


def effect_names() -> tuple[str, ...]:
    """Effects that a suspension may have, those that ``effects.register`` added among them."""
    return known.of_system(base.SUSPENSION)


def record_type() -> np.dtype:
    """Type of the full record, with all effects that are known now."""
    return _full_type(effect_names())


@cache
def _full_type(names: tuple[str, ...]) -> np.dtype:
    return _dtype(records.SERIES, names)


def record(
    law: str,
    amplitude: float,
    omega: float,
    suspension: Mapping[str, Any] = MappingProxyType({}),
    friction: Mapping[str, float] = MappingProxyType({}),
    effects: Mapping[str, Mapping[str, float]] = MappingProxyType({}),
) -> np.ndarray:
    """Parameters of one case; what is not given has its default (the paper's Table 1).

    Parameters
    ----------
    law : str
        Name of a friction law.
    amplitude, omega : float
        Of the input: m, rad/s.
    suspension, friction, effects : mapping
        SI numbers by the names of their quantities; ``damping`` of the suspension is one of DAMPING, its
        ``joints`` one of JOINTS, and ``restitution`` goes with unilateral ones. ``locked_in``: that of the
        effect jamming.

    Returns
    -------
    structured array, shape (1,)
        Of ``record_type()``.
    """
    names = effect_names()
    case = records.blank(_full_type(names), names)
    p = case[0]
    for quantity in SUSPENSION:
        p["suspension"][quantity.name] = suspension.get(quantity.name, quantity.default * quantity.factor)
    if suspension.get("joints") == UNILATERAL:
        restitution = suspension.get("restitution", RESTITUTION.default)
        effects = {**effects, lift_off.NAME: {"restitution": restitution}}
    if locked_in := suspension.get(LOCKED_IN.name):
        effects = {**effects, jamming.NAME: {LOCKED_IN.name: locked_in}}
    p["geometry"]["spring_on_bolster"] = suspension.get("damping") == CONSTANT
    nominal = p["suspension"].copy()
    records.set_common(case, law, friction, (amplitude, omega))
    records.set_effects(p, names, effects)
    p["suspension"]["wedge_preload"] -= p["suspension"]["wedge_spring"] * rise_by_wear(p["suspension"])
    acting = records.acting(p, names)
    p["geometry"]["kit"], p["geometry"]["opens"] = _kit_of(p, acting), has_unilateral_joints(p)
    if _needs_regularisation(p, acting):
        _regularise(p, nominal)
    prepare(case, acting)
    return case


def rise_by_wear(s: np.ndarray | np.void) -> np.ndarray:
    """Rise (m) of wedges along the bolster face, until they close the gaps of worn columns; any shape."""
    return s["wear"] * np.cos(s["wedge_angle"]) / np.sin(s["wedge_angle"] + s["column_angle"])


def has_unilateral_joints(rows: np.ndarray | np.void) -> np.ndarray:
    """Whether the joints of full records can open, of records of any shape."""
    return rows[lift_off.NAME]["restitution"] >= 0.0


def _kit_of(p: np.void, acting: Sequence[str]) -> int:
    acting = [name for name in acting if name != lift_off.NAME]
    if has_unilateral_joints(p):
        if refused := set(acting) - set(known.with_lift_off()):
            raise ValueError(f"effects that unilateral joints do not go with: {', '.join(sorted(refused))}")
        return JOINTS_OPEN_WITH_EFFECTS if acting else JOINTS_OPEN
    if not acting:
        return BASE
    return ALL if any(name in known.NAMES for name in acting) else OWN


def natural_units_of(suspension: Mapping[str, float] | np.void, travel: float | None = None) -> NaturalUnits:
    """Natural units of a suspension (SI numbers by name); ``travel`` (m): see ``natural_units``."""
    mass, stiffness = float(suspension["bolster_mass"]), float(suspension["bolster_spring"])
    return natural_units(mass, stiffness, float(suspension["gravity"]), travel)


def regularised_velocity(suspension: Mapping[str, float] | np.void) -> float:
    """Velocity (m/s) at which Coulomb friction that effects regularise reaches mu_d."""
    return REGULARISED_VELOCITY * natural_units_of(suspension).ratio(VELOCITY)


def is_regularised(p: np.void) -> bool:
    """Whether effects regularise the case's Coulomb law: it is a steep ramp then."""
    return _needs_regularisation(p, records.acting(p, effect_names()))


def _needs_regularisation(p: np.void, acting: Sequence[str]) -> bool:
    regularising = any(getattr(known.REGISTERED[name], "REGULARISES", False) for name in acting)
    return regularising and laws.LAWS["coulomb"].SET_VALUED and p["friction"]["law"] == laws.code("coulomb")


def _regularise(p: np.void, nominal: np.void) -> None:
    """Replace set-valued friction by a ramp up to mu_d, or up to the peak of ``stribeck``.

    ``nominal``: the suspension without effects, whose natural units decide on the width.
    """
    own = p["friction"]
    own["set_valued"], own["v_t"] = 0, regularised_velocity(nominal)
    if p["stribeck"]["velocity"] == 0.0:
        own["mu_s"] = own["mu_d"]


def prepare(case: np.ndarray, acting: Sequence[str]) -> None:
    """Fill in the geometry of a record, shape (1,), in place; ``acting``: effects with their own mechanics.

    The equilibrium is NaN where the springs have none (a cubic stiffness far below zero).
    """
    p, s = case[0]["geometry"], case[0]["suspension"]
    included = s["wedge_angle"] + s["column_angle"]
    p["sin_wedge"], p["cos_wedge"] = sin(s["wedge_angle"]), cos(s["wedge_angle"])
    p["sin_column"], p["cos_column"] = sin(s["column_angle"]), cos(s["column_angle"])
    p["sin_included"], p["cos_included"] = sin(included), cos(included)
    p["column_ratio"] = p["sin_wedge"] / p["sin_included"]
    p["bolster_ratio"] = -p["sin_column"] / p["sin_included"]
    p["column_slip_ratio"] = p["cos_wedge"] / p["sin_included"]
    p["bolster_slip_ratio"] = p["cos_column"] / p["sin_included"]
    p["lift_ratio"] = p["cos_column"] * p["cos_wedge"] / p["sin_included"]
    small = compact(case)[0]
    p["rest"], case[0]["column_compliance"]["rest"] = equilibrium(small)
    if case[0]["load_dependent_friction"]["reference"] == 0.0:
        case[0]["load_dependent_friction"]["reference"] = _column_force_at_rest(case[0])
    most = _largest_coefficient(case[0], acting)
    p["each_face_well_posed"] = _each_face_well_posed(most, case[0])
    p["always_well_posed"] = _always_well_posed(most, case[0], small)
    p["linear"] = p["always_well_posed"] and all(records.is_linear(name) for name in acting)


def _column_force_at_rest(p: np.void) -> float:
    """Normal force (N) on the column face of the frictionless equilibrium; 1 where it carries nothing."""
    s, g = p["suspension"], p["geometry"]
    load = spring_at_rest(p) - s["wedge_mass"] * s["gravity"]
    return abs(float(load * g["cos_wedge"] / g["sin_included"])) or 1.0


def spring_at_rest(rows: np.ndarray | np.void) -> np.ndarray:
    """Force (N) of each wedge's spring in the frictionless equilibrium, of records of any shape."""
    s, g = rows["suspension"], rows["geometry"]
    rise = g["column_ratio"] * g["cos_column"] * g["rest"]
    rise = rise + g["lift_ratio"] * rows["column_compliance"]["rest"] - g["spring_on_bolster"] * g["rest"]
    return s["wedge_preload"] - s["wedge_spring"] * rise


def _largest_coefficient(p: np.void, acting: Sequence[str]) -> float:
    """A bound of |mu| at any slip velocity; NaN where none is known."""
    most = float(list(laws.LAWS.values())[p["friction"]["law"]].bound(p))
    for name in acting:
        bound = getattr(known.REGISTERED[name], "bound", None)
        most = float(bound(most, p)) if bound else most
    return most


def _always_well_posed(most: float, p: np.void, small: np.void) -> bool:
    """Whether every load has exactly one pair of normal forces, for any |mu| <= ``most``.

    Newton's equations with |N| are linear on each quadrant of (N_c, N_b), and such a map is one-to-one if
    and only if its four determinants have the same sign (Samelson, Thrall and Wesler, 1958). They are
    linear in each coefficient of friction, so that the extreme coefficients decide. Joints that open are a
    linear complementarity problem, which needs the same of each face alone.
    """
    if not isfinite(most) or (has_unilateral_joints(p) and not p["geometry"]["each_face_well_posed"]):
        return False
    corners = ((most, most), (most, -most), (-most, most), (-most, -most))
    return all(determinant(column, bolster, small) > 0.0 for column, bolster in corners)


def _each_face_well_posed(most: float, p: np.void) -> bool:
    """Whether each face alone has exactly one normal force under any load, for any |mu| <= ``most``.

    That of the column may have several only if the side frame moves.
    """
    s, g = p["suspension"], p["geometry"]
    lift = g["sin_wedge"] * (g["sin_wedge"] - most * abs(g["cos_wedge"]))
    bolster = s["bolster_mass"] + 2.0 * s["wedge_mass"] * lift
    if p["fixture_resonance"]["frequency"] == 0.0:
        return bool(bolster > 0.0)
    lean = abs(g["sin_column"])
    column = s["side_frame_mass"] + 2.0 * s["wedge_mass"] * lean * (lean - most * g["cos_column"])
    return bool(min(bolster, column) > 0.0)


def compact(rows: np.ndarray) -> np.ndarray:
    """Full records, shape (n,), as records of the smallest kit for all of them, for compiled code."""
    kits = _kits(effect_names(), bool(excitation.has_series(rows).any()))
    return records.converted(rows, kits[int(rows["geometry"]["kit"].max(initial=BASE))])


def driven_mass(rows: np.ndarray) -> np.ndarray:
    """Mass (kg) that the base acceleration drives, M_b + 2 M_w r cos(gamma), of records of any shape."""
    s, g = rows["suspension"], rows["geometry"]
    return s["bolster_mass"] + 2.0 * s["wedge_mass"] * g["column_ratio"] * g["cos_column"]


def moving_mass(rows: np.ndarray) -> np.ndarray:
    """Mass (kg) that moves with z', M_b + 2 M_w r^2, of records of any shape."""
    s, g = rows["suspension"], rows["geometry"]
    return s["bolster_mass"] + 2.0 * s["wedge_mass"] * g["column_ratio"] ** 2
