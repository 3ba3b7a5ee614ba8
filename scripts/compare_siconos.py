"""Cases with lift-off against siconos (Moreau-Jean time stepping), extrapolated to a step of zero.

    .venv/bin/python scripts/compare_siconos.py [number of cases [force of a wedge's spring, N]]

With a force damping is constant: the springs of the wedges stand on the bolster.
Needs Debian's python3-siconos. Errors of time stepping fall with the step, but unevenly, as impacts come
between two steps: of the lines through two of the results the median at zero is taken. Steps must be short
for that: from 800 to 2,000 a period differences of up to 0.3 % remain, which shrink in proportion to the step
beyond. Prints a row per case, and the largest differences. Takes half an hour.
"""

import json
import subprocess
import sys
import tempfile
from itertools import combinations
from math import inf
from pathlib import Path
from time import process_time

import numpy as np

from wedgesweep import config
from wedgesweep.sweep import variables
from wedgesweep.sweep.cases import solve_cases

PYTHON, MODEL = "/usr/bin/python3", Path(__file__).parent / "siconos_model.py"
STEPS = (2000, 4000, 8000)
SETTLE, KEEP = 40, 2
# Change of the last period over the input amplitude: longer transients would tell of their errors in time.
SETTLED = 1e-4
STUDY = """
[suspension]
joints = "unilateral"
{damping}
[sweep]
friction_law = ["coulomb"]
beta = [0.75, 0.8, 0.85, 0.9, 0.95, 1.0, 1.05, 1.1, 1.15, 1.2, 1.25, 1.3]
amplitude_mm = [0.4, 0.55, 0.75, 1.0, 1.5, 2.2, 3.2, 4.75]
[solver]
method = "event-driven"
rtol = 1e-9
settle_periods = 40
kept_periods = 2
"""


def solved(preload):
    """Records of the study's cases that lift off and have settled in the same window, and their cases."""
    damping = f'damping = "constant"\nwedge_preload_N = {preload}' if preload else ""
    study = config.parse(STUDY.format(damping=damping))
    dtype = variables.record_dtype({"phase": 0, "harmonic": variables.HARMONICS, "part": 2})
    rows = study.records()
    found = solve_cases(rows, np.arange(len(rows)), study.solver, inf, dtype)
    opens = (found["lift_off_fraction"] > 0.0) & (found["periodicity"] < SETTLED)
    return found[opens], [study.case_list()[i] for i in np.flatnonzero(opens)]


def is_there():
    """Whether siconos is installed."""
    command = [PYTHON, "-c", "import siconos.kernel"]
    return Path(PYTHON).exists() and subprocess.run(command, capture_output=True, check=False).returncode == 0


def siconos(cases, steps, preload):
    """Amplitude ratio and open shares of cases, shape (n, 3), and the processor time (s)."""
    window = {"restitution": 0.0, "settle": SETTLE, "keep": KEEP, "steps": steps, "preload": preload}
    given = [{"beta": case.beta, "amplitude": case.amplitude, **window} for case in cases]
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "results.json"
        subprocess.run(
            [PYTHON, str(MODEL), str(out)],
            input=json.dumps(given),
            text=True,
            stdout=subprocess.DEVNULL,
            check=True,
        )
        answer = json.loads(out.read_text())
        return np.array(answer["results"]), answer["seconds"]


def extrapolated(runs):
    """Limit of runs, shape (steps, ...), at a step of zero: median over the lines through two of them.

    A few time steppings settle on another motion than those with other steps.
    """
    pairs = combinations(zip(STEPS, runs, strict=True), 2)
    return np.median([(n * fine - m * coarse) / (n - m) for (m, coarse), (n, fine) in pairs], axis=0)


def main() -> None:
    """Print the comparison."""
    number = int(sys.argv[1]) if len(sys.argv) > 1 else 30
    preload = float(sys.argv[2]) if len(sys.argv) > 2 else 0.0
    began = process_time()
    records, cases = solved(preload)
    print(f"wedgesweep: {len(cases)} cases, {process_time() - began:.2f} s of processor time")
    chosen = np.unique(np.linspace(0, len(cases) - 1, number).astype(int))
    cases, records = [cases[i] for i in chosen], records[chosen]
    runs = np.array([siconos(cases, steps, preload)[0] for steps in STEPS])
    limit = extrapolated(runs)
    names = "amplitude_ratio", "column_open_fraction", "bolster_open_fraction"
    own = np.array([records[name] for name in names]).T
    print("  beta  a, mm    ratio  siconos  difference  column open  siconos  bolster open  siconos")
    for case, mine, its in zip(cases, own, limit, strict=True):
        print(
            f"{case.beta:6.2f} {case.amplitude * 1e3:6.2f} {mine[0]:8.5f} {its[0]:8.5f} "
            f"{its[0] / mine[0] - 1.0:11.1e} {mine[1]:12.4f} {its[1]:8.4f} {mine[2]:13.4f} {its[2]:8.4f}"
        )
    off = np.abs(limit[:, 0] / own[:, 0] - 1.0)
    print(f"ratio: largest difference {off.max():.1e}, median {np.median(off):.1e}")
    print(f"open shares: largest difference {np.abs(limit - own)[:, 1:].max():.4f}")


if __name__ == "__main__":
    main()
