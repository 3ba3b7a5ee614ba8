"""Claims on stick-slip and on the input at which motion begins."""

from collections.abc import Callable

import numpy as np
import xarray as xr

from reproduce.findings import DISTORTED, STICKS, Finding, above, below
from reproduce.runs import MM, Run, Runs, by_law, distortion, mirrored_columns, record, single

# A case that is stuck for a larger share of the time hardly moves.
HARDLY_MOVES = 0.9
LAST_BETA = 0.4  # up to which the paper saw stick-slip
SHOWN_BETA = 1.75  # of the paper's Fig. 7
ROUNDING = 1e-6
ONSET_MM = 0.3  # where the paper saw motion begin
MOVING, APPRECIABLE = 0.01, 0.1  # amplitude ratios


def stick_slip(runs: Runs) -> Finding:
    """Look for stick-slip above the paper's highest beta, and at the frequencies of its Figs. 8 and 9."""
    run = runs.breakaway
    low, high = _stick_slip_cases(runs.paper)
    shown = run.number("stick_fraction", "coulomb", run.beta_of(30.0), 0.1)
    (share_20, input_20, mirrored_20), (share_30, input_30, mirrored_30) = (
        _longest(run, run.beta_of(hertz)) for hertz in (20.0, 30.0)
    )
    ratios_20, ratios_30 = (
        by_law(run.ratios(run.beta_of(hertz), a)) for hertz, a in ((20.0, input_20), (30.0, input_30))
    )
    p = record(run.config, "static-dynamic", 1.0, 1.0)[0]
    face = abs(float(p["geometry"]["bolster_ratio"]))
    return Finding(
        f"coulomb sticks {share_20:.0%} of the time at 20 Hz, {input_20:g} mm; {share_30:.0%} at 30 Hz, "
        f"{input_30:g} mm",
        f"With set-valued friction {high} cases of paper.toml above beta = 0.4, close to breakaway, show "
        f"stick-slip, and {low} at lower frequencies. Larger inputs do not stick: at 30 Hz and 0.1 mm, the "
        f"input that the paper shows, the bolster sticks {shown:.0%} of the time. The two regularised laws "
        f"cannot stick; they creep. At 20 Hz, {input_20:g} mm the ratios are {ratios_20}; at 30 Hz, "
        f"{input_30:g} mm they are {ratios_30}. The slip on the bolster face is only {face:.4f} of the "
        "bolster's velocity, so that this face stays below the threshold velocity, almost without friction, "
        f"up to {float(p['friction']['v_t']) / face * MM:.1f} mm/s. With the columns leaning the other way "
        f"the same cases stick {mirrored_20:.0%} and {mirrored_30:.0%} of the time.",
        (
            below("coulomb cases with stick-slip above beta = 0.4", high, 0),
            below("longest share of time stuck in motion, coulomb, 20 Hz", share_20, STICKS),
            below("longest share of time stuck in motion, coulomb, 30 Hz", share_30, STICKS),
        ),
    )


def _stick_slip_cases(run: Run) -> tuple[int, int]:
    """Number of coulomb cases in stick-slip up to and above the paper's highest beta."""
    stuck = run.law("coulomb")["stick_fraction"]
    sticks = (stuck > STICKS) & (stuck < HARDLY_MOVES)
    low = sticks["beta"] <= LAST_BETA + ROUNDING
    return int((sticks & low).sum()), int((sticks & ~low).sum())


def _longest(run: Run, beta: float) -> tuple[float, float, float]:
    """Share of time stuck and input (mm) of the coulomb case in stick-slip that sticks for the longest time.

    Last, the share with mirrored columns.
    """
    stuck = run.cases("coulomb", beta)["stick_fraction"]
    moving = stuck.where(stuck < HARDLY_MOVES, 0.0)
    longest = moving[int(moving.fillna(0.0).values.argmax())]
    millimetres = round(float(longest["amplitude"]) * MM, 6)
    mirrored = single(run, "coulomb", beta, millimetres, mirrored_columns(run.config))
    return float(longest), millimetres, mirrored["stick_fraction"]


def onset_of_motion(runs: Runs) -> Finding:
    """Compare the inputs from which coulomb keeps slipping, and moves appreciably."""
    run = runs.paper
    beta, slip = slip_onsets(run)
    moving_beta, moving = _onsets(run, "amplitude_ratio", lambda ratio: ratio > APPRECIABLE)
    sustained = float(np.median(slip / MM * (beta * run.omega_n) ** 2))
    beta_of_onset = (sustained / ONSET_MM * MM) ** 0.5 / run.omega_n
    creep = float(run.cases("static-dynamic", SHOWN_BETA)["amplitude_ratio"][0])
    smallest, largest = float(moving.min()), float(moving.max())
    agree = float(np.mean(np.abs(np.log2(moving / ONSET_MM)) <= 1.0))
    return Finding(
        f"{largest:.2g} mm at beta = {moving_beta[0]:g} to {smallest:.2g} mm at beta = {moving_beta[-1]:g}; "
        f"breakaway ~ omega^{slope(beta, slip):.2f}",
        "The input from which coulomb keeps slipping is proportional to "
        f"omega^{slope(beta, slip):.2f} (fitted over {beta.size} frequencies), the input at which the ratio "
        f"exceeds 0.1 to omega^{slope(moving_beta, moving):.2f}, because the bolster is driven by its mass "
        f"times a omega^2. A base acceleration of {run.ds.attrs['breakaway_acceleration']:.4f} m/s^2 makes "
        "the bolster slip once from rest, to a position where it sticks; slip continues from about "
        f"{sustained:.2f} m/s^2. An input of 0.3 mm has this acceleration at beta = {beta_of_onset:.2f} "
        "only. The regularised laws have no onset: at beta = 1.75 and the smallest input static-dynamic "
        f"creeps with a ratio of {creep:.2f}.",
        (
            above("share of frequencies at which the ratio reaches 0.1 between 0.15 and 0.6 mm", agree, 0.9),
            below("largest over smallest input of these", largest / smallest, 2.0),
        ),
    )


def slip_onsets(run: Run) -> tuple[np.ndarray, np.ndarray]:
    """Frequency ratios, and inputs (mm) from which coulomb keeps slipping."""
    return _onsets(run, "stick_fraction", lambda stuck: stuck < HARDLY_MOVES)


def _onsets(
    run: Run, variable: str, begun: Callable[[np.ndarray], np.ndarray]
) -> tuple[np.ndarray, np.ndarray]:
    """Frequency ratios at which ``begun`` becomes true within the inputs, and these inputs (mm)."""
    cases = run.law("coulomb").transpose("beta", "amplitude", ...)
    amplitudes = cases["amplitude"].values * MM
    first = begun(cases[variable].values).argmax(axis=1)
    found = first > 0
    between = np.sqrt(amplitudes[first - 1] * amplitudes[first])
    return cases["beta"].values[found], between[found]


def slope(beta: np.ndarray, onset: np.ndarray) -> float:
    """Exponent of a power law through the onsets."""
    return float(np.polyfit(np.log(beta), np.log(onset), 1)[0])


def sinusoidal(runs: Runs) -> Finding:
    """Compare harmonics and sticking above and below the smallest input of the paper."""
    cases = runs.paper.ds.sel(beta=SHOWN_BETA)
    moving = cases.where(cases["amplitude_ratio"] > MOVING)
    large = cases["amplitude"] * MM > ONSET_MM - ROUNDING
    stuck: xr.DataArray = moving["stick_fraction"].sel(friction_law="coulomb")
    above_onset, below_onset = (
        (float(distortion(moving).where(inputs).max()), float(stuck.where(inputs).max()))
        for inputs in (large, ~large)
    )
    at = float(stuck.where(~large).idxmax("amplitude")) * MM
    return Finding(
        f"from 0.3 mm: harmonics up to {above_onset[0]:.3f}, stuck {above_onset[1]:.0%}; below: "
        f"{below_onset[0]:.2f}, stuck {below_onset[1]:.0%} of the time",
        "Inputs from 0.3 mm, where the paper reports a response, are far above breakaway. With set-valued "
        f"friction smaller inputs stick: {below_onset[1]:.1%} of the time at {at:g} mm.",
        (
            below("harmonics over the fundamental, from 0.3 mm", above_onset[0], DISTORTED),
            below("share of time stuck, coulomb, from 0.3 mm", above_onset[1], STICKS),
            below("harmonics over the fundamental, below 0.3 mm", below_onset[0], DISTORTED),
            below("share of time stuck, coulomb, below 0.3 mm", below_onset[1], STICKS),
        ),
    )
