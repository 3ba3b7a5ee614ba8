"""Kills of running commands at random moments, and what must hold after each."""

import os
import shutil
import signal
import subprocess
import sys
import time
import uuid
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from random import Random

import numpy as np
import xarray as xr

ROOT = Path(__file__).parents[2]
MARK = "WEDGESWEEP_TORTURE"
SIGNALS = (signal.SIGKILL, signal.SIGTERM, signal.SIGINT, signal.SIGHUP)
# Times (s) for a command to end after a signal, for its workers after that, and for any command in all.
TO_END, FOR_WORKERS, IN_ALL = 120.0, 60.0, 600.0
ADVICE = "rerun the same command to resume"
OUT = "out.nc"


@dataclass(frozen=True)
class Scenario:
    """A command, the files that it reads, and the moments at which it is killed.

    ``same(made, expected)`` tells whether two directories hold the same result. ``moments`` are names of
    ``MOMENTS``.
    """

    name: str
    command: tuple[str, ...]
    moments: tuple[str, ...]
    same: Callable[[Path, Path], bool]
    files: dict[str, str] = field(default_factory=dict)
    result: str = OUT


@dataclass(frozen=True)
class Reference:
    """An undisturbed run: its directory, its wall time (s) and the size of its journal at the end."""

    place: Path
    seconds: float
    journal: int


@dataclass
class Running:
    """A command that runs in its own process group; all its processes carry a mark."""

    place: Path
    command: tuple[str, ...]
    mark: str = field(default_factory=lambda: uuid.uuid4().hex)

    def __post_init__(self) -> None:
        self.began = time.monotonic()
        self.log = (self.place.parent / f"{self.mark}.log").open("w+")
        self.process = subprocess.Popen(
            [sys.executable, "-m", "wedgesweep", *self.command],
            cwd=self.place,
            env={**os.environ, "PYTHONPATH": str(ROOT), MARK: self.mark},
            stdout=self.log,
            stderr=subprocess.STDOUT,
            start_new_session=True,
            preexec_fn=_default_signals,
        )

    def processes(self) -> set[int]:
        """Processes that carry the mark, this one aside."""
        wanted = f"{MARK}={self.mark}".encode()
        return {process for process in _all_processes() if wanted in _environment(process)} - {
            self.process.pid
        }

    def finish(self, limit: float) -> bool:
        """Wait for the end; False if it did not come."""
        try:
            self.process.wait(limit)
        except subprocess.TimeoutExpired:
            return False
        return True

    def end(self) -> str:
        """End what still runs; return what was printed."""
        for process in (self.process.pid, *self.processes()):
            try:
                os.kill(process, signal.SIGKILL)
            except ProcessLookupError:
                continue
        self.process.wait()
        self.log.seek(0)
        output = self.log.read()
        self.log.close()
        Path(self.log.name).unlink()
        return output


def _default_signals() -> None:
    for number in SIGNALS[1:]:
        signal.signal(number, signal.SIG_DFL)


def _all_processes() -> Iterator[int]:
    return (int(each.name) for each in Path("/proc").iterdir() if each.name.isdigit())


def _environment(process: int) -> bytes:
    """Variables of a process; empty where it has ended."""
    try:
        return Path(f"/proc/{process}/environ").read_bytes()
    except OSError:
        return b""


# A moment: whether it has come. Each is drawn before the run starts.
Moment = Callable[[Running, Reference, float], bool]


def _by_time(running: Running, reference: Reference, share: float) -> bool:
    return time.monotonic() - running.began > 1.1 * share * reference.seconds


def _by_journal(running: Running, reference: Reference, share: float) -> bool:
    journal = running.place / f"{OUT}.partial"
    return journal.exists() and journal.stat().st_size > share * reference.journal


def _while_writing(running: Running, reference: Reference, share: float) -> bool:
    if any(running.place.glob(f".*.{running.process.pid}")):
        time.sleep(0.1 * share)
        return True
    return False


MOMENTS: dict[str, Moment] = {
    "time": _by_time,
    "journal": _by_journal,
    "writing": _while_writing,
    "worker": _by_journal,
}


def reference(scenario: Scenario, place: Path) -> Reference:
    """Run a scenario undisturbed; raises RuntimeError if it fails."""
    _prepare(scenario, place)
    running, journal = Running(place, scenario.command), 0
    while running.process.poll() is None:
        journal = max(journal, *(path.stat().st_size for path in _existing(place / f"{OUT}.partial")), 0)
        time.sleep(0.005)
    seconds, output = time.monotonic() - running.began, running.end()
    if running.process.returncode:
        raise RuntimeError(output)
    return Reference(place, seconds, journal)


def _existing(path: Path) -> list[Path]:
    return [path] if path.exists() else []


def _prepare(scenario: Scenario, place: Path) -> None:
    shutil.rmtree(place, ignore_errors=True)
    place.mkdir(parents=True)
    for name, content in scenario.files.items():
        (place / name).write_text(content)


def kill(scenario: Scenario, expected: Reference, place: Path, draw: Random) -> tuple[str, str, list[str]]:
    """Kill a command and run it again; return the moment, the signal, and what did not hold."""
    _prepare(scenario, place)
    moment, share = draw.choice(scenario.moments), draw.random()
    number = signal.SIGKILL if moment == "worker" else draw.choice(SIGNALS)
    running = Running(place, scenario.command)
    while running.process.poll() is None and not MOMENTS[moment](running, expected, share):
        time.sleep(0.002)
    reached = running.process.poll() is None
    if moment == "worker":
        faults = _kill_worker(running, draw) if reached else []
    else:
        faults = _kill_parent(running, number) if reached else []
    faults += _orphans(running)
    output = running.end()
    faults += _faults_of_the_end(running, moment, number, reached, output)
    faults += _faults_of_another_run(scenario, expected, place)
    return moment, number.name if reached else "too late", [f"{each}\n{output[-600:]}" for each in faults]


def _kill_parent(running: Running, number: int) -> list[str]:
    try:
        # A terminal tells all processes of the group, kill just one.
        (os.killpg if number in (signal.SIGINT, signal.SIGHUP) else os.kill)(running.process.pid, number)
    except ProcessLookupError:
        return []
    return [] if running.finish(TO_END) else [f"still runs {TO_END:g} s after the signal"]


def _kill_worker(running: Running, draw: Random) -> list[str]:
    workers = sorted(each for each in running.processes() if _is_worker(each))
    if workers:
        with suppress(ProcessLookupError):
            os.kill(draw.choice(workers), signal.SIGKILL)
    return [] if running.finish(IN_ALL) else ["does not end after the death of a worker"]


def _is_worker(process: int) -> bool:
    try:
        words = Path(f"/proc/{process}/cmdline").read_bytes()
    except OSError:
        return False
    return b"LokyProcess" in words or b"spawn_main" in words


def _orphans(running: Running) -> list[str]:
    """Processes that outlive the command."""
    until = time.monotonic() + FOR_WORKERS
    while (left := running.processes()) and time.monotonic() < until:
        time.sleep(0.1)
    return [f"{len(left)} processes are left"] if left else []


def _faults_of_the_end(running: Running, moment: str, number: int, reached: bool, output: str) -> list[str]:
    code = running.process.returncode
    faults = ["a traceback"] if "Traceback" in output else []
    if not reached or moment == "worker":
        return faults + ([f"exit code {code}"] if code else [])
    # 0: it had just finished; -number: before Python could handle signals, or SIGKILL.
    if code not in (0, -number, 128 + number):
        faults.append(f"exit code {code}")
    if code == 128 + number and "cases" in output and ADVICE not in output:
        faults.append("no advice")
    return faults


def _faults_of_another_run(scenario: Scenario, expected: Reference, place: Path) -> list[str]:
    """Whether the same command ends with the same result and leaves nothing else."""
    again = Running(place, scenario.command)
    ended = again.finish(IN_ALL)
    output = again.end()
    if not ended or again.process.returncode:
        ending = f"exit code {again.process.returncode}" if ended else "no end"
        return [f"run again: {ending}\n{output[-600:]}"]
    faults = (
        [] if scenario.same(place / scenario.result, expected.place / scenario.result) else ["another result"]
    )
    there, wanted = _names(place), _names(expected.place)
    return faults + ([f"files: {sorted(there ^ wanted)}"] if there != wanted else [])


def _names(place: Path) -> set[str]:
    return {str(path.relative_to(place)) for path in place.rglob("*")}


def same_dataset(made: Path, expected: Path) -> bool:
    """Whether two datasets hold the same bits, wall times aside."""
    one, other = xr.load_dataset(made), xr.load_dataset(expected)
    if set(one.variables) != set(other.variables):
        return False
    return all(
        one[name].values.tobytes() == other[name].values.tobytes()
        if one[name].dtype.kind in "fiu"
        else np.array_equal(one[name].values, other[name].values)
        for name in set(one.variables) - {"wall_time"}
    )


def same_diagnosis(made: Path, expected: Path) -> bool:
    """Whether two diagnoses say the same, times aside."""
    import json

    def content(place: Path) -> dict:
        found = json.loads((place / "diagnosis.json").read_text())
        return {key: each for key, each in found.items() if key not in ("created", "method", "work")}

    return content(made) == content(expected)
