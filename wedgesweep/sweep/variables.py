"""The variables of the datasets of sweeps, and the records of cases that hold them."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from wedgesweep.outcome import Outcome

STATUSES = tuple(map(str, Outcome))
HARMONICS = 9


@dataclass(frozen=True)
class Variable:
    """A variable of the dataset; ``dims`` follow the case dimensions.

    ``long_name`` has places for the words of a system (see ``labels.py``).
    """

    name: str
    units: str
    long_name: str
    dims: tuple[str, ...] = ()
    dtype: str = "f8"


PHASE = ("phase",)
SPECTRUM = ("harmonic", "part")

# Normal forces of one wedge, by name, with their long names.
FORCES_OF_FACES = {
    f"{face}_force_{name}": f"{word} normal force on the {face} face of a wedge while slipping"
    for face in ("column", "bolster")
    for name, word in (("mean", "mean"), ("min", "smallest"), ("max", "largest"))
}

VARIABLES = (
    Variable("amplitude_ratio", "1", "half peak-to-peak of {x} over {size}"),
    Variable("peak_to_peak", "m", "peak-to-peak of {x}"),
    Variable("peak_velocity", "m s-1", "largest magnitude of {v}"),
    Variable("mean_displacement", "m", "mean of {x}{rest}"),
    Variable("stick_fraction", "1", "share of time {stuck}"),
    Variable("stick_phases", "1", "number of sticking phases per forcing period"),
    Variable("displacement_harmonics", "m", "D_h of {x} = Re sum D_h exp(i h omega t)", SPECTRUM),
    Variable("velocity_harmonics", "m s-1", "V_h of {v} = Re sum V_h exp(i h omega t)", SPECTRUM),
    Variable("phase_lag", "rad", "lag of the fundamental of {x} behind the input"),
    Variable("dissipated_energy", "J", "energy dissipated by friction and dampers {per}"),
    Variable("supplied_energy", "J", "energy supplied by {source} {per}"),
    Variable("minimum_normal_force", "N", "smallest normal force of either face while slipping{opened}"),
    *(Variable(name, "N", about) for name, about in FORCES_OF_FACES.items()),
    Variable("lift_off_fraction", "1", "share of {lifted}"),
    Variable(
        "periodicity", "1", "largest change of {x} from the last period but one to the last, over {size}"
    ),
    Variable(
        "period",
        "1",
        "period of the response in forcing periods; 0: it did not repeat, -1: not looked for",
        dtype="i2",
    ),
    Variable("settled_periods", "1", "forcing periods run before the kept ones", dtype="i8"),
    Variable("status", "1", "outcome of the case", dtype="i1"),
    Variable("message", "", "reason of a failure, empty otherwise", dtype="str"),
    Variable("rate_evaluations", "1", "calls of the right-hand side; power series count as one", dtype="i8"),
    Variable("steps", "1", "steps of the integrator", dtype="i8"),
    Variable("switches", "1", "located switches between slip branches", dtype="i8"),
    Variable("wall_time", "s", "wall time of the case"),
    Variable("displacement", "m", "displacement {x} of {body}{rest}", PHASE, "f4"),
    Variable("velocity", "m s-1", "velocity {v} of {body}", PHASE, "f4"),
    Variable("normal_force_column", "N", "normal force on the column face", PHASE, "f4"),
    Variable("normal_force_bolster", "N", "normal force on the bolster face", PHASE, "f4"),
    Variable("stuck", "1", "1 where stuck, as counted by stick_fraction", PHASE, "i1"),
)

WAVEFORMS = tuple(variable.name for variable in VARIABLES if variable.dims == PHASE)

# Additional variables of unilateral joints.
OF_LIFT_OFF = (
    Variable("column_open_fraction", "1", "share of time with the column contact open"),
    Variable("bolster_open_fraction", "1", "share of time with the bolster contact open"),
    Variable("impacts", "1", "impacts of a wedge {per}"),
    Variable("largest_impulse", "N s", "largest normal impulse of an impact, on one wedge"),
    Variable("impact_energy", "J", "energy lost in impacts {per}, beside dissipated_energy"),
)

# Within a case of a motion that does not repeat.
TIME = ("time",)
_SHARED = (
    *("stick_fraction", "dissipated_energy", "supplied_energy", "minimum_normal_force", *FORCES_OF_FACES),
    "lift_off_fraction",
    *("status", "message", "rate_evaluations", "steps", "switches", "wall_time"),
)
_NAMED = {variable.name: variable for variable in VARIABLES}
# Variables of a dataset whose input does not repeat, after those that are the same.
TRANSIENT = (
    Variable("peak_displacement", "m", "largest magnitude of {x}"),
    *(_NAMED[name] for name in ("peak_to_peak", "peak_velocity", "mean_displacement")),
    Variable("rms_displacement", "m", "rms of the stored samples of {x}"),
    *(_NAMED[name] for name in _SHARED),
    *(replace(_NAMED[name], dims=TIME, dtype="f8") for name in ("displacement", "velocity")),
    Variable("acceleration", "m s-2", "acceleration {a} of {body}", TIME),
    Variable("force", "N", "force that springs, dampers and friction set against {x}", TIME),
    *(replace(_NAMED[name], dims=TIME) for name in ("normal_force_column", "normal_force_bolster", "stuck")),
    *OF_LIFT_OFF,
)

# Additional variables of a continuation; all others belong to its sweep up in beta. Two responses are
# distinct if their amplitude ratios differ by more than DISTINCT times steady_tolerance, or their periods.
DISTINCT = 1000.0
CONTINUED = (
    Variable("amplitude_ratio_down", "1", "amplitude_ratio on the way down in beta"),
    Variable("period_down", "1", "period on the way down in beta", dtype="i2"),
    Variable(
        "coexisting",
        "1",
        "whether the ways up and down in beta end in different responses: periods differ, or amplitude "
        f"ratios by more than {DISTINCT:g} steady_tolerance; not told where one did not repeat or failed",
        dtype="i1",
    ),
)
# Flag variables: first value, and the meanings of the values from there on.
FLAGS = {"status": (0, STATUSES), "coexisting": (-1, ("not_told", "no", "yes"))}

GRID = ("friction_law", "beta", "amplitude")
# Case dimensions where the input does not repeat.
SCALED = ("friction_law", "scale")
REQUIRED = ("status", "message", "period", "periodicity")
MESSAGE_BYTES = 200


def variables_of(transient: bool, continued: bool = True) -> tuple[Variable, ...]:
    """All variables that a dataset may have: of an input that does not repeat, or of sines."""
    return TRANSIENT if transient else VARIABLES + OF_LIFT_OFF + CONTINUED * continued


def record_dtype(sizes: Mapping[str, int], continued: bool = False) -> np.dtype:
    """Layout of the record of a case: its index and every variable, with dimensions from ``sizes``.

    Without samples (``sizes`` of "phase" or "time" 0) there are no waveforms; ``continued`` adds CONTINUED.
    """
    fields: list[tuple[Any, ...]] = [("index", "i8")]
    for variable in variables_of("time" in sizes, continued):
        if variable.dims in (PHASE, TIME) and not sizes[variable.dims[0]]:
            continue
        dtype = f"S{MESSAGE_BYTES}" if variable.dtype == "str" else variable.dtype
        fields.append((variable.name, dtype, tuple(sizes[dim] for dim in variable.dims)))
    return np.dtype(fields)


def blank(dtype: np.dtype, indices: np.ndarray) -> np.ndarray:
    """Records of cases without results: NaN, zero counts, status not_run."""
    records = np.zeros(len(indices), dtype)
    for name in dtype.names or ():
        if dtype[name].base.kind == "f":
            records[name] = np.nan
    records["index"] = indices
    for name in {"period", "period_down", "coexisting"} & set(dtype.names or ()):
        records[name] = -1
    records["status"] = Outcome.NOT_RUN
    return records
