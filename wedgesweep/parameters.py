"""Everything that one case's physics depends on, as one value: a record in SI units.

The record is a one-element structured array, so that Python and compiled code share it at no cost.
"""

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np

from wedgesweep import damper, effects
from wedgesweep.effects import EXTENDING
from wedgesweep.extended import rest
from wedgesweep.friction import LAW_NAMES, LAWS
from wedgesweep.quantity import Quantity

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
)

FRICTION = (
    Quantity("dynamic", 0.29, "coefficient of dynamic friction, mu_d", minimum=0.0),
    Quantity("static", 0.32, "coefficient of static friction, mu_s", minimum=0.0),
    Quantity("threshold_velocity_mm_per_s", 1.0, "end of the sticking branch, v_t", above=0.0),
    Quantity(
        "velocity_exponent",
        -0.1,
        "decay of the exponential law above v_t",
        minimum=-1.0,
        maximum=1.0,
    ),
)

# ``stray_vibration_phase`` (rad) is another one in every measurement.
CASE = ("law", "amplitude", "omega", "stray_vibration_phase")

# Numbers that follow from the ones above; ``record`` and ``damper.prepare`` fill them in.
DERIVED = (
    "set_valued",  # 1 for a law that is set-valued at rest
    "column_ratio",  # r: wedge travel along the column per z
    "bolster_ratio",  # q: slip on the bolster face per z'
    "sin_wedge",
    "cos_wedge",
    "sin_column",
    "cos_column",
    "sin_included",  # of alpha + gamma
    "cos_included",
    "never_locks",  # 1 if the normal forces are unique whatever the state
    "rest",  # z of the frictionless equilibrium
    "column_rest",  # Q of the frictionless equilibrium
    "column_slip_ratio",  # slip on the column face per Q
    "bolster_slip_ratio",  # slip on the bolster face per Q
    "lift_ratio",  # rise of a wedge per Q
    "column_damping",  # of a column (N s/m)
    "fixture_stiffness",  # of the side frame on its table (N/m)
    "fixture_damping",  # N s/m
    "extended",  # 1 if an effect needs more than the base model's mechanics
)

# Under the Coulomb law these effects let the faces stick one at a time; they are regularised instead.
REGULARISING = ("cross_slip_velocity", "column_compliance_stiffness")
REGULARISED_VELOCITY = 1e-6  # m/s

EFFECTS_OFF = effects.neutral()


def _fields() -> list[str]:
    config = [quantity.name for quantity in SUSPENSION + FRICTION]
    return [*config, *EFFECTS_OFF, *CASE, *DERIVED]


RECORD = np.dtype([(name, np.float64) for name in _fields()])


def record(
    law: str,
    amplitude: float,
    omega: float,
    suspension: Mapping[str, float] = MappingProxyType({}),
    friction: Mapping[str, float] = MappingProxyType({}),
    effects: Mapping[str, Mapping[str, float]] = MappingProxyType({}),
) -> np.ndarray:
    """Parameters of one case, shape (1,); what is not given has its default (the paper's Table 1).

    ``amplitude`` in m, ``omega`` in rad/s; the mappings hold SI numbers by their quantities' names.
    """
    case = np.zeros(1, RECORD)
    for quantity in SUSPENSION + FRICTION:
        case[quantity.name] = quantity.default * quantity.factor
    values = {**EFFECTS_OFF, **suspension, **friction, "amplitude": amplitude, "omega": omega}
    for name, effect in effects.items():
        values |= {f"{name}_{quantity}": value for quantity, value in effect.items()}
    for name, value in values.items():
        case[name] = value
    case["law"] = LAW_NAMES.index(law)
    case["set_valued"] = LAWS[law].SET_VALUED
    case["extended"] = any(case[name][0] != EFFECTS_OFF[name] for name in EXTENDING)
    _change_parameters(case[0])
    if is_regularised(case[0]):
        _regularise(case[0])
    damper.prepare(case[0])
    if case["extended"][0]:
        rest.prepare(case[0])
    return case


def _change_parameters(p: np.void) -> None:
    """Put the effects of the parameters family in place; omega_n is the caller's and stays nominal."""
    p["bolster_spring"] *= p["bolster_stiffness_scale"]
    p["wedge_spring"] *= p["wedge_stiffness_scale"]
    p["bolster_mass"] *= p["bolster_mass_scale"]
    p["wedge_preload"] += p["preload_force"]
    p["static"] *= p["friction_level_scale"]
    p["dynamic"] *= p["friction_level_scale"]


def is_regularised(p: np.void) -> bool:
    """Whether effects turn the case's Coulomb law into a steep ramp (over 1e-3 mm/s)."""
    return p["law"] == LAW_NAMES.index("coulomb") and any(p[name] != 0.0 for name in REGULARISING)


def _regularise(p: np.void) -> None:
    """Replace set-valued friction by a ramp up to mu_d, or up to the peak of ``stribeck``."""
    p["set_valued"], p["threshold_velocity"] = 0.0, REGULARISED_VELOCITY
    if p["stribeck_velocity"] == 0.0:
        p["static"] = p["dynamic"]
