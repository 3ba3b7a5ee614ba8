"""Time and memory of ``wedgesweep run`` over the number of cases, and what a sweep costs beyond solving.

Each run is a process of its own that starts cold, with numba's cache warm. CPU time is that of all processes
of a run; it says more than wall time where other jobs share the machine. Memory: the largest process, and the
sum over all processes of a run (proportional set size, sampled). Writes docs/bench_scaling.txt and draws
docs/scaling.png. Its parts can be run by their names, bench_scaling.py [cases [MOST]] [paper] [radau], where
the others keep the lines of an earlier run. MOST: the largest number of cases, by default all grids.
bench_scaling.py picture draws the picture from the report.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from math import inf
from pathlib import Path
from typing import NamedTuple

import matplotlib as mpl
import numpy as np
import xarray as xr

mpl.use("Agg")
from matplotlib import pyplot as plt

from wedgesweep.figures import style

ROOT = Path(__file__).parent.parent
REPORT, PICTURE = ROOT / "docs" / "bench_scaling.txt", ROOT / "docs" / "scaling.png"
COMMAND = [sys.executable, "-m", "wedgesweep", "run"]
LAWS = ["coulomb", "static-dynamic", "exponential"]
# Frequencies x amplitudes, of three laws each: 99, 999, 9,999, 99,999 and 1,000,119 cases.
GRIDS = ((3, 11), (9, 37), (33, 101), (123, 271), (389, 857))
PAPER_CASES, PAPER_GOAL = 1800, 4.0
SAMPLING = 0.1  # s between looks at the memory
EVENT_DRIVEN = """
method = "event-driven"
rtol = 1e-5
settle_periods = 60
kept_periods = 2
samples_per_period = 64
keep_waveforms = false
"""


said: list[str] = []


def say(line):
    """Print a line, and keep it for the report."""
    print(line, flush=True)
    said.append(line)


class Cost(NamedTuple):
    """Wall and CPU time (s), memory (bytes) of the largest process and of all together, bytes of the file."""

    wall: float
    cpu: float
    largest: int
    together: int
    file: int


def tree_memory(session):
    """Proportional set size (bytes) of all processes of a session; 0 where /proc does not tell."""
    total = 0
    for path in Path("/proc").glob("[0-9]*"):
        try:
            if int((path / "stat").read_text().rsplit(")", 1)[1].split()[3]) == session:
                total += int((path / "smaps_rollup").read_text().split("Pss:")[1].split()[0])
        except (OSError, IndexError):  # it has ended meanwhile
            continue
    return total * 1024


def run(config, out, *options):
    """One cold process from the config to the closed netCDF file."""
    started, together = time.perf_counter(), 0
    process = subprocess.Popen(
        [*COMMAND, str(config), "-o", str(out), *options],
        start_new_session=True,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
    )
    while True:
        pid, status, usage = os.wait4(process.pid, os.WNOHANG)
        if pid:
            break
        together = max(together, tree_memory(process.pid))
        time.sleep(SAMPLING)
    wall = time.perf_counter() - started
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode > 1:  # 1: some cases failed
        sys.exit(process.stderr.read().decode())
    largest = usage.ru_maxrss * 1024
    # Sampling misses peaks; all processes together hold at least what the largest one holds.
    return Cost(wall, usage.ru_utime + usage.ru_stime, largest, max(together, largest), out.stat().st_size)


def values(numbers):
    return "[" + ", ".join(f"{number:.9g}" for number in numbers) + "]"


def written(path, betas, amplitudes, solver, laws=LAWS):
    """A config file of a grid; amplitudes in mm."""
    names = ", ".join(f'"{law}"' for law in laws)
    sweep = f"friction_law = [{names}]\nbeta = {values(betas)}\namplitude_mm = {values(amplitudes)}"
    path.write_text(f"[sweep]\n{sweep}\n[solver]\n{solver}")
    return path


def middles(count):
    """Middles of equal parts of (0, 1): grids of any size then cost the same per case."""
    return (np.arange(count) + 0.5) / count


def scaling(folder, largest=inf):
    """Costs over the number of cases: metrics only, event-driven, two jobs."""
    say("cases      wall s    CPU s   CPU ms/case   largest process MB   all processes MB   file MB")
    costs = {}
    for frequencies, amplitudes in GRIDS:
        cases = len(LAWS) * frequencies * amplitudes
        if cases > largest:
            say(f"{cases:7} cases: not run here")
            continue
        config = written(
            folder / "grid.toml",
            0.1 + 2.9 * middles(frequencies),
            0.005 * 950.0 ** middles(amplitudes),
            EVENT_DRIVEN,
        )
        cost = costs[cases] = run(config, folder / f"{cases}.nc", "--n-jobs", "2")
        (folder / f"{cases}.nc").unlink()
        say(
            f"{cases:7} {cost.wall:9.1f} {cost.cpu:8.1f} {1e3 * cost.cpu / cases:13.3f} "
            f"{cost.largest / 1e6:20.0f} {cost.together / 1e6:18.0f} {cost.file / 1e6:9.1f}"
        )
    fewest, *_, before, most = costs
    slope = (costs[most].cpu - costs[fewest].cpu) / (most - fewest)
    last = (costs[most].cpu - costs[before].cpu) / (most - before)
    say(f"fixed part {costs[fewest].cpu - slope * fewest:.1f} s, {1e3 * slope:.3f} ms a case more (CPU)")
    say(f"linear: the last {most - before} cases took {1e3 * last:.3f} ms each")
    each = (costs[most].together - costs[fewest].together) / (most - fewest)
    say(f"memory: {each:.0f} bytes a case; file: {costs[most].file / most:.0f} bytes a case")
    draw("\n".join(said))


def table(lines):
    """Columns of the table in the lines of the part ``cases``, shape (7, n)."""
    rows = [line.split() for line in lines.splitlines() if re.fullmatch(r"[\d. ]+", line)]
    return np.array(rows, float).T


def draw(lines):
    """The picture of cost against number of cases."""
    cases, _, cpu, _, largest, together, _ = table(lines)
    figure, (left, right) = plt.subplots(1, 2, figsize=(7.0, 2.8), layout="constrained")
    slope = (cpu[-1] - cpu[0]) / (cases[-1] - cases[0])
    shown = np.geomspace(cases[0], cases[-1], 200)
    fixed = cpu[0] - slope * cases[0]
    label = f"{fixed:.1f} s + {1e3 * slope:.2f} ms a case"
    left.loglog(shown, fixed + slope * shown, "--", color="0.6", label=label)
    left.loglog(cases, cpu, "o", color="#0072B2", label="measured")
    style.decimal_ticks(left.yaxis)
    left.set(xlabel="cases", ylabel="CPU time of all processes [s]")
    right.semilogx(cases, together, "o-", color="#0072B2", label="all processes")
    right.semilogx(cases, largest, "x", color="#D55E00", markersize=9, label="largest process")
    right.set(xlabel="cases", ylabel="peak memory [MB]", ylim=(0.0, 1.3 * together.max()))
    for axes in (left, right):
        axes.legend(frameon=False)
    PICTURE.parent.mkdir(exist_ok=True)
    figure.savefig(PICTURE, dpi=150)


def paper(folder):
    """The paper's sweep with waveforms, event-driven, from a cold process to the closed file."""
    config = ROOT / "configs" / "paper.toml"
    walls = []
    for turn in range(3):
        out = folder / f"paper-{turn}.nc"
        walls.append(run(config, out, "--n-jobs", "2", "--solver", "event-driven").wall)
    best = min(walls)
    verdict = "met" if best <= PAPER_GOAL else f"missed by a factor of {best / PAPER_GOAL:.1f}"
    listed = ", ".join(f"{wall:.1f}" for wall in walls)
    say(
        f"paper.toml, {PAPER_CASES} cases, waveforms, two jobs: {listed} s; goal {PAPER_GOAL:.0f} s {verdict}"
    )


def timed_radau(folder, frequencies, amplitudes, n_jobs):
    """Wall time of a Radau sweep, the sum of its cases' own, and their number."""
    config = written(
        folder / "radau.toml",
        0.3 + 2.7 * middles(frequencies),
        0.02 * 100.0 ** middles(amplitudes),
        'method = "radau"',
    )
    out = folder / f"radau-{frequencies}-{amplitudes}-{n_jobs}.nc"
    wall = run(config, out, "--n-jobs", str(n_jobs)).wall
    with xr.open_dataset(out) as found:
        solving = float(found["wall_time"].sum())
    return wall, solving, len(LAWS) * frequencies * amplitudes


def overhead(folder):
    """What a Radau sweep costs beyond solving, and two jobs against one."""
    few_wall, few_solving, few = timed_radau(folder, 2, 3, 2)
    wall, solving, cases = timed_radau(folder, 7, 5, 2)
    single_wall, single_solving, _ = timed_radau(folder, 7, 5, 1)
    beyond, few_beyond = wall - solving / 2, few_wall - few_solving / 2
    say(f"Radau, {cases} cases, two jobs: wall {wall:.1f} s, solving 2 x {solving / 2:.1f} s")
    say(f"Radau, {cases} cases, one job: wall {single_wall:.1f} s, solving {single_solving:.1f} s")
    each = max(beyond - few_beyond, 0.0) / (cases - few)
    fixed = few_beyond - few * each
    total = fixed + PAPER_CASES * each
    share = total / (PAPER_CASES * solving / cases / 2)
    say(f"beyond solving: {fixed:.1f} s a sweep and {1e3 * each:.1f} ms a case;")
    say(
        f"  extrapolated from {few} and {cases} to {PAPER_CASES} such cases: {share:.1%} of solving, goal 5 %"
    )
    alone = single_wall - single_solving
    whole = PAPER_CASES / cases
    gain = (alone + whole * single_solving) / (total + whole * solving / 2)
    say(f"two jobs against one: {single_wall / wall:.2f} x, {gain:.2f} x extrapolated; goal 1.8 x")


def warm(folder):
    """Fill numba's cache for both solvers."""
    for number, solver in enumerate((EVENT_DRIVEN, 'method = "radau"')):
        config = written(folder / "warm.toml", [1.0, 2.0], [0.2, 1.0], solver)
        run(config, folder / f"warm-{number}.nc", "--n-jobs", "2")


PARTS = {"paper": paper, "cases": scaling, "radau": overhead}


def earlier():
    """Lines of each part in the report."""
    text = REPORT.read_text() if REPORT.exists() else ""
    found = re.split(r"^== (\w+)\n", text, flags=re.MULTILINE)[1:]
    return dict(zip(found[::2], found[1::2], strict=True))


def main(arguments):
    if arguments == ["picture"]:
        draw(earlier()["cases"])
        return
    wanted = [name for name in arguments if name in PARTS] or list(PARTS)
    most = [float(number) for number in arguments if number not in PARTS]
    folder, lines = Path(tempfile.mkdtemp()), earlier()
    try:
        warm(folder)
        for name in wanted:
            said.clear()
            PARTS[name](folder, *(most if name == "cases" else ()))
            lines[name] = "\n".join(said) + "\n"
            REPORT.write_text("".join(f"== {part}\n{lines[part]}" for part in PARTS if part in lines))
    finally:
        shutil.rmtree(folder)


if __name__ == "__main__":
    main(sys.argv[1:])
