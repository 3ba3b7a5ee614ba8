"""The force that no name explains in published recordings: its gain on blocks left out, and its likeness.

    python scripts/missing_forces.py DIR

DIR holds the recordings as their owners published them (docs/real-data.md); those that are not there are left
out. Prints a row for each set.
"""

import argparse
import tempfile
from pathlib import Path

from wedgesweep import api
from wedgesweep.measured import read

MODEL = """
[oscillator]
mass_kg = {mass}
spring_N_per_mm = {spring}
damping_N_s_per_m = {damping}
normal_force_N = {friction}
contact = "ground"
[friction]
static = 1.0
dynamic = 1.0
[sweep]
friction_law = "coulomb"
excitation = "force"
frequency_hz = 1.0
amplitude_N = 1.0
"""
DYNO = """
time = { column = "Timestamp", unit = "datetime" }
displacement = { column = "Displacement (mm)", unit = "mm" }
force = { column = "Force (N)", unit = "N" }
"""
EMPS = """
time = { column = "time_s", unit = "s" }
displacement = { column = "position_mm", unit = "mm" }
force = { column = "force_N", unit = "N" }
"""
SEAL = """
time = { column = 1, unit = "ms" }
displacement = { column = 5, unit = "mm" }
force = { column = 7, unit = "N" }
"""
# File, columns, keys of the test, and the model: mass (kg), spring (N/mm), damping (N s/m), friction (N).
SETS = {
    "damper, soft": (
        "damper-dyno/t1_1_1_18_18_s5_n10_50psi.csv",
        DYNO,
        "columns.force.sign = -1\n",
        (0.39, 1.6, 1371.0, 13.6),
    ),
    "damper, hard": ("damper-dyno/t1_2_2_24_24_s5_n10_100psi.csv", DYNO, "", (0.39, 1.6, 1371.0, 13.6)),
    "carriage on a screw": ("emps.csv", EMPS, "", (95.1, 0.0, 203.4, 20.4)),
    "pneumatic seal, 1 bar": ("pneumatic-seal/Circle_1bar.csv", SEAL, "", (0.5, 0.0, 0.0, 5.6)),
}
CANDIDATES = (
    *("viscous_damping", "directional_damping", "quadratic_drag", "cubic_stiffness", "guide_friction"),
    *("friction_level", "stribeck", "presliding", "directional_friction", "empirical_force"),
)
SHOWN = 3  # nearest names


def row(folder: Path, file: Path, name: str, limit: float) -> str:
    """A row of the table."""
    _, columns, keys, (mass, spring, damping, friction) = SETS[name]
    model = MODEL.format(mass=mass, spring=spring, damping=damping, friction=friction)
    (folder / "model.toml").write_text(model)
    test = f'[[measurement.test]]\nfile = "{file}"\nkind = "loop"\n{keys}'
    text = f'[measurement]\nmodel = "model.toml"\n[measurement.columns]{columns}{test}'
    (folder / "measured.toml").write_text(text)
    measurement = read(folder / "measured.toml")
    found = api.diagnose_measurement(measurement, effects=CANDIDATES, n_jobs=2, time_limit_s=limit)
    base, force = found.document["ladder"][0], found.document["empirical_force"]
    if force is None:
        return f"| {name} | {found.verdict} | {share(base['accuracy_held_out'])} | not reached | | | |"
    named = force["named"]
    likely = ", ".join(f"{each['form']} {share(each['share'])}" for each in force.get("nearest", [])[:SHOWN])
    cells = [
        name,
        found.verdict,
        share(base["accuracy_held_out"]),
        f"{share(named['accuracy_held_out'])} ({' + '.join(named['effects']) or 'base model'})",
        share(force["accuracy_held_out"]),
        f"{force['degrees_of_freedom']:.0f}",
        likely or "not shown: no better than what has a name",
    ]
    return f"| {' | '.join(cells)} |"


def share(value: float | None) -> str:
    return "none" if value is None else f"{100.0 * value:.2g} %"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("directory", type=Path)
    parser.add_argument("--only", choices=SETS)
    parser.add_argument("--time-limit", type=float, default=600.0, help="of each set, s")
    given = parser.parse_args()
    head = ("recording", "verdict", "model on trial", "best named", "table", "freedom", "looks like")
    print(f"| {' | '.join(head)} |")
    print("|---|---|---|---|---|---|---|")
    for name in [given.only] if given.only else SETS:
        file = (given.directory / SETS[name][0]).resolve()
        if file.exists():
            with tempfile.TemporaryDirectory() as folder:
                print(row(Path(folder), file, name, given.time_limit), flush=True)


if __name__ == "__main__":
    main()
