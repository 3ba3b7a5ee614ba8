"""Try hostile inputs of every kind on the command line, and print what becomes of them.

An input is drawn from the seed and its number alone: ``--only NUMBER --keep DIR`` writes it to DIR and runs
it again. ``--formats --inputs 160000`` tries 10,000 files of each of the 16 formats of measured data.

The exit code is 1 if an input gives a traceback, takes more than 20 s of processor time, kills the process,
makes a library warn, prints a number that is not finite, or is refused without naming anything.
"""

import argparse
import contextlib
import os
import pickle
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import traceback
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from random import Random

from torture import formats, specimens
from torture.inputs import FORMATS, KINDS, SHARES
from torture.verdicts import (
    ACCEPTED,
    FAILED,
    FAULTS,
    HANG,
    LIMIT,
    REFUSED,
    TRACEBACK,
    WARNING,
    Verdict,
    judge,
)

OUTCOMES = (ACCEPTED, REFUSED, FAILED, *FAULTS)
# A process that says nothing for so long (s of wall time) hangs in a library.
SILENT = 300.0


def main() -> int:
    chosen = options()
    with tempfile.TemporaryDirectory(prefix="fuzz-") as made:
        base = Path(made)
        if chosen.specimens:
            given = pickle.loads(Path(chosen.specimens).read_bytes())
            work(given, chosen, base)
            return 0
        given = _specimens(base)
        if chosen.only is not None:
            place = Path(chosen.keep or base / "one")
            kind, command, verdict = one(given, chosen, chosen.only, place)
            print(f"{kind}: {' '.join(command)}\n{verdict.outcome}\n{verdict.output}")
            return int(verdict.fault)
        (base / "specimens").write_bytes(pickle.dumps(given))
        return campaign(chosen, base)


def options(words: list[str] | None = None) -> argparse.Namespace:
    """Options of the command line, or of the given words."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--inputs", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    kinds = parser.add_mutually_exclusive_group()
    kinds.add_argument("--kind", choices=KINDS, help="inputs of this kind only")
    kinds.add_argument("--formats", action="store_true", help="files of each format in turn")
    parser.add_argument("--only", type=int, metavar="NUMBER", help="one input")
    parser.add_argument("--keep", metavar="DIR", help="where --only writes the input")
    parser.add_argument("--specimens", help=argparse.SUPPRESS)
    parser.add_argument("--first", type=int, default=0, help="number of the first input (default: 0)")
    parser.add_argument("--step", type=int, default=1, help=argparse.SUPPRESS)
    return parser.parse_args(words)


def _specimens(base: Path) -> specimens.Specimens:
    from tests import fixture_diagnosis

    (base / "made").mkdir()
    fixture_diagnosis.write(base / "found")
    found = {path.name: path.read_bytes() for path in (base / "found").iterdir()}
    return specimens.make(base / "made", found)


def one(
    given: specimens.Specimens, options: argparse.Namespace, number: int, place: Path
) -> tuple[str, list[str], Verdict]:
    """Write an input to an empty directory and try it there."""
    draw = Random(f"{options.seed}/{number}")
    here = [kind for kind in KINDS if kind in given.stored or kind not in formats.WRITERS]
    kind = options.kind or draw.choices(here, [SHARES.get(each, 1.0) for each in here])[0]
    if options.formats:
        here = [kind for kind in here if kind in FORMATS]
        kind = here[number % len(here)]
    shutil.rmtree(place, ignore_errors=True)
    place.mkdir(parents=True)
    command = KINDS[kind](given, place, draw)
    with contextlib.chdir(place):
        return kind, command, judge(command)


def work(given: specimens.Specimens, options: argparse.Namespace, base: Path) -> None:
    """Try every so many inputs, and write a line of Python on each to the standard output."""
    answers = os.fdopen(os.dup(1), "w", buffering=1)
    leaked = (base / "stderr").open("a")  # so that what follows a truncation begins the file
    os.dup2(leaked.fileno(), 1)
    os.dup2(leaked.fileno(), 2)
    for number in range(options.first, options.inputs, options.step):
        print(repr(number), file=answers)
        try:
            kind, command, verdict = one(given, options, number, base / "input")
        except Exception:
            kind, command, verdict = "fuzz.py", [], Verdict(TRACEBACK, traceback.format_exc())
        written = (base / "stderr").read_text(errors="replace")
        if written and not verdict.fault:
            verdict = Verdict(WARNING, f"on the standard error of the process: {written[:2000]}")
        leaked.truncate(0)
        print(
            repr((number, kind, command, verdict.outcome, verdict.output[-4000:] if verdict.fault else "")),
            file=answers,
        )


def campaign(options: argparse.Namespace, base: Path) -> int:
    """Try all inputs in worker processes; return the exit code."""
    found: list[tuple] = []

    def collect(job: int) -> None:
        for each in _shard(options, base, job):
            found.append(each)

    threads = [threading.Thread(target=collect, args=(job,), daemon=True) for job in range(options.jobs)]
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    except KeyboardInterrupt:
        print("stopped early", file=sys.stderr)
    return report(list(found), options)


def _shard(options: argparse.Namespace, base: Path, job: int) -> Iterator[tuple]:
    """Results of a worker, which is started again after an input that ends it."""
    first = options.first + job
    while first < options.inputs:
        process = subprocess.Popen(_command(options, base, first), stdout=subprocess.PIPE, text=True)
        number = None
        for line in _lines(process):
            result = eval(line, {"__builtins__": {}})
            if isinstance(result, int):
                number = result
            else:
                yield result
                number, first = None, result[0] + options.jobs
        code = process.wait()
        if number is None:
            if code:
                raise SystemExit(f"a worker of this script ended with {code}")
            return
        yield number, "unknown", [], HANG if code == -9 else TRACEBACK, f"the process ended with {code}"
        first = number + options.jobs


def _command(options: argparse.Namespace, base: Path, first: int) -> list[str]:
    numbers = {"--inputs": options.inputs, "--seed": options.seed, "--first": first, "--step": options.jobs}
    words = [str(word) for pair in numbers.items() for word in pair]
    return [sys.executable, __file__, "--specimens", str(base / "specimens"), *words, *_kinds(options)]


def _kinds(options: argparse.Namespace) -> list[str]:
    return ["--formats"] if options.formats else ["--kind", options.kind] if options.kind else []


def _lines(process: subprocess.Popen) -> Iterator[str]:
    """Lines of a process, which is killed if it is silent for long."""
    silent = [0.0]

    def watch() -> None:
        while process.poll() is None:
            time.sleep(1.0)  # counted, so that a campaign may be paused
            silent[0] += 1.0
            if silent[0] > SILENT:
                process.kill()

    threading.Thread(target=watch, daemon=True).start()
    assert process.stdout is not None
    for line in process.stdout:
        silent[0] = 0.0
        yield line


def report(found: list[tuple], options: argparse.Namespace) -> int:
    """Print the table and the first faults; return the exit code."""
    counts = Counter((kind, outcome) for _, kind, _, outcome, _ in found)
    names = list(dict.fromkeys(kind for kind, _ in sorted(counts)))
    print(f"{len(found)} inputs, seed {options.seed}; limit {LIMIT:g} s of processor time\n")
    print(" ".join([f"{'kind':<10}", *(f"{outcome:>13}" for outcome in OUTCOMES)]))
    for name in [*names, "all"]:
        row = [sum(counts[kind, outcome] for kind in names if name in (kind, "all")) for outcome in OUTCOMES]
        print(" ".join([f"{name:<10}", *(f"{count:>13}" for count in row)]))
    faults = sorted(each for each in found if each[3] in FAULTS)
    for number, kind, command, outcome, output in _first(faults):
        print(f"\n--- {outcome}: {kind}, input {number}: wedgesweep {' '.join(command)[:200]}")
        again = ["--seed", str(options.seed), *_kinds(options), "--only", str(number), "--keep", "DIR"]
        print(f"python scripts/fuzz.py {' '.join(again)}\n{output}")
    print(f"\n{len(faults)} faults")
    return int(bool(faults))


def _first(faults: list[tuple]) -> Iterator[tuple]:
    """The first faults of each sort: outcome, and the last line of what was said."""
    seen: Counter = Counter()
    for fault in faults:
        sort = fault[3], fault[4].strip().rpartition("\n")[2][:60]
        seen[sort] += 1
        if seen[sort] <= 1:
            yield fault


if __name__ == "__main__":
    sys.exit(main())
