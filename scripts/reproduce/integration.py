"""Claim on the integration: tolerance of the integrator, and treatment of sign(v)."""

from reproduce.findings import Finding, below, claim
from reproduce.runs import LAWS, Runs
from reproduce.single_case import Changes, single

COULOMB, STATIC_DYNAMIC, EXPONENTIAL = LAWS
# Law, beta and input (mm) of the cases that are integrated again with a smaller tolerance.
CASES = ((COULOMB, 0.4, 1.0), (STATIC_DYNAMIC, 1.472, 0.05), (EXPONENTIAL, 2.208, 0.1))
NEXT_TO_BREAKAWAY = 1.472, 0.05  # beta, mm
SETTLE = 60  # periods
FINER = 1e-2
SAME = 1e-3
UNLIKELY = 0.1  # an error of the ratio below this is no source of the discrepancy


@claim(
    17,
    "The integration method is an unlikely source of errors",
    paper="unlikely",
    here="the tolerance changes a ratio by {change:.0e}, a ramp in place of sign(v) by {shift:.0%}",
    reason="A solver that resolves the corners of the law is not a source of errors: an rtol of {rtol:g} "
    "gives the same as {fine_rtol:g}. The treatment of sign(v) is one. With mu_d alone, the ratio at beta "
    "= {beta:g}, {input:g} mm is {sharp:.3f} with set-valued friction and {soft:.3f} with a ramp up to "
    "v_t. A smoothed sign(v) creeps where it should stick (claim 6).",
)
def method(runs: Runs) -> Finding:
    """Integrate again with a smaller tolerance, and with a ramp in place of sign(v)."""
    change = max(_refined(runs, *case) for case in CASES)
    beta, a = NEXT_TO_BREAKAWAY
    ramp = {"friction": {"static": runs.paper.config.document["friction"]["dynamic"]}}
    sharp = _ratio(runs, COULOMB, beta, a)
    soft = _ratio(runs, STATIC_DYNAMIC, beta, a, ramp)
    shift = abs(soft / sharp - 1.0)
    checks = (
        below("largest change of a ratio by a hundredth of rtol", change, SAME),
        below("change of the coulomb ratio by a ramp up to v_t for sign(v)", shift, UNLIKELY),
    )
    rtol = runs.paper.config.solver.rtol
    numbers = {"rtol": rtol, "fine_rtol": rtol * FINER, "beta": beta, "input": a}
    return Finding(checks, {"change": change, "shift": shift, "sharp": sharp, "soft": soft, **numbers})


def _refined(runs: Runs, law: str, beta: float, a: float) -> float:
    """Relative change of the amplitude ratio at a finer tolerance."""
    rtol = runs.paper.config.solver.rtol
    coarse, fine = (_ratio(runs, law, beta, a, {"solver": {"rtol": each}}) for each in (rtol, rtol * FINER))
    return abs(coarse / fine - 1.0)


def _ratio(runs: Runs, law: str, beta: float, a: float, changes: Changes | None = None) -> float:
    changes = changes or {}
    settled = {**changes, "solver": {**changes.get("solver", {}), "settle_periods": SETTLE}}
    return single(runs.paper, law, beta, a, settled)["amplitude_ratio"]
