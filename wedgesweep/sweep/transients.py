"""Cases whose input does not repeat: a whole motion becomes a record, and its times coordinates."""

from collections.abc import Mapping, Sequence
from math import inf, nan
from typing import Any

import numpy as np

from wedgesweep import response, simulate
from wedgesweep.effects import stray_vibration
from wedgesweep.inputs import sine_sweep
from wedgesweep.inputs.sampled import Input
from wedgesweep.simulate import Settings, Transient
from wedgesweep.solvers.trajectory import CaseError, Trajectory
from wedgesweep.systems import driven_mass, is_oscillator, moving_mass, opens

# Effects with a body of their own that drives the mass, and the numbers that are above 0 where they act.
DRIVING = (("fixture_resonance", "frequency"), ("column_compliance", "stiffness"))


def solve_case(case: np.ndarray, settings: Settings, record: np.void) -> None:
    """Run a case, shape (1,), whose input amplitude is the scale, into a record. Raises CaseError."""
    given = settings.transient
    if given is None:
        raise ValueError("settings without an input")
    run = simulate.transient(case, given, float(case["input"]["amplitude"][0]), settings)
    if not np.isfinite(run.samples.x).all():
        raise CaseError("the motion is not finite", "not_finite")
    x, velocity = response.sensed(run.samples.x, run.samples.velocity, given.span / given.samples, case)
    waveforms = {
        "displacement": -x,
        "velocity": -velocity,
        "acceleration": -run.samples.acceleration,
        "normal_force_column": run.samples.normal[0],
        "normal_force_bolster": run.samples.normal[1],
        "force": _force(case, given, run),
        "stuck": run.samples.sticks,
    }
    opened = _of_lift_off(run.sums[0]) if opens(case)[0] else {}
    variables = {**_numbers(run, case[0], x, velocity), **opened, **run.statistics, **waveforms}
    for name in variables.keys() & set(record.dtype.names or ()):
        record[name] = variables[name]


def _force(case: np.ndarray, given: Transient, run: Trajectory) -> np.ndarray:
    """Force (N) of springs, dampers and friction against the displacement: what is left of inertia.

    NaN where not only the base drives the mass: of a fixture that resonates, and columns that yield.
    """
    if any(name in (case.dtype.names or ()) and case[name][key][0] > 0.0 for name, key in DRIVING):
        return np.full(run.samples.t.shape, nan)
    inertia = moving_mass(case)[0] * run.samples.acceleration
    scale = float(case["input"]["amplitude"][0] * case["input_gain"]["scale"][0])
    if is_oscillator(case) and case["oscillator"]["forced"][0]:
        return inertia + scale * given.sampled(run.samples.t)
    if is_oscillator(case) and case["oscillator"]["absolute"][0]:
        return inertia
    base = scale * given.sampled(run.samples.t, 2)
    base += stray_vibration.sampled(run.samples.t, case["stray_vibration"][0])
    driven = driven_mass(case)[0] * base
    # The displacement of a suspension is that of the side frame against the bolster.
    return inertia - driven if is_oscillator(case) else inertia + driven


def _numbers(run: Trajectory, p: np.void, x: np.ndarray, velocity: np.ndarray) -> dict[str, float]:
    """Numbers of a motion; samples ``x`` and ``velocity`` as the sensors show them."""
    one, gain = run.sums[0], float(p["displacement_gain"]["scale"])
    slipping = one["time"] - (one["stuck_time"] if p["friction"]["set_valued"] else 0.0)
    lagged = p["velocity_lag"]["time"] > 0.0
    smallest = min(one["first_least"], one["second_least"])
    return {
        "peak_displacement": gain * max(abs(one["highest"]), abs(one["lowest"])),
        "peak_to_peak": gain * (one["highest"] - one["lowest"]),
        "peak_velocity": float(np.abs(velocity).max()) if lagged else one["peak_velocity"],
        "mean_displacement": -gain * one["integral"] / one["time"],
        "rms_displacement": float(np.sqrt(np.mean(x**2))),
        "stick_fraction": one["stuck_time"] / one["time"],
        "dissipated_energy": one["dissipated"],
        "supplied_energy": one["supplied"],
        "minimum_normal_force": smallest if smallest < inf else nan,
        **_of_faces(one),
        "lift_off_fraction": one["lifted_time"] / slipping if slipping > 0.0 else nan,
    }


def _of_faces(sums: np.void) -> dict[str, float]:
    """Normal forces of both faces while they are determined; else none."""
    if sums["determined"] == 0.0:
        return {}
    numbers = {"mean": "sum", "min": "least", "max": "most"}
    return {
        f"{face}_force_{name}": sums[f"{contact}_{of}"] / (sums["determined"] if of == "sum" else 1.0)
        for face, contact in (("column", "first"), ("bolster", "second"))
        for name, of in numbers.items()
    }


def _of_lift_off(sums: np.void) -> dict[str, float]:
    """Numbers of a motion in which wedges may lift off."""
    return {
        "lift_off_fraction": sums["either_open"] / sums["time"],
        "column_open_fraction": sums["first_open"] / sums["time"],
        "bolster_open_fraction": sums["second_open"] / sums["time"],
        "impacts": sums["impacts"],
        "largest_impulse": sums["impulse"],
        "impact_energy": sums["struck"],
    }


def coordinates(
    tables: Sequence[Mapping[str, Any]],
    inputs: Sequence[Input],
    dims: tuple[str, ...],
    shape: tuple[int, ...],
    transient: Transient,
) -> dict[str, Any]:
    """Times of the stored samples, the input there at scale 1, and the frequency of a sine sweep.

    ``tables`` [input], and their ``inputs``, are those of an array of cases of a ``shape``; ``dims``: its
    dimensions, and time.
    """
    t = np.arange(transient.samples) * (transient.span / transient.samples)
    values = np.reshape([given.at(t, given.sampled()) for given in inputs], (*shape, t.size))
    about = {"units": inputs[0].units, "long_name": f"input at scale 1 ({inputs[0].quantity})"}
    found = {
        "time": ("time", t, {"units": "s", "long_name": "time"}),
        "input": (dims, values, about),
    }
    if tables[0]["kind"] == "sine-sweep":
        swept = np.reshape([sine_sweep.frequency(table, t) for table in tables], values.shape)
        words = {"units": "Hz", "long_name": "frequency of the input"}
        found["input_frequency"] = (dims, swept, words)
    return found
