"""A sweep: config -> cases -> joblib -> dataset, with every finished case safe on disk at once."""

import json
import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import cached_property
from pathlib import Path

import joblib
import numpy as np
import xarray as xr

from wedgesweep import contact, damper, dataset, journal, provenance
from wedgesweep.cases import compile_once, describe, solve_cases
from wedgesweep.config import Case, Config
from wedgesweep.errors import MismatchError, SweepError
from wedgesweep.fingerprint import differences, fingerprint
from wedgesweep.journal import Journal
from wedgesweep.simulate import Settings

# Called with the records of cases as they finish and the number of all cases of the sweep.
Progress = Callable[[np.ndarray, int], None]


# Cases of the event-driven solver that go to a worker, and into the journal, together.
CHUNK = 200


class CaseFailedError(SweepError):
    """A case failed in a sweep that is to stop at the first failure."""


@dataclass(frozen=True)
class Sweep:
    """All cases of a config and where their dataset goes."""

    config: Config
    out: Path

    @cached_property
    def parameters(self) -> np.ndarray:
        """Parameter records of all cases, shape (n,)."""
        return np.concatenate([self.config.record(case) for case in self.config.case_list()])

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
        return dataset.record_dtype(self.sizes)

    @property
    def journal_path(self) -> Path:
        return self.out.with_name(self.out.name + ".partial")

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
        command: str = "",
    ) -> xr.Dataset:
        """Run what is not finished yet and write the dataset.

        ``progress`` is called in this process, first with the records that earlier runs finished.
        Raises CaseFailedError at the first failed case if ``fail_fast``; what is finished stays in
        the journal.
        """
        started = datetime.now(UTC)
        finished = []
        with Journal(self.journal_path, self.dtype, self.journal_header) as kept:
            for records in self._all_records(kept, n_jobs, case_timeout):
                progress(records, len(self.parameters))
                finished.append(records)
                if fail_fast:
                    self._require_ok(records)
            result = self.assembled(np.concatenate(finished), started, command)
            dataset.write(result, self.out)
            self.journal_path.unlink()
        return result

    def run_here(self, case_timeout: float | None = None, command: str = "") -> xr.Dataset:
        """Run all cases in this process, one after the other; nothing is stored."""
        started = datetime.now(UTC)
        indices = np.arange(len(self.parameters))
        return self.assembled(self.solve(indices, case_timeout), started, command)

    def solve(self, indices: np.ndarray, case_timeout: float | None = None) -> np.ndarray:
        """Records of the cases of these indices, solved in this process."""
        limit = self._limit(case_timeout)
        return solve_cases(self.parameters[indices], indices, self.settings, limit, self.dtype)

    def _all_records(self, kept: Journal, n_jobs: int, case_timeout: float | None) -> Iterator[np.ndarray]:
        # A time limit depends on the machine and its load: those cases are tried again.
        whole = kept.records[kept.records["status"] != dataset.STATUSES.index("time_limit")]
        todo = np.setdiff1d(np.arange(len(self.parameters)), whole["index"])
        if todo.size:
            compile_once(self.settings.method)
        yield whole
        for records in self._solve_parallel(todo, n_jobs, self._limit(case_timeout)):
            kept.append(records)
            yield records

    def _solve_parallel(self, indices: np.ndarray, n_jobs: int, case_timeout: float) -> Iterator[np.ndarray]:
        if not indices.size:
            return
        pool = joblib.Parallel(n_jobs=n_jobs, return_as="generator_unordered")
        with _interrupts_ignored():
            results = pool(
                joblib.delayed(solve_cases)(
                    self.parameters[[index]],
                    np.array([index]),
                    self.settings,
                    case_timeout,
                    self.dtype,
                )
                for index in indices
            )
        yield from results

    def _limit(self, case_timeout: float | None) -> float:
        return self.settings.case_timeout if case_timeout is None else case_timeout

    def _require_ok(self, records: np.ndarray) -> None:
        failed = records[records["status"] != 0]
        if failed.size:
            case = self.config.case_list()[failed[0]["index"]]
            message = f"{describe(*case)}: {failed[0]['message'].decode()}"
            raise CaseFailedError(message)

    def assembled(self, records: np.ndarray, started: datetime, command: str) -> xr.Dataset:
        """Dataset of all cases from their records."""
        shape, coords = self.config.case_coordinates()
        return dataset.assemble(
            records,
            dataset.coordinates(coords, self.sizes),
            shape,
            {**self._physics(), **provenance.attributes(self.config, started, command)},
        )

    def _physics(self) -> dict[str, float]:
        """Numbers of the suspension that figures refer to (SI)."""
        p = self.parameters[0]
        coulomb = self.config.record(Case("coulomb", 1.0, 1e-3))[0]
        return {
            "omega_n": self.config.sweep.omega_n,
            "rest_position": float(p["rest"]),
            "frictionless_resonance": damper.resonance(p),
            "breakaway_acceleration": contact.breakaway_acceleration(coulomb),
        }


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
