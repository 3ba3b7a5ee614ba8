"""Claims on the range of Chandiramani's experiment, 20 to 40 Hz."""

from math import nan

import numpy as np

from reproduce.findings import DISTORTED, MOVES, STICKS, Finding, above, below, untested
from reproduce.runs import MM, Run, Runs, distortion

JUMP_HERTZ = (32.0, 38.0)  # around the measured jump
JUMP = 3.0  # growth of the peak-to-peak over this range
PLATEAU = 1 / 8  # of the period
NO_NUMBERS = "the measured curves are not given in numbers"


def shown_cases(runs: Runs) -> Finding:
    """Simulate the two cases that the paper compares with the experiment."""
    run = runs.breakaway
    at_20, at_30 = run.beta_of(20.0), run.beta_of(30.0)
    fast, creep = run.case("coulomb", at_30, 0.1), run.case("static-dynamic", at_20, 0.015)
    still = run.number("amplitude_ratio", "coulomb", at_20, 0.015)
    harmonics, stuck = float(distortion(fast)), float(fast["stick_fraction"])
    onset, scaled_onset = (
        float(each.onset.sel(beta=at_20, method="nearest")) * MM for each in (run, runs.scaled)
    )
    return Finding(
        f"30 Hz: harmonic, {float(fast['peak_to_peak']) * MM:.3f} mm peak to peak; 20 Hz: coulomb ratio "
        f"{still:.3g}",
        f"At 20 Hz 0.015 mm is below the {onset:.4f} mm at which set-valued friction begins to slip from "
        f"rest ({scaled_onset:.4f} mm with the springs that give the paper's y_0). Static-dynamic creeps "
        f"there, with a ratio of {float(creep['amplitude_ratio']):.3f} and higher harmonics of "
        f"{float(distortion(creep)):.3f}. In this model only a regularised law gives a curve like Fig. 9.",
        (
            below("harmonics over the fundamental, coulomb, 30 Hz, 0.1 mm", harmonics, DISTORTED),
            below("share of time stuck, coulomb, 30 Hz, 0.1 mm", stuck, STICKS),
            above("amplitude ratio, coulomb, 20 Hz, 0.015 mm", still, MOVES),
            untested("closest to the measured peak-to-peak", NO_NUMBERS),
        ),
    )


def jump(runs: Runs) -> Finding:
    """Compare the growth of the peak-to-peak around 35 Hz for all inputs."""
    amplitudes, growth = _growth(runs.breakaway)
    place = int(np.nanargmax(growth))
    shown, largest = float(growth[np.isclose(amplitudes, 0.1)][0]), float(growth[place])
    at_32, at_35, at_40 = (_peak_to_peak(runs.breakaway, hertz, 0.015) for hertz in (32.0, 35.0, 40.0))
    return Finding(
        f"x {shown:.2f} from 32 to 38 Hz at 0.1 mm, up to x {largest:.3g} at {amplitudes[place]:g} mm "
        "(coulomb)",
        "At a constant small input set-valued friction breaks away in this range: with 0.015 mm the "
        f"peak-to-peak is {at_32:.4f}, {at_35:.4f} and {at_40:.4f} mm at 32, 35 and 40 Hz. This is still far "
        f"below the {_peak_to_peak(runs.breakaway, 30.0, 0.1):.2f} mm of claim 11, and inputs that reach "
        "this level do not jump: a partial explanation only.",
        (
            below("peak-to-peak at 38 over 32 Hz, coulomb, 0.1 mm", shown, JUMP),
            below("the same, largest over all inputs that move", largest, JUMP),
            untested("the measured curve", NO_NUMBERS),
        ),
    )


def _growth(run: Run) -> tuple[np.ndarray, np.ndarray]:
    """Inputs (mm), and peak-to-peak above the jump over that below; NaN where nothing moves below."""
    cases = [run.cases("coulomb", run.beta_of(hertz)) for hertz in JUMP_HERTZ]
    before, after = (each["peak_to_peak"].values for each in cases)
    moves = cases[0]["amplitude_ratio"].values > MOVES
    return cases[0]["amplitude"].values * MM, np.where(moves, after / np.where(moves, before, 1.0), nan)


def _peak_to_peak(run: Run, hertz: float, millimetres: float) -> float:
    return run.number("peak_to_peak", "coulomb", run.beta_of(hertz), millimetres) * MM


def plateaus(runs: Runs) -> Finding:
    """Look for stops of an eighth of the period."""
    lengths, inputs, levels = stops(runs.breakaway)
    found = lengths if lengths.size else np.zeros(1)
    shortest, longest, at = float(found[0]), float(found[-1]), at_plateau(lengths, inputs)
    return Finding(
        f"stops of {shortest:.3f} to {longest:.3f} of the period; 1/8 at {at:.3f} mm",
        "The experiment shows these plateaus; the paper's model did not. At 20 Hz set-valued friction "
        f"stops twice per period, each time for {longest:.3f} of the period at "
        f"{inputs.min(initial=np.inf):g} mm to {shortest:.3f} at {inputs.max(initial=0.0):g} mm. An eighth "
        f"results at {at:.4f} mm (interpolated) with {at_plateau(lengths, levels):.3f} mm peak to peak. The "
        "measured motion had 0.03 mm if the paper's 0.015 mm matched it with a ratio of 1.",
        (
            below("shortest stop, coulomb, 20 Hz (share of the period)", shortest, PLATEAU),
            above("longest stop, coulomb, 20 Hz (share of the period)", longest, PLATEAU),
        ),
    )


def stops(run: Run) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Stops (of the period; shortest first), inputs and peak-to-peak (mm) of the cases that stop twice."""
    cases = run.cases("coulomb", run.beta_of(20.0))
    cases = cases.isel(amplitude=(cases["stick_phases"] == 2.0).values).sortby("stick_fraction")
    inputs, levels = (cases[name].values * MM for name in ("amplitude", "peak_to_peak"))
    return cases["stick_fraction"].values / 2.0, inputs, levels


def at_plateau(lengths: np.ndarray, values: np.ndarray) -> float:
    """Interpolated value where a stop takes an eighth of the period; NaN if none does."""
    return float(np.interp(PLATEAU, lengths, values, nan, nan)) if lengths.size else nan
