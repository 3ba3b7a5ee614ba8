"""A sweep: config -> cases -> joblib -> dataset, with every finished case safe on disk at once."""

import json
import signal
import threading
import warnings
from collections.abc import Callable, Generator, Iterator
from contextlib import ExitStack, closing, contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import cached_property, partial
from math import nan
from pathlib import Path

import joblib
import numpy as np
import xarray as xr

from wedgesweep.config import Case, Config
from wedgesweep.errors import MismatchError, SweepError
from wedgesweep.outcome import Outcome
from wedgesweep.simulate import Settings
from wedgesweep.sweep import dataset, journal, provenance
from wedgesweep.sweep.backend import Backend, local
from wedgesweep.sweep.cases import Chunk, compile_once, describe, solve_cases, solve_chunk
from wedgesweep.sweep.fingerprint import differences, fingerprint
from wedgesweep.sweep.journal import Journal
from wedgesweep.systems.suspension.equilibrium import breakaway_acceleration, resonance
from wedgesweep.systems.suspension.parameters import has_own_mechanics

# Called with the records of cases as they finish and the number of all cases of the sweep.
Progress = Callable[[np.ndarray, int], None]


# Cases of the event-driven solver that go to a worker, and into the journal, together; fewer in a
# small sweep, which is cut into so many chunks.
CHUNK, CHUNKS = 200, 64


class CaseFailedError(SweepError):
    """A case failed in a sweep that is to stop at the first failure."""


@dataclass(frozen=True)
class Sweep:
    """All cases of a config, where their dataset goes, and the ``command`` that its history names."""

    config: Config
    out: Path
    command: str = ""

    @cached_property
    def parameters(self) -> np.ndarray:
        """Parameter records of all cases, shape (n,)."""
        return self.config.records()

    @property
    def settings(self) -> Settings:
        return self.config.solver

    @property
    def sizes(self) -> dict[str, int]:
        """Sizes of the dataset's dimensions within a case."""
        samples = self.settings.samples_per_period
        return {
            "phase": self.settings.kept_periods * samples if self.settings.keep_waveforms else 0,
            "samples_per_period": samples,
            "harmonic": dataset.HARMONICS,
            "part": 2,
        }

    @property
    def dtype(self) -> np.dtype:
        return dataset.record_dtype(self.sizes, self.settings.continuation)

    @property
    def together(self) -> np.ndarray:
        """Indices of the cases that depend on each other, a row each, shape (n, m).

        In a continuation these are lines, all frequencies of a law and an amplitude; else single cases.
        """
        indices = np.arange(len(self.parameters)).reshape(self.config.case_coordinates()[0])
        if self.settings.continuation:
            return indices.swapaxes(1, 2).reshape(-1, indices.shape[1])
        return indices.reshape(-1, 1)

    @property
    def journal_path(self) -> Path:
        return self.out.with_name(self.out.name + ".partial")

    @property
    def extended(self) -> bool:
        """Whether its effects need the extended mechanics."""
        return bool(has_own_mechanics(self.parameters).any())

    @property
    def fingerprint(self) -> dict[str, str]:
        """What the numbers depend on: runs that differ in it are not mixed."""
        return fingerprint(self.config)

    @property
    def journal_header(self) -> dict[str, str]:
        return {**self.fingerprint, "config": self.config.to_toml()}

    def stored(self) -> xr.Dataset | None:
        """Dataset of an earlier run, if it is complete.

        Raises MismatchError if ``out`` holds another sweep, SweepError if it is no sweep's dataset.
        """
        if self.journal_path.exists() or not self.out.exists():
            return None
        found = _read_sweep(self.out)
        there = {**json.loads(found.attrs["fingerprint"]), "config": found.attrs["config"]}
        differing = differences(there, self.journal_header)
        if differing:
            message = f"{self.out}: holds another sweep ({'; '.join(differing)})"
            raise MismatchError(message)
        return found

    def discard(self) -> None:
        """Delete what earlier runs finished; raises SweepError if ``out`` is no sweep's dataset."""
        if self.out.exists():
            _read_sweep(self.out)
        journal.discard(self.journal_path)
        self.out.unlink(missing_ok=True)

    def run(
        self,
        n_jobs: int = 2,
        case_timeout: float | None = None,
        fail_fast: bool = False,
        progress: Progress = lambda records, total: None,
        backend: Backend | None = None,
        fresh: bool = False,
    ) -> xr.Dataset:
        """Run what is not finished yet, or all if ``fresh``, and write the dataset.

        ``progress`` is called in this process, first with the records that earlier runs finished.
        Raises CaseFailedError at the first failed case if ``fail_fast``; what is finished stays in
        the journal.
        """
        started = datetime.now(UTC)
        with ExitStack() as opened:
            pool = self._open(opened, backend or local(self.settings.method), n_jobs)
            if fresh:
                self.discard()
            kept = opened.enter_context(Journal(self.journal_path, self.dtype, self.journal_header))
            parts = opened.enter_context(closing(self._all_records(kept, pool, case_timeout)))
            records = np.empty(len(self.parameters), self.dtype)
            for part in parts:
                records[part["index"]] = part
                progress(part, len(records))
                if fail_fast:
                    self._require_ok(part)
            result = self.assembled(records, started)
            dataset.write(result, self.out)
            self.journal_path.unlink()
        return result

    def run_here(self, case_timeout: float | None = None) -> xr.Dataset:
        """Run all cases in this process, one after the other; nothing is stored."""
        started = datetime.now(UTC)
        indices = np.arange(len(self.parameters))
        return self.assembled(self.solve(indices, case_timeout), started)

    def solve(self, indices: np.ndarray, case_timeout: float | None = None) -> np.ndarray:
        """Records of the cases of these indices (in a continuation: whole lines), solved in this process."""
        limit = self._limit(case_timeout)
        return solve_cases(self.parameters[indices], indices, self.settings, limit, self.dtype)

    def _open(self, opened: ExitStack, backend: Backend, n_jobs: int) -> joblib.Parallel:
        with _interrupts_ignored():
            return opened.enter_context(backend(n_jobs, partial(fingerprint, self.config)))

    def _all_records(
        self, kept: Journal, pool: joblib.Parallel, case_timeout: float | None
    ) -> Generator[np.ndarray, None, None]:
        # A time limit depends on the machine and its load: those cases are tried again.
        whole = kept.records[kept.records["status"] != Outcome.TIME_LIMIT]
        rows = self.together
        todo = rows[~np.isin(rows, whole["index"]).all(axis=1)]
        if todo.size:
            compile_once(self.settings.method, self.extended)
        yield whole[~np.isin(whole["index"], todo)]
        with closing(self._solve_parallel(todo, pool, self._limit(case_timeout))) as parts:
            for records in parts:
                kept.append(records)
                yield records

    def _solve_parallel(
        self, rows: np.ndarray, pool: joblib.Parallel, case_timeout: float
    ) -> Generator[np.ndarray, None, None]:
        if not rows.size:
            return
        with _interrupts_ignored():
            results = pool(
                joblib.delayed(solve_chunk)(
                    Chunk(self.parameters[chunk], chunk, self.settings, case_timeout, self.dtype)
                )
                for chunk in _chunks(rows, self.settings.method)
            )
        try:
            # "yield from" would close it outside of the filter below.
            for records in results:  # noqa: UP028
                yield records
        finally:
            with warnings.catch_warnings():
                # joblib finds it worth a warning that a run is stopped half-way.
                warnings.simplefilter("ignore", UserWarning)
                results.close()

    def _limit(self, case_timeout: float | None) -> float:
        return self.settings.case_timeout if case_timeout is None else case_timeout

    def _require_ok(self, records: np.ndarray) -> None:
        failed = records[records["status"] != Outcome.OK]
        if failed.size:
            case = self.config.case_list()[failed[0]["index"]]
            message = f"{describe(*case)}: {failed[0]['message'].decode()}"
            raise CaseFailedError(message)

    def assembled(self, records: np.ndarray, started: datetime) -> xr.Dataset:
        """Dataset of all cases from their records."""
        shape, coords = self.config.case_coordinates()
        return dataset.assemble(
            records,
            dataset.coordinates(coords, self.sizes),
            shape,
            {**self._physics(), **provenance.attributes(self.config, started, self.command)},
        )

    def _physics(self) -> dict[str, float]:
        """Numbers of the suspension that figures refer to (SI)."""
        p = self.parameters[0]
        numbers = {"omega_n": self.config.sweep.omega_n, "rest_position": float(p["geometry"]["rest"])}
        if self.extended:  # effects with mechanics of their own have neither
            return numbers | {"frictionless_resonance": nan, "breakaway_acceleration": nan}
        coulomb = self.config.record(Case("coulomb", 1.0, 1e-3))[0]
        return numbers | {
            "frictionless_resonance": resonance(p),
            "breakaway_acceleration": breakaway_acceleration(coulomb),
        }


def _chunks(rows: np.ndarray, method: str) -> Iterator[np.ndarray]:
    """Cases that a job solves at a time: one slow one, or whole rows of fast ones from all over the sweep.

    Cost changes along the grid, so that chunks of neighbours would leave some jobs idle at the end.
    """
    size = min(CHUNK, -(-rows.size // CHUNKS)) if method == "event-driven" else 1
    count = -(-len(rows) // max(size // rows.shape[1], 1))
    return (rows[first::count].ravel() for first in range(count))


def _read_sweep(path: Path) -> xr.Dataset:
    found = dataset.read(path)
    if "fingerprint" not in found.attrs:
        message = f"{path}: not the dataset of a sweep, and will not be overwritten"
        raise SweepError(message)
    return found


@contextmanager
def _interrupts_ignored() -> Iterator[None]:
    """Jobs that start meanwhile ignore ctrl-C for good: this process ends them, quietly."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
