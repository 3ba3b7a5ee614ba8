"""Kill commands at random moments, 200 times, and check what is left.

After each kill no process of the command is left, the same command ends with the bits of an undisturbed run,
and its directory holds the same files. Prints a table and the first faults; exit code 1 if there is any.
"""

import argparse
import os
import signal
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from random import Random

from torture import kills
from torture.kills import OUT, Scenario
from torture.specimens import MEASURED, MODEL, csv_files

SWEEP = """\
title = "to be killed"
[sweep]
friction_law = ["coulomb", "exponential"]
beta = { start = 0.3, stop = 2.5, num = 4 }
amplitude_mm = [0.02, 0.2, 0.6, 1.2]
[solver]
settle_periods = 3
kept_periods = 2
samples_per_period = 32
"""
# Cases that take a while with the fast solver, and a dataset that takes a while to write.
LONG = SWEEP.replace("settle_periods = 3", "settle_periods = 2000")
LARGE = SWEEP.replace("num = 4", "num = 400").replace("samples_per_period = 32", "samples_per_period = 256")
RUN = ("run", "c.toml", "-o", OUT)


def scenarios() -> list[Scenario]:
    def sweep(name: str, text: str, moments: tuple[str, ...], *options: str) -> Scenario:
        return Scenario(name, (*RUN, *options), moments, kills.same_dataset, {"c.toml": text})

    fast, anywhere = ("--solver", "event-driven"), ("time", "journal", "journal")
    return [
        sweep("event-driven", LONG, anywhere, *fast, "--n-jobs", "2"),
        sweep("radau", SWEEP, anywhere, "--n-jobs", "2"),
        sweep("radau worker", SWEEP, ("worker",), "--n-jobs", "2"),
        sweep("writing", LARGE, ("writing",), *fast, "--n-jobs", "2"),
        sweep("dask", LONG, anywhere, *fast, "--n-jobs", "2", "--backend", "dask"),
        sweep("dask worker", LONG, ("worker",), *fast, "--n-jobs", "2", "--backend", "dask"),
        diagnosis(),
    ]


def diagnosis() -> Scenario:
    from torture.mutations import toml

    tests = [{"file": name, "frequency_hz": 20.0, "amplitude_mm": 0.3} for name in ("one.csv", "two.csv")]
    measured = {"measurement": {**MEASURED["measurement"], "test": tests}}
    files = {"measured.toml": toml(measured), "model.toml": toml(MODEL), **csv_files()}
    command = ("diagnose", "measured.toml", "-o", "found", "--effects", "viscous_damping", "--n-jobs", "1")
    return Scenario("diagnose", command, ("time", "writing", "writing"), kills.same_diagnosis, files, "found")


def main() -> int:
    options = _options()
    chosen = [each for each in scenarios() if options.only in (None, each.name)]
    counts: Counter = Counter()
    faults: list[str] = []
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        for number, scenario, moment, ended, found in campaign(chosen, options):
            counts[scenario, ended] += 1
            counts[scenario, "faults"] += bool(found)
            line = f"kill {number}: {scenario}, {moment}, {ended}: {'; '.join(found) or 'all held'}"
            faults += [line] if found else []
            print(line, file=sys.stderr, flush=True)
    except KeyboardInterrupt:
        print("stopped early", file=sys.stderr)
    return report(options, [each.name for each in chosen], counts, faults)


def campaign(
    chosen: list[Scenario], options: argparse.Namespace
) -> Iterator[tuple[int, str, str, str, list[str]]]:
    """Number, scenario, moment and signal of each kill, and what did not hold."""
    with tempfile.TemporaryDirectory(prefix="kills-") as made:
        base, expected = Path(made), {}
        for number in range(options.kills):
            scenario, draw = chosen[number % len(chosen)], Random(f"{options.seed}/{number}")
            if scenario.name not in expected:
                expected[scenario.name] = kills.reference(scenario, base / "expected" / scenario.name)
            found = kills.kill(scenario, expected[scenario.name], base / "run", draw)
            yield number, scenario.name, *found


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", metavar="SCENARIO")
    return parser.parse_args()


def report(options: argparse.Namespace, names: list[str], counts: Counter, faults: list[str]) -> int:
    """Print the table and the faults; return the exit code."""
    columns = [*(each.name for each in kills.SIGNALS), "too late", "faults"]
    done = sum(count for (_, column), count in counts.items() if column != "faults")
    print(f"{done} kills, seed {options.seed}, {os.cpu_count()} processors\n")
    print(" ".join([f"{'scenario':<14}", *(f"{each:>9}" for each in columns)]))
    for name in [*names, "all"]:
        row = [sum(counts[each, column] for each in names if name in (each, "all")) for column in columns]
        print(" ".join([f"{name:<14}", *(f"{each:>9}" for each in row)]))
    print(f"\n{len(faults)} faults", *faults[:5], sep="\n")
    return int(bool(faults))


if __name__ == "__main__":
    sys.exit(main())
