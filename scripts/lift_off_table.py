"""What lift-off changes in the paper's cases: the table of docs/paper.md, from both kinds of joints.

.venv/bin/python scripts/lift_off_table.py
"""

from math import inf
from pathlib import Path

import numpy as np
import xarray as xr
from reproduce.runs import UNILATERAL, changed
from reproduce.suspension import changes_by_lift_off

from wedgesweep import config
from wedgesweep.config import Config
from wedgesweep.sweep import variables
from wedgesweep.sweep.cases import solve_cases

PAPER = Path(__file__).parents[1] / "configs" / "paper.toml"
FREQUENCIES, INPUTS_MM = (0.8, 1.1, 1.2, 1.75, 3.0), (0.3, 1.0, 4.75)
NAMES = ("amplitude_ratio", "lift_off_fraction", "impact_energy", "dissipated_energy")


def solved(study: Config) -> xr.Dataset:
    """All cases of a study, with the event-driven solver."""
    dtype = variables.record_dtype({"phase": 0, "harmonic": variables.HARMONICS, "part": 2})
    cases = study.records()
    found = solve_cases(cases, np.arange(len(cases)), study.solver, inf, dtype)
    shape, coordinates = study.sweep.shape, study.case_coordinates()
    return xr.Dataset({name: (variables.GRID, found[name].reshape(shape)) for name in NAMES}, coordinates)


def row(law: str, beta: float, held: xr.Dataset, opens: xr.Dataset) -> str:
    """Amplitude ratios of both kinds of joints, and the share of time with a contact open."""
    cells = []
    for millimetres in INPUTS_MM:
        case = {"friction_law": law, "beta": beta, "amplitude": millimetres * 1e-3}
        before, after = (ds["amplitude_ratio"].sel(case).item() for ds in (held, opens))
        cells.append(f"{before:.3f} → {after:.3f} ({opens['lift_off_fraction'].sel(case).item():.0%})")
    return f"| {law} | {beta:g} | {' | '.join(cells)} |"


def main() -> None:
    """Print the table, and the numbers of claim 15."""
    study = config.load(PAPER)
    held = solved(changed(study, {"solver": {"method": "event-driven"}}))
    opens = solved(changed(study, UNILATERAL))
    print("| law | $\\beta$ |", " | ".join(f"$a$ = {each:g} mm" for each in INPUTS_MM), "|")
    print("| --- " * (2 + len(INPUTS_MM)) + "|")
    for law in study.sweep.friction_law:
        for beta in FREQUENCIES:
            print(row(law, beta, held, opens))
    for name, number in changes_by_lift_off(held, opens).items():
        print(f"{name}: {number:.3g}")


if __name__ == "__main__":
    main()
