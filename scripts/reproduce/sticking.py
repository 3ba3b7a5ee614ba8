"""Claims on stick-slip and on the input at which motion begins."""

from collections.abc import Callable

import numpy as np

from reproduce.findings import STICKS, Finding, above, below, claim
from reproduce.runs import MM, Run, Runs
from reproduce.single_case import mirrored_columns, record, single

# A case that is stuck for a larger share of the time hardly moves.
HARDLY_MOVES = 0.9
LAST_BETA = 0.4  # up to which the paper saw stick-slip
ROUNDING = 1e-6
ONSET_MM = 0.3  # where the paper saw motion begin
APPRECIABLE = 0.1  # amplitude ratio


@claim(
    6,
    "Stick-slip up to beta = 0.4 only; none at 20 and 30 Hz",
    paper="beta <= 0.4",
    here="coulomb sticks {share_20:.0%} of the time at 20 Hz, {input_20:g} mm; {share_30:.0%} at "
    "30 Hz, {input_30:g} mm",
    reason="With set-valued friction {high} cases of paper.toml above beta = 0.4, close to breakaway, show"
    " stick-slip, and {low} at lower frequencies. Larger inputs do not stick: at 30 Hz and 0.1 mm, the "
    "input that the paper shows, the bolster sticks {shown:.0%} of the time. The two regularised laws "
    "cannot stick; they creep. At 20 Hz, {input_20:g} mm the ratios are {coulomb_20:.3f} (coulomb), "
    "{static_dynamic_20:.3f} (static-dynamic) and {exponential_20:.3f} (exponential); at 30 Hz, "
    "{input_30:g} mm they are {coulomb_30:.3f}, {static_dynamic_30:.3f} and {exponential_30:.3f}. The slip"
    " on the bolster face is only {face:.4f} of the bolster's velocity, so that this face stays below the "
    "threshold velocity, almost without friction, up to {face_limit:.1f} mm/s. With the columns leaning "
    "the other way the same cases stick {mirrored_20:.0%} and {mirrored_30:.0%} of the time.",
)
def stick_slip(runs: Runs) -> Finding:
    """Look for stick-slip above the paper's highest beta, and at the frequencies of its Figs. 8 and 9."""
    low, high = _stick_slip_cases(runs.paper)
    at_20, at_30 = (_longest(runs.breakaway, hertz) for hertz in (20, 30))
    shown = runs.breakaway.number("stick_fraction", "coulomb", runs.breakaway.beta_of(30.0), 0.1)
    checks = (
        below("coulomb cases with stick-slip above beta = 0.4", high, 0),
        below("longest share of time stuck in motion, coulomb, 20 Hz", at_20["share_20"], STICKS),
        below("longest share of time stuck in motion, coulomb, 30 Hz", at_30["share_30"], STICKS),
    )
    bolster = _bolster_face(runs.breakaway)
    return Finding(checks, {"low": low, "high": high, "shown": shown, **at_20, **at_30, **bolster})


def _stick_slip_cases(run: Run) -> tuple[int, int]:
    """Number of coulomb cases in stick-slip up to and above the paper's highest beta."""
    stuck = run.law("coulomb")["stick_fraction"]
    sticks = (stuck > STICKS) & (stuck < HARDLY_MOVES)
    low = sticks["beta"] <= LAST_BETA + ROUNDING
    return int((sticks & low).sum()), int((sticks & ~low).sum())


def _longest(run: Run, hertz: int) -> dict[str, float]:
    """Numbers of the coulomb case in stick-slip that sticks for the longest time."""
    beta = run.beta_of(hertz)
    stuck = run.cases("coulomb", beta)["stick_fraction"]
    longest = stuck[int(stuck.where(stuck < HARDLY_MOVES, 0.0).fillna(0.0).values.argmax())]
    millimetres = round(float(longest["amplitude"]) * MM, 6)
    mirrored = single(run, "coulomb", beta, millimetres, mirrored_columns(run.config))
    return {
        f"share_{hertz}": float(longest.where(longest < HARDLY_MOVES, 0.0)),
        f"input_{hertz}": millimetres,
        f"mirrored_{hertz}": mirrored["stick_fraction"],
        **{f"{law}_{hertz}": ratio for law, ratio in run.ratios(beta, millimetres).items()},
    }


def _bolster_face(run: Run) -> dict[str, float]:
    """Slip of the bolster face over the velocity, and the velocity (mm/s) at which this slip is v_t."""
    p = record(run.config, "static-dynamic", 1.0, 1.0)[0]
    share = abs(float(p["geometry"]["bolster_ratio"]))
    return {"face": share, "face_limit": float(p["friction"]["v_t"]) / share * MM}


@claim(
    7,
    "Appreciable motion begins at the same input at all frequencies",
    paper="about 0.3 mm",
    here="{largest:.2g} mm at beta = {first_beta:g} to {smallest:.2g} mm at beta = {last_beta:g}; "
    "breakaway ~ omega^{slope:.2f}",
    reason="The input from which coulomb keeps slipping is proportional to omega^{slope:.2f} (fitted over "
    "{frequencies} frequencies), the input at which the ratio exceeds 0.1 to omega^{moving_slope:.2f}, "
    "because the bolster is driven by its mass times a omega^2. A base acceleration of {acceleration:.4f} "
    "m/s^2 makes the bolster slip once from rest, to a position where it sticks; slip continues from about "
    "{sustained:.2f} m/s^2. An input of 0.3 mm has this acceleration at beta = {beta_of_onset:.2f} only. "
    "The regularised laws have no onset: at beta = 1.75 and the smallest input static-dynamic creeps with "
    "a ratio of {creep:.2f}.",
)
def onset_of_motion(runs: Runs) -> Finding:
    """Compare the inputs from which coulomb keeps slipping, and moves appreciably."""
    run = runs.paper
    beta, slip = _onsets(run, "stick_fraction", lambda stuck: stuck < HARDLY_MOVES)
    moving_beta, moving = _onsets(run, "amplitude_ratio", lambda ratio: ratio > APPRECIABLE)
    sustained = float(np.median(slip / MM * (beta * run.omega_n) ** 2))
    agree = float(np.mean(np.abs(np.log2(moving / ONSET_MM)) <= 1.0))
    checks = (
        above("share of frequencies at which the ratio reaches 0.1 between 0.15 and 0.6 mm", agree, 0.9),
        below("largest over smallest input of these", float(moving.max() / moving.min()), 2.0),
    )
    return Finding(
        checks,
        {
            "slope": _slope(beta, slip),
            "moving_slope": _slope(moving_beta, moving),
            "frequencies": beta.size,
            "first_beta": float(moving_beta[0]),
            "last_beta": float(moving_beta[-1]),
            "largest": float(moving.max()),
            "smallest": float(moving.min()),
            "acceleration": run.ds.attrs["breakaway_acceleration"],
            "sustained": sustained,
            "beta_of_onset": (sustained / ONSET_MM * MM) ** 0.5 / run.omega_n,
            "creep": float(run.cases("static-dynamic", 1.75)["amplitude_ratio"][0]),
        },
    )


def _onsets(
    run: Run, variable: str, begun: Callable[[np.ndarray], np.ndarray]
) -> tuple[np.ndarray, np.ndarray]:
    """Frequency ratios at which ``begun`` becomes true within the inputs, and these inputs (mm)."""
    cases = run.law("coulomb").transpose("beta", "amplitude", ...)
    amplitudes = cases["amplitude"].values * MM
    state = begun(cases[variable].values)
    first = state.argmax(axis=1)
    found = first > 0
    between = np.sqrt(amplitudes[first - 1] * amplitudes[first])
    return cases["beta"].values[found], between[found]


def _slope(beta: np.ndarray, onset: np.ndarray) -> float:
    """Exponent of a power law through the onsets."""
    return float(np.polyfit(np.log(beta), np.log(onset), 1)[0])
