"""Long names of a dataset's variables where they differ from those of a suspension with bilateral joints."""

from typing import TypedDict

from wedgesweep.config import Config
from wedgesweep.sweep.variables import OF_LIFT_OFF

# Variables that only datasets of unilateral joints have, and what others mean there.
_OF_LIFT_OFF: dict[str, str | None] = dict.fromkeys(variable.name for variable in OF_LIFT_OFF)
_OPEN: dict[str, str | None] = {
    "minimum_normal_force": "smallest normal force of either face while slipping, 0 where a contact opens",
    "lift_off_fraction": "share of time with at least one contact open",
    "stick_fraction": "share of time stuck (coulomb) or with the column face closed and below the "
    "threshold velocity",
}
# The same where the input does not repeat. ``force`` takes wedge and bolster to move together, which they do
# not if a wedge lifts off.
_OPEN_TRANSIENT: dict[str, str | None] = {
    "impacts": "impacts of a wedge in all",
    "impact_energy": "energy lost in impacts in all, beside dissipated_energy",
    "force": None,
}


class Attributes(TypedDict, total=False):
    """Global attributes of an oscillator's dataset; ``reference`` is what motions are compared with."""

    system: str
    contact: str
    excitation: str
    reference: str


def attributes(config: Config) -> Attributes:
    """Return the attributes that the dataset of an oscillator needs; none for the suspension."""
    if config.system != "oscillator":
        return {}
    return {
        "system": config.system,
        "contact": config.oscillator["contact"],
        "excitation": config.excitation,
        "reference": "" if config.transient else _reference(config),
    }


def long_names(config: Config) -> dict[str, str | None]:
    """Return the long names of variables by name, None for those that the system does not have."""
    if config.opens:
        return _OPEN | (_OPEN_TRANSIENT if config.transient else {})
    if config.system != "oscillator":
        return _OF_LIFT_OFF
    if config.transient:
        return _of_transient(config)
    contact = config.oscillator["contact"]
    relative = contact == "base" and not config.forced
    x, v = ("x - u", "x' - u'") if relative else ("x", "x'")
    size = _reference(config)
    return _OF_LIFT_OFF | {
        "amplitude_ratio": f"half peak-to-peak of {x} over {size}",
        "peak_to_peak": f"peak-to-peak of the displacement {x}",
        "peak_velocity": f"largest magnitude of the velocity {v}",
        "mean_displacement": f"mean of {x}",
        "stick_fraction": "share of time stuck (set-valued laws) or slipping below the threshold velocity",
        "displacement_harmonics": f"D_h of {x} = Re sum D_h exp(i h omega t)",
        "velocity_harmonics": f"V_h of {v} = Re sum V_h exp(i h omega t)",
        "phase_lag": f"lag of the fundamental of {x} behind the input",
        "supplied_energy": "energy supplied by the input"
        + " and the belt" * (contact == "belt")
        + " per period",
        "dissipated_energy": "energy dissipated by friction and dampers per period",
        "minimum_normal_force": None,
        "lift_off_fraction": None,
        "normal_force_column": None,
        "normal_force_bolster": None,
        "periodicity": f"largest change of {x} from the last period but one to the last, over {size}",
        "displacement": f"displacement {x} of the mass",
        "velocity": f"velocity {v} of the mass",
    }


def _of_transient(config: Config) -> dict[str, str | None]:
    """Long names of an oscillator whose input does not repeat."""
    contact = config.oscillator["contact"]
    relative = contact == "base" and not config.forced
    x = "x - u" if relative else "x"
    rates = ("x' - u'", "x'' - u''") if relative else ("x'", "x''")
    return _OF_LIFT_OFF | {
        "peak_displacement": f"largest magnitude of {x}",
        "peak_to_peak": f"peak-to-peak of {x}",
        "peak_velocity": f"largest magnitude of {rates[0]}",
        "mean_displacement": f"mean of {x}",
        "rms_displacement": f"rms of the stored samples of {x}",
        "stick_fraction": "share of time stuck (set-valued laws) or slipping below the threshold velocity",
        "supplied_energy": "energy supplied by the input" + " and the belt" * (contact == "belt") + " in all",
        "displacement": f"displacement {x} of the mass",
        "velocity": f"velocity {rates[0]} of the mass",
        "acceleration": f"acceleration {rates[1]} of the mass",
        "force": "force that spring, dampers and friction set against the motion of the mass",
        **dict.fromkeys(
            ("minimum_normal_force", "lift_off_fraction", "normal_force_column", "normal_force_bolster"), None
        ),
    }


def _reference(config: Config) -> str:
    """What motions are compared with (see systems/oscillator/forces.py)."""
    if not config.forced:
        return "the amplitude of u"
    sprung = config.oscillator["spring"] > 0.0
    unforced = not config.sweep.amplitude.any() and config.sweep.cases is None
    if unforced:
        return "belt velocity over " + ("omega_n" if sprung else "omega")
    return "force amplitude over " + ("k" if sprung else "m omega^2")
