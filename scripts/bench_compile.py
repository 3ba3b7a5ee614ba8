"""What a first use costs: CPU seconds of commands from an empty cache of compiled code, and with a full one.

The difference is compile time. Writes docs/bench_compile.txt.
"""

import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parent.parent
REPORT = ROOT / "docs" / "bench_compile.txt"
GOAL = 10.0  # s, compilation of a first `run`
SWEEP = """\
[sweep]
friction_law = ["coulomb", "static-dynamic"]
beta = [0.4, 1.1]
amplitude_mm = 0.2
[solver]
settle_periods = 3
kept_periods = 2
samples_per_period = 32
"""
STEADY = SWEEP.replace("settle_periods = 3", 'method = "event-driven"\nsettle = "steady"')
EFFECT = "[effects.viscous_damping]\ncoefficient_N_s_per_m = 1.0\n"
RUN = ("run", "sweep.toml", "-o", "out.nc", "--fresh", "--n-jobs", "1", "--solver")
# Name: config and command.
COMMANDS = {
    "run, event-driven": (SWEEP, (*RUN, "event-driven")),
    "run, event-driven, steady": (STEADY, (*RUN, "event-driven")),
    "run, event-driven, an effect": (SWEEP + EFFECT, (*RUN, "event-driven")),
    "run, radau": (SWEEP, (*RUN, "radau")),
    "diagnose": (
        "",
        ("diagnose", str(ROOT / "examples/bench/measured.toml"), "-o", "found", "--n-jobs", "1"),
    ),
}


def seconds(folder, command):
    """CPU seconds (user and system) of a command and of all that it starts."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    variables = {"PYTHONPATH": str(ROOT), "WEDGESWEEP_CACHE_DIR": str(folder / "cache")}
    subprocess.run(
        [sys.executable, "-m", "wedgesweep", *command],
        cwd=folder,
        env={**os.environ, **variables},
        check=True,
        capture_output=True,
    )
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main(chosen):
    lines = [
        f"CPU seconds of a first and of a second run (goal for the compilation of a first `run`: {GOAL:g})"
    ]
    lines.append(f"{'':30}{'first':>8}{'second':>8}{'compiling':>11}")
    for name in chosen or COMMANDS:
        text, command = COMMANDS[name]
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "sweep.toml").write_text(text)
            first, second = (seconds(Path(folder), command) for _ in range(2))
        lines.append(f"{name:30}{first:8.1f}{second:8.1f}{first - second:11.1f}")
    print("\n".join(lines))
    if not chosen:
        REPORT.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main(sys.argv[1:])
