"""Claims on the suspension as a whole: rest position, resonance, frictionless limit."""

from math import pi

from reproduce.findings import Finding, claim, near
from reproduce.runs import LAWS, MM, Run, Runs, changed, identifier
from reproduce.single_case import mirrored_columns, record, single
from wedgesweep.systems.suspension.equilibrium import resonance as frictionless_resonance
from wedgesweep.systems.suspension.parameters import driven_mass, moving_mass

# Relative tolerances: of printed numbers, of numbers read off a diagram, of a ratio that is said to reach 1.
PRINTED, READ_OFF, REACHED = 3e-3, 0.05, 0.1
FAR = 100.0  # beta that stands for infinity
LONG = 300  # periods until large motions, which friction hardly damps, have settled


@claim(
    1,
    "Natural frequency, frequency range, number of cases",
    paper="85.35 rad/s; 1.36 to 40.76 Hz; 1800 cases",
    here="{omega_n:.4f} rad/s; {lowest:.2f} to {highest:.2f} Hz; {cases} cases",
    reason="The paper gives the ends of its ranges and the values that it shows, but not the grid between "
    "them. The grid of these runs is in configs/paper.toml.",
)
def parameters_and_cases(runs: Runs) -> Finding:
    """Compare the numbers that follow from Table 1 and from the ranges."""
    hertz, size = runs.paper.ds["frequency"].values, runs.paper.ds["status"].size
    omega_n, lowest, highest = runs.paper.omega_n, float(hertz[0]), float(hertz[-1])
    checks = (
        near("sqrt(k_b/M_b) (rad/s)", omega_n, 85.35, PRINTED),
        near("lowest frequency (Hz)", lowest, 1.36, PRINTED),
        near("highest frequency (Hz)", highest, 40.76, PRINTED),
        near("number of cases", size, 1800, 0.0),
    )
    return Finding(checks, {"omega_n": omega_n, "lowest": lowest, "highest": highest, "cases": size})


@claim(
    2,
    "Equilibrium position y_0",
    paper="-2.1941 mm",
    here="{rest:.4f} mm",
    reason="Table 1 gives {rest:.4f} mm, or {mirrored:.4f} mm if the columns lean the other way. The "
    "rest position is proportional to 1/stiffness: all springs scaled by {springs:.4f} (paper-y0.toml) "
    "give {scaled:.4f} mm, and also the paper's resonance (claim 3).",
)
def rest_position(runs: Runs) -> Finding:
    """Compare the frictionless rest position."""
    rest, scaled = (run.ds.attrs["rest_position"] * MM for run in (runs.paper, runs.scaled))
    numbers = {
        "rest": rest,
        "mirrored": _mirrored(runs.paper) * MM,
        "springs": _spring_scale(runs),
        "scaled": scaled,
    }
    return Finding((near("rest position under gravity (mm)", rest, -2.1941, READ_OFF),), numbers)


def _mirrored(run: Run) -> float:
    """Rest position (m) with the column angle reversed."""
    config = changed(run.config, mirrored_columns(run.config))
    return float(record(config, "coulomb", 1.0, 1.0)["geometry"]["rest"][0])


def _spring_scale(runs: Runs) -> float:
    scaled, printed = (run.config.suspension["bolster_spring"] for run in (runs.scaled, runs.paper))
    return scaled / printed


@claim(
    3,
    "Resonance at about 80 % of omega_n",
    paper="0.8 omega_n, about 11 Hz",
    here="{resonance:.3f} omega_n, {hertz:.1f} Hz",
    reason="On the grid the ratio is largest at beta = {coulomb:g} (coulomb), {static_dynamic:g} "
    "(static-dynamic) and {exponential:g} (exponential). With the springs scaled by {springs:.4f}, which "
    "give the paper's y_0, the resonance is {scaled:.3f} omega_n, {scaled_hertz:.1f} Hz, and the ratio is "
    "largest at beta = {scaled_coulomb:g}, {scaled_static_dynamic:g} and {scaled_exponential:g}. The "
    "paper's y_0 and its resonance agree with each other, and both contradict its Table 1.",
    large=True,
)
def resonance(runs: Runs) -> Finding:
    """Compare the frictionless resonance and the frequencies of the largest ratios."""
    here, scaled = runs.paper.resonance, runs.scaled.resonance
    hertz, scaled_hertz = (beta * runs.paper.omega_n / (2.0 * pi) for beta in (here, scaled))
    peaks, scaled_peaks = _peaks(runs.paper), _peaks(runs.scaled)
    numbers = {
        "resonance": here,
        "hertz": hertz,
        "springs": _spring_scale(runs),
        "scaled": scaled,
        "scaled_hertz": scaled_hertz,
        **peaks,
        **{f"scaled_{law}": peak for law, peak in scaled_peaks.items()},
    }
    by_law = (near(f"beta of the largest ratio, {law}", peak, 0.8, READ_OFF) for law, peak in peaks.items())
    free = near("resonance over omega_n, frictionless", here, 0.8, READ_OFF)
    return Finding((free, near("the same (Hz)", hertz, 11.0, READ_OFF), *by_law), numbers)


def _peaks(run: Run) -> dict[str, float]:
    """Frequency ratio of the largest amplitude ratio of each law."""
    largest = run.ds["amplitude_ratio"].max("amplitude")
    return {identifier(law): float(largest.sel(friction_law=law).idxmax("beta")) for law in LAWS}


@claim(
    4,
    "At high frequencies the amplitude ratio goes to one; it is there by 20 Hz",
    paper="1 at 20 Hz",
    here="{at_20:.2f} at 20 Hz, {at_end:.2f} at beta = {end:g} (coulomb, 1 mm)",
    reason="Far above resonance the ratio does tend to about 1 (frictionless: {limit:.3f}), but slowly. "
    "Without friction it is {free_at_20:.2f} at 20 Hz and {free_at_end:.2f} at beta = {end:g}; with "
    "friction and 1 mm it is {at_20:.2f} and {at_end:.2f} after {periods} periods. The springs that give "
    "the paper's y_0 yield {scaled_at_20:.2f} and {scaled_at_end:.2f} without friction, which is closer to"
    " the paper.",
    large=True,
)
def unit_ratio(runs: Runs) -> Finding:
    """Compare the ratio with 1 at 20 Hz, at the end of the range and far above."""
    run = runs.paper
    betas = {"at_20": run.beta_of(20.0), "at_end": float(run.ds["beta"][-1])}
    settled = {name: _settled_ratio(run, beta) for name, beta in betas.items()}
    free = {f"free_{name}": frictionless_ratio(run, beta) for name, beta in betas.items()}
    scaled = {f"scaled_{name}": frictionless_ratio(runs.scaled, beta) for name, beta in betas.items()}
    limit, end = frictionless_ratio(run, FAR), betas["at_end"]
    checks = (
        near("frictionless ratio far above resonance", limit, 1.0, REACHED),
        near("frictionless ratio at 20 Hz", free["free_at_20"], 1.0, REACHED),
        near("ratio at 20 Hz, coulomb, 1 mm", settled["at_20"], 1.0, REACHED),
        near(f"ratio at beta = {end:g}, coulomb, 1 mm", settled["at_end"], 1.0, REACHED),
    )
    return Finding(checks, {"limit": limit, "end": end, "periods": LONG, **settled, **free, **scaled})


def _settled_ratio(run: Run, beta: float) -> float:
    return single(run, "coulomb", beta, 1.0, {"solver": {"settle_periods": LONG}})["amplitude_ratio"]


def frictionless_ratio(run: Run, beta: float) -> float:
    """Amplitude ratio of the suspension without friction on any face."""
    p = record(run.config, "coulomb", beta, 1.0)[0]
    squared = p["input"]["omega"] ** 2
    return float(abs(driven_mass(p) / moving_mass(p) * squared / (squared - frictionless_resonance(p) ** 2)))
