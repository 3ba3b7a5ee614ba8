"""Time of a diagnosis, its parts, and how it grows with the number of tests.

The data: 12 tests of the synthesiser with nothing, one effect and a pair hidden in them; the same tests
half and twice as many. The whole is the command from a cold process with numba's cache warm, on two cores;
the parts are steps of one run within this process. Writes docs/bench_diagnosis.txt.
"""

import subprocess
import sys
import tempfile
import time
from itertools import pairwise
from pathlib import Path

from wedgesweep import measured, toml
from wedgesweep.diagnose import diagnosis
from wedgesweep.diagnose.work import Step
from wedgesweep.effects import EFFECTS

REPORT = Path(__file__).parent.parent / "docs" / "bench_diagnosis.txt"
COMMAND = [sys.executable, "-m", "wedgesweep"]
JOBS = 2
GOAL = 20.0  # s, of one diagnosis with pairs
# Below and above resonance (Hz, mm).
TESTS = (
    *((5.1, 0.98), (5.1, 2.2), (8.2, 0.60), (8.2, 1.1), (11.3, 0.22), (19.6, 0.060)),
    *((19.6, 0.115), (24.3, 0.085), (24.3, 0.12), (28.4, 0.040), (31.5, 0.024), (31.5, 0.060)),
)
HIDDEN = {
    "nothing": {},
    "velocity_lag": {"velocity_lag": {"time_s": 4e-4}},
    "viscous_damping + displacement_gain": {
        "viscous_damping": {"coefficient_N_s_per_m": 6.0},
        "displacement_gain": {"scale": 1.06},
    },
}
LAWS = ("coulomb", "static-dynamic", "exponential")
said = []


def say(line):
    print(line, flush=True)
    said.append(line)


def make(folder, law, effects, tests):
    """measured.toml of fresh data."""
    system = {
        "title": "true",
        "effects": effects,
        "sweep": {"friction_law": law, "beta": 1.0, "amplitude_mm": 0.1},
    }
    folder.mkdir()
    (folder / "true.toml").write_text(toml.dumps(system))
    rows = [{"frequency_hz": f, "amplitude_mm": a, "amplitude_std": 0.01} for f, a in tests]
    (folder / "tests.toml").write_text(toml.dumps({"test": rows}))
    command = ["synthesize", folder / "true.toml", "--tests", folder / "tests.toml", "-o", folder / "data"]
    subprocess.run([*COMMAND, *map(str, command), "--seed", "1"], check=True, capture_output=True)
    return folder / "data" / "measured.toml"


def whole(file, folder):
    """Wall time (s) of the command, from a cold process to the written report."""
    started = time.perf_counter()
    command = [*COMMAND, "diagnose", file, "-o", folder, "--n-jobs", JOBS]
    subprocess.run(list(map(str, command)), check=True, capture_output=True)
    return time.perf_counter() - started


def parts(file):
    """Verdict and seconds of each stage, in the order in which they began."""
    times = [("reading", time.perf_counter())]
    found = diagnosis.diagnose(
        measured.read(file),
        threads=JOBS,
        progress=lambda step: times.append((stage(step), time.perf_counter())),
    )
    times.append(("end", time.perf_counter()))
    spent = {}
    for (name, before), (_, after) in pairwise(times):
        spent[name] = spent.get(name, 0.0) + after - before
    return found.finding.verdict, spent


def stage(step):
    """The stage of a step; of the final fit without the effects, which its message names."""
    return step.stage if isinstance(step, Step) else step.partition(" of ")[0]


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        say(f"One diagnosis of {len(TESTS)} tests, {len(EFFECTS)} effects, {JOBS} threads; s (goal {GOAL:g})")
        say(f"{'hidden':38}{'law':16}{'verdict':18}{'whole':>7}  parts")
        for hidden, effects in HIDDEN.items():
            for law in LAWS:
                place = folder / f"{hidden}-{law}"
                file = make(place, law, effects, TESTS)
                parts(file)  # compiles
                seconds = whole(file, place / "found")
                verdict, spent = parts(file)
                shown = ", ".join(f"{part} {value:.1f}" for part, value in spent.items() if value >= 0.05)
                say(f"{hidden:38}{law:16}{verdict:18}{seconds:7.1f}  {shown}")
        say("\nOver the number of tests (velocity_lag, static-dynamic):")
        for count in (6, 12, 24):
            tests = [(f, a * (1.0 + 0.01 * (i // 12))) for i, (f, a) in enumerate((*TESTS, *TESTS))]
            chosen = tests[::2][:6] if count == 6 else tests[:count]
            place = folder / f"{count}"
            seconds = whole(make(place, "static-dynamic", HIDDEN["velocity_lag"], chosen), place / "found")
            say(f"{count:4d} tests {seconds:7.1f} s")
    REPORT.write_text("\n".join(said) + "\n")


if __name__ == "__main__":
    main()
