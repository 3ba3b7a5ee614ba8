"""Claims on the response above resonance, and on the contact that the model assumes."""

import numpy as np
import xarray as xr

from reproduce import joints
from reproduce.findings import DISTORTED, STICKS, Finding, below, claim, near
from reproduce.runs import MM, Runs, distortion
from reproduce.suspension import frictionless_ratio

SHOWN_BETA = 1.75
ONSET_MM = 0.3  # smallest input for which the paper reports a response
ROUNDING = 1e-6
MOVES = 0.01  # amplitude ratio
LIKE_FREE = 0.05  # relative difference of a ratio that is like the frictionless one


@claim(
    10,
    "At beta = 1.75 the response is almost sinusoidal, without stick-slip",
    paper="Fig. 7",
    here="from 0.3 mm: harmonics up to {large_harmonics:.3f}, stuck {large_stuck:.0%}; below: "
    "{small_harmonics:.2f}, stuck {small_stuck:.0%} of the time",
    reason="Inputs from 0.3 mm, where the paper reports a response, are far above breakaway. With "
    "set-valued friction smaller inputs stick: {small_stuck:.1%} of the time at {stuck_input:g} mm.",
    large=True,
)
def sinusoidal(runs: Runs) -> Finding:
    """Compare harmonics and sticking above and below the smallest input of the paper."""
    cases = runs.paper.ds.sel(beta=SHOWN_BETA)
    moving = cases.where(cases["amplitude_ratio"] > MOVES)
    large = cases["amplitude"] * MM > ONSET_MM - ROUNDING
    harmonics = distortion(moving)
    stuck = moving["stick_fraction"].sel(friction_law="coulomb")
    numbers = {
        "large_harmonics": float(harmonics.where(large).max()),
        "large_stuck": float(stuck.where(large).max()),
        "small_harmonics": float(harmonics.where(~large).max()),
        "small_stuck": float(stuck.where(~large).max()),
        "stuck_input": round(float(stuck.where(~large).idxmax("amplitude")) * MM, 6),
    }
    checks = (
        below("harmonics over the fundamental, from 0.3 mm", numbers["large_harmonics"], DISTORTED),
        below("share of time stuck, coulomb, from 0.3 mm", numbers["large_stuck"], STICKS),
        below("harmonics over the fundamental, below 0.3 mm", numbers["small_harmonics"], DISTORTED),
        below("share of time stuck, coulomb, below 0.3 mm", numbers["small_stuck"], STICKS),
    )
    return Finding(checks, numbers)


@claim(
    15,
    "The bolster does not lift off, by design",
    paper="none",
    here="a normal force becomes negative in {cases:.0%} of the cases",
    reason="The grid is finer at small inputs; with inputs spread evenly up to 4.75 mm, {even:.0%} of the "
    "cases would lift off. From 1 mm and beta = 1 a normal force is negative {low:.0%} to {high:.0%} of "
    "the time, down to {force:.3g} N. The paper's translational joints are bilateral: they pull where a "
    "real wedge would separate from its faces, and the model is not valid there. With unilateral joints a "
    "contact opens in {open_cases:.0%} of the cases, from 1 mm and beta = 1 for {open_low:.0%} to "
    "{open_high:.0%} of the time; impacts then take {struck:.0%} of the energy (median). The largest "
    "amplitude ratio falls from {held_peak:.3g} to {open_peak:.3g}; where a contact opens, the ratio is "
    "{least_change:.3g} to {most_change:.3g} times that of bilateral joints (median {median_change:.3g}).",
)
def lift_off(runs: Runs) -> Finding:
    """Look for negative normal forces."""
    ds = runs.paper.ds
    share = ds["lift_off_fraction"]
    cases, longest = float((share > 0.0).mean()), float(share.max())
    large = share.where((ds["amplitude"] * MM > 1.0 - ROUNDING) & (ds["beta"] > 1.0 - ROUNDING))
    checks = (
        below("share of the cases in which a normal force becomes negative", cases, 0.0),
        below("longest share of time with a negative normal force", longest, 0.0),
    )
    numbers = {"low": float(large.min()), "high": float(large.max()), "longest": longest}
    numbers |= {
        "cases": cases,
        "even": _evenly(share > 0.0),
        "force": float(ds["minimum_normal_force"].min()),
    }
    return Finding(checks, numbers | joints.changes(ds, runs.unilateral.ds))


def _evenly(lifts: xr.DataArray) -> float:
    """Share of the cases if the inputs were spread evenly over their range."""
    inputs = lifts["amplitude"]
    weights = xr.DataArray(np.gradient(inputs.values), {"amplitude": inputs.values}, ["amplitude"])
    return float(lifts.weighted(weights).mean())


@claim(
    16,
    "Above resonance the system responds like one without friction",
    paper="like a harmonic oscillator",
    here="30 Hz: {shown:.3f} at 0.1 mm, {small:.3f} at 0.03 mm; frictionless {free:.3f}",
    reason="At 30 Hz the ratio is within 5 % of the frictionless one from {like:g} mm, and falls to zero "
    "towards breakaway. Breakaway depends on a omega^2: the input matters as much as the frequency.",
)
def like_frictionless(runs: Runs) -> Finding:
    """Compare the ratio with the frictionless one at a larger and a smaller input."""
    run = runs.breakaway
    beta = run.beta_of(30.0)
    free = frictionless_ratio(run, beta)
    shown, small = (run.number("amplitude_ratio", "coulomb", beta, a) for a in (0.1, 0.03))
    checks = (
        near("ratio, coulomb, 30 Hz, 0.1 mm", shown, free, LIKE_FREE),
        near("ratio, coulomb, 30 Hz, 0.03 mm", small, free, LIKE_FREE),
    )
    ratios = run.cases("coulomb", beta)["amplitude_ratio"]
    like = ratios["amplitude"].values[np.abs(ratios.values / free - 1.0) <= LIKE_FREE]
    smallest = round(float(like.min(initial=np.inf)) * MM, 6)
    return Finding(checks, {"free": free, "shown": shown, "small": small, "like": smallest})
