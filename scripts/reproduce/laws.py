"""Claims that compare the three friction laws."""

import numpy as np

from reproduce.comparison import settled, spread, zone
from reproduce.findings import DISTORTED, MOVES, Finding, above, below, claim
from reproduce.runs import LAWS, MM, Run, Runs, distortion
from reproduce.single_case import record
from wedgesweep.friction.curve import curve

ALIKE = 0.1  # difference of ratios over the largest of them
LOWEST_BETA = 0.1
COULOMB, STATIC_DYNAMIC, EXPONENTIAL = LAWS
REGULARISED = [STATIC_DYNAMIC, EXPONENTIAL]


def _close_to_breakaway(runs: Runs) -> dict[str, float]:
    """Ratios of the three laws at 20 Hz, 0.05 mm."""
    return runs.breakaway.ratios(runs.breakaway.beta_of(20.0), 0.05)


@claim(
    5,
    "The friction laws do not change the amplitude ratio",
    paper="the same tendency line",
    here="differ by {beyond:.1%} (median) far above breakaway, by {near:.0%} near it",
    reason="These are the cases that have settled after 1.5 s. The others, which are most of those far "
    "above breakaway, differ more, because the transient decays most slowly under exponential. At 20 Hz, "
    "0.05 mm the ratio is {coulomb:.3f} (coulomb), {static_dynamic:.3f} (static-dynamic) and "
    "{exponential:.3f} (exponential): set-valued friction sticks where the regularised laws creep. Below "
    "breakaway coulomb does not move at all. The table of the laws below covers all cases.",
    large=True,
)
def same_trend(runs: Runs) -> Finding:
    """Compare the ratios of the three laws near breakaway and far above it."""
    values = spread(runs.paper).where(settled(runs.paper))
    near, beyond = (
        float(values.where(zone(runs.paper, name)).median()) for name in ("near breakaway", "beyond")
    )
    checks = (
        below("median difference of the three ratios, settled, far above breakaway", beyond, ALIKE),
        below("median difference of the three ratios, settled, near breakaway", near, ALIKE),
    )
    return Finding(checks, {"near": near, "beyond": beyond, **_close_to_breakaway(runs)})


@claim(
    8,
    "At beta = 0.1 Coulomb is distorted, the other two show no stick-slip",
    paper="Fig. 5",
    here="coulomb ratio {coulomb:.2g} at every input; the others smooth, harmonics up to {smooth:.3f}",
    reason="At this frequency set-valued friction begins to slip at {onset:.2f} mm, above the paper's "
    "largest input of {largest:g} mm: coulomb stays stuck. The other two laws show no stick-slip because "
    "they cannot stick. They creep with a ratio of {creep:.4f}, and the column face stays below the "
    "threshold velocity for at least {slow:.0%} of the time (the side frame itself does up to "
    "{slow_input:.3f} mm).",
)
def lowest_frequency(runs: Runs) -> Finding:
    """Examine the cases at the lowest frequency."""
    cases = runs.paper.ds.sel(beta=LOWEST_BETA)
    others = cases.sel(friction_law=REGULARISED)
    coulomb = float(cases["amplitude_ratio"].sel(friction_law=COULOMB).max())
    smooth = float(distortion(others).max())
    p = record(runs.paper.config, STATIC_DYNAMIC, LOWEST_BETA, 1.0)[0]
    checks = (
        above("largest ratio, coulomb (it must move to be distorted)", coulomb, MOVES),
        below("largest harmonics over the fundamental, the other two", smooth, DISTORTED),
    )
    return Finding(
        checks,
        {
            "coulomb": coulomb,
            "smooth": smooth,
            "onset": float(runs.paper.onset.sel(beta=LOWEST_BETA)) * MM,
            "largest": float(cases["amplitude"].max()) * MM,
            "creep": float(others["amplitude_ratio"].sel(friction_law=STATIC_DYNAMIC)[0]),
            "slow": float(others["stick_fraction"].min()),
            "slow_input": float(p["friction"]["v_t"] / p["input"]["omega"]) * MM,
        },
    )


@claim(
    9,
    "Static-dynamic and exponential behave very similarly",
    paper="very similar",
    here="ratios differ by {median:.1%} (median), by up to {largest:.0%} where settled",
    reason="Below breakaway both creep alike. Above it the exponential coefficient decreases with velocity"
    " and damps less: the ratios are {static_dynamic:.3f} and {exponential:.3f} at 20 Hz, 0.05 mm, and "
    "differ most at beta = {beta:g}, {input:g} mm. {share:.0%} of all cases differ by less than 10 %.",
    large=True,
)
def regularised_alike(runs: Runs) -> Finding:
    """Compare the two regularised laws over all cases."""
    values = spread(runs.paper, REGULARISED)
    median = float(values.median())
    share = float((values <= ALIKE).sum() / values.notnull().sum())
    steady = values.where(settled(runs.paper)).stack(case=("beta", "amplitude"))
    largest = steady[int(steady.fillna(0.0).values.argmax())]
    checks = (
        below("median difference of their ratios", median, ALIKE),
        below("largest difference of their ratios, settled", float(largest), ALIKE),
    )
    numbers = {
        "median": median,
        "share": share,
        "largest": float(largest),
        "beta": float(largest["beta"]),
        "input": round(float(largest["amplitude"]) * MM, 6),
    }
    return Finding(checks, {**numbers, **_close_to_breakaway(runs)})


@claim(
    14,
    "Near zero velocity exponential approaches Coulomb, static-dynamic has the higher jump",
    paper="exponential nearer",
    here="jumps {static_jump:.3f} and {exponential_jump:.3f}; exponential nearer to coulomb in "
    "{share:.0%} of the cases",
    reason="With v in mm/s and v_t = 1 mm/s both laws drop from mu_s to mu_d at v_t. In {share:.0%} of the"
    " {differ} cases in which the two differ in their distance from coulomb, exponential is nearer. The "
    "ratios of coulomb, static-dynamic and exponential are {low_coulomb:.3f}, {low_static_dynamic:.3f} and"
    " {low_exponential:.3f} at beta = 0.4, 1 mm, and {coulomb:.3f}, {static_dynamic:.3f} and "
    "{exponential:.3f} at 20 Hz, 0.05 mm.",
)
def nearer_to_coulomb(runs: Runs) -> Finding:
    """Compare the jumps of both laws, and the distances of their ratios from those of coulomb."""
    static_jump, exponential_jump = (_jump(runs.paper, law) for law in REGULARISED)
    differ, share = _exponential_nearer(runs.paper)
    checks = (
        above("jump of static-dynamic less that of exponential", static_jump - exponential_jump, 0.0),
        above("share of the cases in which exponential is nearer to coulomb", share, 0.5),
    )
    low = runs.paper.ratios(0.4, 1.0)
    return Finding(
        checks,
        {
            "static_jump": static_jump,
            "exponential_jump": exponential_jump,
            "differ": differ,
            "share": share,
            **{f"low_{law}": ratio for law, ratio in low.items()},
            **_close_to_breakaway(runs),
        },
    )


def _jump(run: Run, law: str) -> float:
    """Drop of the coefficient of friction at the end of the ramp of a regularised law."""
    p = record(run.config, law, 1.0, 1.0)[0]
    ramp, sliding = (curve(p["friction"]["v_t"][None], side, p)[0] for side in (0, 1))
    return float(ramp - sliding)


def _exponential_nearer(run: Run) -> tuple[int, float]:
    """Number of cases in which the laws differ, and the share in which exponential is nearer to coulomb."""
    ratios = run.ds["amplitude_ratio"]
    static_dynamic, exponential = (
        np.abs((ratios.sel(friction_law=law) - ratios.sel(friction_law=COULOMB)).values)
        for law in REGULARISED
    )
    differ = np.abs(static_dynamic - exponential) > MOVES
    nearer = (exponential < static_dynamic)[differ]
    return int(differ.sum()), float(nearer.mean()) if nearer.size else 0.0
