"""Physics that the base model leaves out: one effect per file, each off at its neutral value."""

from collections.abc import Iterable, Mapping, Sequence
from importlib import import_module
from types import ModuleType

from wedgesweep import kernels
from wedgesweep.effects import lift_off
from wedgesweep.effects.base import SUSPENSION, Effect

# Numbers of effects by name, in SI units or in those of their keys.
Numbers = Mapping[str, Mapping[str, float]]

# In the order of families in which a diagnosis lists them.
NAMES = (
    *("bolster_stiffness", "wedge_stiffness", "bolster_mass", "preload", "friction_level", "damping_level"),
    *("stribeck", "presliding", "ageing", "directional_friction", "load_dependent_friction"),
    *("position_friction", "thermal_drift"),
    *("cross_slip", "column_compliance"),
    lift_off.NAME,
    *("jamming", "damper_play", "series_compliance"),
    *("viscous_damping", "directional_damping", "quadratic_drag", "degressive_damping"),
    *("cubic_stiffness", "asymmetric_spring", "backlash", "guide_friction", "maxwell_presliding", "end_stop"),
    "empirical_force",
    *("input_distortion", "stray_vibration", "fixture_resonance"),
    *("velocity_lag", "displacement_gain", "input_gain", "force_gain", "channel_delay"),
)
# The modules of all effects by name; ``register`` adds one that is not of this package.
REGISTERED: dict[str, ModuleType] = {name: import_module(f"{__name__}.{name}") for name in NAMES}
EFFECTS: dict[str, Effect] = {name: module.EFFECT for name, module in REGISTERED.items()}

FAMILIES = tuple(dict.fromkeys(effect.family for effect in EFFECTS.values()))

# The family of effects that are numbers of the model.
OF_THE_MODEL = "parameters"
# Effects that do nothing but scale a number.
SCALES = tuple(
    name for name, effect in EFFECTS.items() if [each.name for each in effect.quantities] == ["scale"]
)


def register(module: ModuleType) -> None:
    """Add an effect from a module of one's own, which declares ``EFFECT`` and takes part in hooks.py."""
    kernels.register(module)
    REGISTERED[module.EFFECT.name] = module
    EFFECTS[module.EFFECT.name] = module.EFFECT


def candidates() -> tuple[str, ...]:
    """Names of the effects that a diagnosis looks for."""
    return tuple(name for name, effect in EFFECTS.items() if effect.searched)


def of_system(system: str) -> tuple[str, ...]:
    """Names of the effects that a system may have, those from ``register`` among them."""
    return tuple(name for name, effect in EFFECTS.items() if system in effect.systems)


def merge(own: Numbers, added: Numbers) -> dict[str, dict[str, float]]:
    """Numbers of effects with others beside them, or in their place; what scales a number scales it again.

    The operating condition of an effect (the temperature of a test) stays what it is.
    """
    scaled = {
        name: {"scale": own.get(name, {}).get("scale", 1.0) * added[name]["scale"]}
        for name in SCALES
        if name in added
    }
    return {
        name: {**numbers, **_conditions(name, own.get(name, {}))}
        for name, numbers in {**own, **added, **scaled}.items()
    }


def _conditions(name: str, numbers: Mapping[str, float]) -> dict[str, float]:
    """An effect's operating condition and its reference, by name or by key: no fit looks for them."""
    if EFFECTS[name].condition is None:
        return {}
    stated = {each for q in EFFECTS[name].quantities if q.search is None for each in (q.key, q.name)}
    return {key: value for key, value in numbers.items() if key in stated}


def confounded(names: Sequence[str]) -> bool:
    """Whether effects are several numbers of the model at once.

    Masses, stiffnesses and forces that grow alike leave every response as it is, so that two of them that are
    off look like a third: one that is no candidate, as the wedge's mass, may be.
    """
    return len(names) > 1 and {EFFECTS[name].family for name in names} == {OF_THE_MODEL}


def with_lift_off() -> tuple[str, ...]:
    """Names of the effects that joints which lift off go with."""
    return tuple(
        name for name in of_system(SUSPENSION) if name in lift_off.GO_WITH or not EFFECTS[name].extends
    )


def go_together(names: Iterable[str]) -> bool:
    """Whether one model can have all of these effects."""
    together = set(names)
    if any(together.intersection(EFFECTS[name].excludes) for name in together):
        return False
    return lift_off.NAME not in together or together <= {lift_off.NAME, *with_lift_off()}


def parts(names: Sequence[str]) -> set[str]:
    """Effects with their special cases."""
    return {*names, *(part for name in names if name in EFFECTS for part in EFFECTS[name].contains)}


def acting(effects: Numbers) -> dict[str, dict[str, float]]:
    """Effects that change anything: a table with neutral values has switched nothing on."""
    return {name: dict(numbers) for name, numbers in effects.items() if EFFECTS[name].acts(numbers)}
