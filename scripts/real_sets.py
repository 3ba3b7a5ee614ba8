"""Recordings as their owners published them: from `init` to the answer, with the lines that were edited.

DIR holds the sets, which are no part of wedgesweep. Each set is begun in OUT/NAME, its lines are edited, it
is checked and diagnosed within a time limit, one after the other. Prints a table in Markdown.
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


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("directory", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--only", choices=FILES, nargs="*", default=list(FILES))
    parser.add_argument("--time-limit", default="120s")
    options = parser.parse_args()
    print(
        "| set | lines edited | verdict | best of each size: accuracy (held out) | answer |",
        "|---|---|---|---|---|",
        sep="\n",
    )
    for name in options.only:
        print(row(name, options.directory.absolute(), options.out / name, options.time_limit), flush=True)


def row(name: str, source: Path, place: Path, limit: str) -> str:
    begin(name, source, place)
    command("check", "measured.toml", place=place)
    told = command(
        "diagnose", "measured.toml", "-o", "found", "--no-report", "--time-limit", limit, place=place
    )
    found = json.loads((place / "found" / "diagnosis.json").read_text())
    best = "; ".join(rung(each) for each in found["ladder"])
    sentence = next(
        (line for line in told.splitlines() if found["verdict"] in line or line.endswith(".")), ""
    )
    return f"| {name} | {len(EDITS.get(name, ()))} | `{found['verdict']}` | {best} | {sentence} |"


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
