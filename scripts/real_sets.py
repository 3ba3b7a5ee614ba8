"""Recordings as their owners published them: from `init` to the answer, with the lines that were edited.

DIR holds the sets, which are no part of wedgesweep. Each set is begun in OUT/NAME, its lines are edited, it
is checked and diagnosed within a time limit, one after the other; those that are not in DIR are left out.
Prints a table in Markdown: the answers, or with ``--forces`` the force that no name explains, its gain on
blocks left out, and its likeness.
"""

import argparse
import json
import re
import subprocess
import sys
from pathlib import Path

DYNO = ("1_1_18_18_s5_n10_50", "2_2_24_24_s5_n10_100")
FILES = {
    "seal": [f"pneumatic-seal/Circle_{bar}bar.csv" for bar in (1, 3, 5, 7)],
    "torsion": ["torsion-oscillator/free-decays.csv"],
    "emps": ["emps.csv"],
    **{f"dyno {number}": [f"damper-dyno/t1_{name}psi.csv"] for number, name in enumerate(DYNO, 1)},
    "spring": [f"spring-mass/experiment_{number}.csv" for number in (1, 2, 3)],
    "frame": ["frame-250g.csv", "frame-450g.csv"],
    "magnet": ["torsion-oscillator/free-decays-with-magnet.csv"],
    "rack": ["rack-pinion/a3MR.csv", "rack-pinion/a3NI.csv"],
}
# Lines to edit: file, pattern, replacement.
RPM = 'unit = "m/s", scale = 3.3333e-4, delay_ms = 4.0'
EDITS = {
    "frame": [
        ("model.toml", r"mass_kg = .*", "mass_kg = 3.0799"),
        ("model.toml", r"spring_N_per_mm = .*", "spring_N_per_mm = 1.191"),
        ("model.toml", r"contact = .*", 'contact = "ground"'),
    ],
    "rack": [
        ("measured.toml", r'unit = "mm/s"', RPM),
        ("measured.toml", r"scale = 1.0", "scale = 200.0"),
    ],
}
# How many nearest names of a force are shown.
SHOWN = 3
ANSWERS = ("set", "lines edited", "verdict", "best of each size: accuracy (held out)", "answer")
FORCES = ("recording", "verdict", "model on trial", "best named", "table", "freedom", "looks like")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("directory", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--only", choices=FILES, nargs="*", default=list(FILES))
    parser.add_argument("--time-limit", default="120s")
    parser.add_argument("--forces", action="store_true", help="tell the force that no name explains")
    options = parser.parse_args()
    head = FORCES if options.forces else ANSWERS
    print(f"| {' | '.join(head)} |\n{'|---' * len(head)}|")
    for name in options.only:
        if all((options.directory / file).exists() for file in FILES[name]):
            print(f"| {' | '.join(row(name, options))} |", flush=True)


def row(name: str, options: argparse.Namespace) -> list[str]:
    """Cells of a set, which is begun, checked and diagnosed."""
    place = options.out / name
    begin(name, options.directory.absolute(), place)
    command("check", "measured.toml", place=place)
    more = ("--empirical-force",) if options.forces else ()
    limit = ("--time-limit", options.time_limit)
    told = command("diagnose", "measured.toml", "-o", "found", "--no-report", *limit, *more, place=place)
    found = json.loads((place / "found" / "diagnosis.json").read_text())
    return [name, *(force(found) if options.forces else answer(name, found, told))]


def answer(name: str, found: dict, told: str) -> list[str]:
    best = "; ".join(rung(each) for each in found["ladder"])
    lines = (line for line in told.splitlines() if found["verdict"] in line or line.endswith("."))
    return [str(len(EDITS.get(name, ()))), f"`{found['verdict']}`", best, next(lines, "")]


def force(found: dict) -> list[str]:
    base, table = share(found["ladder"][0]["accuracy_held_out"]), found["empirical_force"]
    if table is None:
        return [found["verdict"], base, "not reached", "", "", ""]
    named = table["named"]
    likely = ", ".join(f"{each['form']} {share(each['share'])}" for each in table.get("nearest", [])[:SHOWN])
    return [
        *(found["verdict"], base),
        f"{share(named['accuracy_held_out'])} ({' + '.join(named['effects']) or 'base model'})",
        *(share(table["accuracy_held_out"]), f"{table['degrees_of_freedom']:.0f}"),
        likely or "not shown: no better than what has a name",
    ]


def share(value: float | None) -> str:
    return "none" if value is None else f"{100.0 * value:.2g} %"


def begin(name: str, source: Path, place: Path) -> None:
    """Write a set's measured.toml and model: what `init` makes of the files, with lines edited."""
    place.mkdir(parents=True, exist_ok=True)
    files = [str(source / file) for file in FILES[name]]
    command("init", "--force", "measured.toml", "--data", *files, place=place)
    edits = EDITS.get(name, [])
    for file, pattern, line in edits:
        text, count = re.subn(pattern, line, (place / file).read_text(), count=1)
        if not count:
            sys.exit(f"{place / file}: no {pattern}")
        (place / file).write_text(text)
    if any(file == "measured.toml" for file, _, _ in edits):
        command("init", "--force", "model.toml", "--data", "measured.toml", place=place)


def rung(each: dict) -> str:
    held_out = each.get("accuracy_held_out")
    aside = "" if held_out is None else f" ({100 * held_out:.1f} %)"
    accuracy = each["accuracy"]
    shown = "none" if accuracy is None else f"{100 * accuracy:.1f} %"
    return f"{' + '.join(each['effects']) or 'model on trial'} {shown}{aside}"


def command(*words: str, place: Path) -> str:
    """What a command says; both its outputs are also written beside its files."""
    done = subprocess.run(
        [sys.executable, "-m", "wedgesweep", *words], cwd=place, capture_output=True, text=True, check=False
    )
    (place / f"{words[0]}.txt").write_text(done.stdout + done.stderr)
    if done.returncode not in (0, 3):
        sys.exit(f"{' '.join(words)}: {done.stdout}{done.stderr}")
    return done.stdout


if __name__ == "__main__":
    main()
