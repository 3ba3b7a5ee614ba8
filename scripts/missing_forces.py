"""The force that no name explains in published recordings: its gain on blocks left out, and its likeness.

    python scripts/missing_forces.py DIR

DIR holds the recordings as their owners published them (docs/real-data.md); those that are not there are left
out. Prints a row for each set.
"""

import argparse
import tempfile
from pathlib import Path

from real_sets import FILES, begin

from wedgesweep import api
from wedgesweep.measured import read

CANDIDATES = (
    *("viscous_damping", "directional_damping", "quadratic_drag", "cubic_stiffness", "guide_friction"),
    *("friction_level", "stribeck", "presliding", "directional_friction", "empirical_force"),
)
SHOWN = 3  # nearest names


def row(name: str, source: Path, folder: Path, limit: float) -> str:
    """A row of the table."""
    begin(name, source, folder)
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
    parser.add_argument("--only", choices=FILES)
    parser.add_argument("--time-limit", type=float, default=600.0, help="of each set, s")
    given = parser.parse_args()
    head = ("recording", "verdict", "model on trial", "best named", "table", "freedom", "looks like")
    print(f"| {' | '.join(head)} |")
    print("|---|---|---|---|---|---|---|")
    for name in [given.only] if given.only else FILES:
        if all((given.directory / file).exists() for file in FILES[name]):
            with tempfile.TemporaryDirectory() as folder:
                print(row(name, given.directory.absolute(), Path(folder), given.time_limit), flush=True)


if __name__ == "__main__":
    main()
