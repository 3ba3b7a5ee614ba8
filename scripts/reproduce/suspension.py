"""Claims on the suspension as a whole: rest position, resonance, frictionless limit, lift-off."""

from math import pi, sqrt

import numpy as np
import xarray as xr

from reproduce.findings import Finding, below, near
from reproduce.runs import LAWS, MM, Run, Runs, by_law, changed, mirrored_columns, record, single
from wedgesweep.systems.suspension.equilibrium import resonance as frictionless_resonance
from wedgesweep.systems.suspension.parameters import driven_mass, moving_mass

# Relative tolerances: of printed numbers, of numbers read off a diagram, of a ratio that is said to reach 1,
# of a ratio that is like the frictionless one.
PRINTED, READ_OFF, REACHED, LIKE_FREE = 3e-3, 0.05, 0.1, 0.05
FAR = 100.0  # beta that stands for infinity
LONG = 300  # periods until large motions, which friction hardly damps, have settled
# Inputs and frequencies far above those at which nothing opens.
LARGE_MM, LARGE_BETA, ROUNDING = 1.0, 1.0, 1e-6


def parameters_and_cases(runs: Runs) -> Finding:
    """Compare the numbers that follow from Table 1 and from the ranges."""
    hertz, size = runs.paper.ds["frequency"].values, runs.paper.ds["status"].size
    omega_n, lowest, highest = runs.paper.omega_n, float(hertz[0]), float(hertz[-1])
    return Finding(
        f"{omega_n:.4f} rad/s; {lowest:.2f} to {highest:.2f} Hz; {size} cases",
        "The paper gives the ends of its ranges and the values that it shows, but not the grid between "
        "them. The grid of these runs is in configs/paper.toml.",
        (
            near("sqrt(k_b/M_b) (rad/s)", omega_n, 85.35, PRINTED),
            near("lowest frequency (Hz)", lowest, 1.36, PRINTED),
            near("highest frequency (Hz)", highest, 40.76, PRINTED),
            near("number of cases", size, 1800, 0.0),
        ),
    )


def rest_position(runs: Runs) -> Finding:
    """Compare the frictionless rest position."""
    rest, scaled = (run.ds.attrs["rest_position"] * MM for run in (runs.paper, runs.scaled))
    return Finding(
        f"{rest:.4f} mm",
        f"Table 1 gives {rest:.4f} mm, or {mirrored_rest(runs.paper):.4f} mm if the columns lean the other "
        "way. The rest position is proportional to 1/stiffness: all springs scaled by "
        f"{_spring_scale(runs):.4f} (paper-y0.toml) give {scaled:.4f} mm, and also the paper's resonance "
        f"(claim 3). Springs of half the stiffness, as in a model of one half, give {2.0 * rest:.3f} mm.",
        (near("rest position under gravity (mm)", rest, -2.1941, READ_OFF),),
    )


def mirrored_rest(run: Run) -> float:
    """Rest position (mm) with the column angle reversed."""
    config = changed(run.config, mirrored_columns(run.config))
    return float(record(config, "coulomb", 1.0, 1.0)["geometry"]["rest"][0]) * MM


def _spring_scale(runs: Runs) -> float:
    scaled, printed = (run.config.suspension["bolster_spring"] for run in (runs.scaled, runs.paper))
    return scaled / printed


def resonance(runs: Runs) -> Finding:
    """Compare the frictionless resonance and the frequencies of the largest ratios."""
    here, scaled = runs.paper.resonance, runs.scaled.resonance
    hertz, scaled_hertz = (beta * runs.paper.omega_n / (2.0 * pi) for beta in (here, scaled))
    peaks = _peaks(runs.paper)
    return Finding(
        f"{here:.3f} omega_n, {hertz:.1f} Hz",
        f"On the grid the ratio is largest at beta = {by_law(peaks, 'g')}. With the springs scaled by "
        f"{_spring_scale(runs):.4f}, which give the paper's y_0, the resonance is {scaled:.3f} omega_n, "
        f"{scaled_hertz:.1f} Hz, and the ratio is largest at beta = {by_law(_peaks(runs.scaled), 'g')}; with "
        f"springs of half the stiffness it is {here / sqrt(2.0):.3f} omega_n. The "
        "paper's y_0 and its resonance agree with each other, and both contradict its Table 1.",
        (
            near("resonance over omega_n, frictionless", here, 0.8, READ_OFF),
            near("the same (Hz)", hertz, 11.0, READ_OFF),
            *(
                near(f"beta of the largest ratio, {law}", peak, 0.8, READ_OFF)
                for law, peak in zip(LAWS, peaks, strict=True)
            ),
        ),
    )


def _peaks(run: Run) -> list[float]:
    """Frequency ratio of the largest amplitude ratio of each law."""
    largest = run.ds["amplitude_ratio"].max("amplitude")
    return [float(largest.sel(friction_law=law).idxmax("beta")) for law in LAWS]


def unit_ratio(runs: Runs) -> Finding:
    """Compare the ratio with 1 at 20 Hz, at the end of the range and far above."""
    run = runs.paper
    at_20, end = run.beta_of(20.0), float(run.ds["beta"][-1])
    settled_20, settled_end = (_settled_ratio(run, beta) for beta in (at_20, end))
    free_20, free_end, limit = (frictionless_ratio(run, beta) for beta in (at_20, end, FAR))
    scaled_20, scaled_end = (frictionless_ratio(runs.scaled, beta) for beta in (at_20, end))
    return Finding(
        f"{settled_20:.2f} at 20 Hz, {settled_end:.2f} at beta = {end:g} (coulomb, 1 mm)",
        f"Far above resonance the ratio does tend to about 1 (frictionless: {limit:.3f}), but slowly. "
        f"Without friction it is {free_20:.2f} at 20 Hz and {free_end:.2f} at beta = {end:g}; with "
        f"friction and 1 mm it is {settled_20:.2f} and {settled_end:.2f} after {LONG} periods. The springs "
        f"that give the paper's y_0 yield {scaled_20:.2f} and {scaled_end:.2f} without friction, which is "
        "closer to the paper.",
        (
            near("frictionless ratio far above resonance", limit, 1.0, REACHED),
            near("frictionless ratio at 20 Hz", free_20, 1.0, REACHED),
            near("ratio at 20 Hz, coulomb, 1 mm", settled_20, 1.0, REACHED),
            near(f"ratio at beta = {end:g}, coulomb, 1 mm", settled_end, 1.0, REACHED),
        ),
    )


def _settled_ratio(run: Run, beta: float) -> float:
    return single(run, "coulomb", beta, 1.0, {"solver": {"settle_periods": LONG}})["amplitude_ratio"]


def frictionless_ratio(run: Run, beta: float) -> float:
    """Amplitude ratio of the suspension without friction on any face."""
    p = record(run.config, "coulomb", beta, 1.0)[0]
    squared = p["input"]["omega"] ** 2
    return float(abs(driven_mass(p) / moving_mass(p) * squared / (squared - frictionless_resonance(p) ** 2)))


def lift_off(runs: Runs) -> Finding:
    """Look for negative normal forces."""
    ds = runs.paper.ds
    share = ds["lift_off_fraction"]
    cases, longest, among_large = float((share > 0.0).mean()), float(share.max()), share.where(_large(ds))
    reason = (
        f"The grid is finer at small inputs; with inputs spread evenly up to 4.75 mm, "
        f"{evenly(share > 0.0):.0%} of the cases would lift off. From 1 mm and beta = 1 a normal force is "
        f"negative {float(among_large.min()):.0%} to {float(among_large.max()):.0%} of the time, down to "
        f"{float(ds['minimum_normal_force'].min()):.3g} N. The paper's translational joints are bilateral: "
        "they pull where a real wedge would separate from its faces, and the model is not valid there. With "
        "unilateral joints a contact opens in {open_cases:.0%} of the cases, from 1 mm and beta = 1 for "
        "{open_low:.0%} to {open_high:.0%} of the time; impacts then take {struck:.0%} of the energy "
        "(median). The largest amplitude ratio falls from {held_peak:.3g} to {open_peak:.3g}; where a "
        "contact opens, the ratio is {least_change:.3g} to {most_change:.3g} times that of bilateral joints "
        "(median {median_change:.3g})."
    )
    return Finding(
        f"a normal force becomes negative in {cases:.0%} of the cases",
        reason.format(**changes_by_lift_off(ds, runs.unilateral.ds)),
        (
            below("share of the cases in which a normal force becomes negative", cases, 0.0),
            below("longest share of time with a negative normal force", longest, 0.0),
        ),
    )


def evenly(lifts: xr.DataArray) -> float:
    """Share of the cases if the inputs were spread evenly over their range."""
    inputs = lifts["amplitude"]
    weights = xr.DataArray(np.gradient(inputs.values), {"amplitude": inputs.values}, ["amplitude"])
    return float(lifts.weighted(weights).mean())


def _large(ds: xr.Dataset) -> xr.DataArray:
    """Whether each case has a large input above resonance."""
    return (ds["amplitude"] * MM > LARGE_MM - ROUNDING) & (ds["beta"] > LARGE_BETA - ROUNDING)


def changes_by_lift_off(held: xr.Dataset, opens: xr.Dataset) -> dict[str, float]:
    """Shares of cases and of time with open joints, amplitude ratios of both kinds, energy of impacts."""
    lifts = opens["lift_off_fraction"] > 0.0
    share = opens["lift_off_fraction"].where(_large(opens))
    change = (opens["amplitude_ratio"] / held["amplitude_ratio"]).where(lifts)
    taken = opens["impact_energy"] / (opens["impact_energy"] + opens["dissipated_energy"])
    return {
        "open_cases": float(lifts.mean()),
        "open_low": float(share.min()),
        "open_high": float(share.max()),
        "held_peak": float(held["amplitude_ratio"].max()),
        "open_peak": float(opens["amplitude_ratio"].max()),
        "least_change": float(change.min()),
        "most_change": float(change.max()),
        "median_change": float(change.median()),
        "struck": float(taken.where(_large(opens)).median()),
    }


def like_frictionless(runs: Runs) -> Finding:
    """Compare the ratio with the frictionless one at a larger and a smaller input."""
    run = runs.breakaway
    beta = run.beta_of(30.0)
    free = frictionless_ratio(run, beta)
    shown, small = (run.number("amplitude_ratio", "coulomb", beta, a) for a in (0.1, 0.03))
    ratios = run.cases("coulomb", beta)["amplitude_ratio"]
    like = ratios["amplitude"].values[np.abs(ratios.values / free - 1.0) <= LIKE_FREE]
    return Finding(
        f"30 Hz: {shown:.3f} at 0.1 mm, {small:.3f} at 0.03 mm; frictionless {free:.3f}",
        f"At 30 Hz the ratio is within 5 % of the frictionless one from {like.min(initial=np.inf) * MM:g} "
        "mm, and falls to zero towards breakaway. Breakaway depends on a omega^2: the input matters as much "
        "as the frequency.",
        (
            near("ratio, coulomb, 30 Hz, 0.1 mm", shown, free, LIKE_FREE),
            near("ratio, coulomb, 30 Hz, 0.03 mm", small, free, LIKE_FREE),
        ),
    )
