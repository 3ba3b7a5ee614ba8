"""Long names of a dataset's variables, in the words of its system."""

from wedgesweep.config import Config
from wedgesweep.rotation import ROTATION
from wedgesweep.sweep.variables import FORCES_OF_FACES, OF_LIFT_OFF, variables_of

# Variables that only joints of a suspension have, and those that only unilateral ones have.
OF_JOINTS = (
    *("minimum_normal_force", "lift_off_fraction", "normal_force_column", "normal_force_bolster"),
    *FORCES_OF_FACES,
)
OF_UNILATERAL = tuple(variable.name for variable in OF_LIFT_OFF)
# Words of a suspension: ``x`` and its rates ``v`` and ``a``, of a ``body``, and its ``rest``; ``size``, over
# which amplitudes are taken; ``source`` of energy, which counts ``per`` period.
SUSPENSION = {
    **{"x": "x - y", "v": "x' - y'", "a": "x'' - y''", "body": "side frame minus bolster"},
    **{"rest": ", from frictionless rest", "size": "the input amplitude", "source": "the base"},
    **{"per": "per forcing period", "opened": "", "lifted": "the slipping time with a negative normal force"},
    "stuck": "stuck (coulomb) or with the column face below the threshold velocity",
}
# The words that are others for unilateral joints.
UNILATERAL = {
    **{"opened": ", 0 where a contact opens", "lifted": "time with at least one contact open"},
    "stuck": "stuck (coulomb) or with the column face closed and below the threshold velocity",
}


def attributes(config: Config) -> dict[str, str]:
    """Return the attributes that the dataset of an oscillator needs; none for the suspension.

    ``reference`` is what motions are compared with.
    """
    if config.system != "oscillator":
        return {}
    return {
        "system": config.system,
        "contact": config.oscillator["contact"],
        "excitation": config.excitation,
        "reference": "" if config.transient else _reference(config),
        **({"motion": ROTATION} if config.turns else {}),
    }


def long_names(config: Config) -> dict[str, str]:
    """Return the long names of the variables that the datasets of a config have, by name."""
    words, absent = {**SUSPENSION, **(UNILATERAL if config.opens else {})}, OF_UNILATERAL
    if config.system == "oscillator":
        words, absent = SUSPENSION | _of_oscillator(config), OF_UNILATERAL + OF_JOINTS
    elif config.opens:
        # The force takes wedge and bolster to move together, which they do not if a wedge lifts off.
        absent = ("force",)
    if config.transient:
        words["per"] = "in all"
    return {
        each.name: each.long_name.format(**words)
        for each in variables_of(config.transient)
        if each.name not in absent
    }


def _of_oscillator(config: Config) -> dict[str, str]:
    """Words of an oscillator."""
    contact = config.oscillator["contact"]
    base = " - u" if contact == "base" and not config.forced else ""
    rates = {name: f"x{dash}{base and base + dash}" for name, dash in (("x", ""), ("v", "'"), ("a", "''"))}
    return rates | {
        **{"body": "the mass", "rest": "", "size": "" if config.transient else _reference(config)},
        "source": "the input" + " and the belt" * (contact == "belt"),
        "stuck": "stuck (set-valued laws) or slipping below the threshold velocity",
    }


def _reference(config: Config) -> str:
    """What motions are compared with (see systems/oscillator/forces.py)."""
    if not config.forced:
        return "the amplitude of u"
    sprung = config.oscillator["spring"] > 0.0
    unforced = not config.sweep.amplitude.any() and "case" not in config.sweep.dims
    if unforced:
        return "belt velocity over " + ("omega_n" if sprung else "omega")
    return "force amplitude over " + ("k" if sprung else "m omega^2")
