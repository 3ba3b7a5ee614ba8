"""A sweep: solves the cases of a config in parallel, storing each at once, and assembles the dataset."""

import logging
from collections.abc import Callable, Generator
from contextlib import ExitStack, closing
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from wedgesweep import config, rotation
from wedgesweep.config import Config
from wedgesweep.config.physics import breakaway, physics
from wedgesweep.errors import MismatchError, SweepError
from wedgesweep.files import json_object
from wedgesweep.outcome import Outcome
from wedgesweep.processes import interrupts_ignored
from wedgesweep.simulate import Settings
from wedgesweep.sweep import dataset, growth, journal, labels, provenance, transients, variables
from wedgesweep.sweep.backend import Backend, Pool, local
from wedgesweep.sweep.cases import Chunk, compile_once, solve_chunk
from wedgesweep.sweep.chunks import Rows
from wedgesweep.sweep.fingerprint import differences, fingerprint
from wedgesweep.sweep.journal import Journal
from wedgesweep.sweep.workers import Workers
from wedgesweep.systems import kits

# Not needed until there are results; it takes a third of a second to load.
if TYPE_CHECKING:
    import xarray as xr

log = logging.getLogger(__name__)

# Called with the records of cases as they finish, and the number of all cases of the sweep.
Progress = Callable[[np.ndarray, int], None]

# Outcomes that depend on the load or the state of the machine: such a case is run again when a sweep resumes.
RETRIED = (Outcome.TIME_LIMIT, Outcome.WORKER_LOST)


class CaseFailedError(SweepError):
    """A case failed in a sweep that stops at the first failure."""


@dataclass(frozen=True)
class Sweep:
    """All cases of a config, where their dataset goes, and the ``command`` that its history names."""

    config: Config
    out: Path
    command: str = ""

    @property
    def count(self) -> int:
        """Number of cases."""
        return self.config.sweep.count

    @property
    def settings(self) -> Settings:
        return self.config.solver

    @property
    def sizes(self) -> dict[str, int]:
        """Sizes of the dataset's dimensions within a case."""
        samples = self.settings.samples_per_period
        transient = self.settings.transient
        if transient is not None:
            return {"time": transient.samples if self.settings.keep_waveforms else 0}
        return {
            "phase": self.settings.kept_periods * samples if self.settings.keep_waveforms else 0,
            "samples_per_period": samples,
            "harmonic": variables.HARMONICS,
            "part": 2,
        }

    @property
    def dtype(self) -> np.dtype:
        return variables.record_dtype(self.sizes, self.settings.continuation)

    @property
    def rows(self) -> Rows:
        """The cases, those together that depend on each other."""
        cases = self.config.sweep
        along = next((cases.places[name] for name in ("beta", "frequency") if name in cases.places), None)
        return Rows(cases.shape, along if self.settings.continuation else None)

    @property
    def journal_path(self) -> Path:
        return dataset.journal_of(self.out)

    @property
    def kit(self) -> int:
        """The largest kit of parts that the cases need."""
        own = int(kits(self.config.records_of_laws).max(initial=0))
        # A kit of odd number has room for an input that is not a sine.
        return own | 1 if self.config.transient else own

    @property
    def fingerprint(self) -> dict[str, str]:
        """What the results depend on; runs with different fingerprints are never mixed."""
        return fingerprint(self.config)

    @property
    def journal_header(self) -> dict[str, str]:
        return {**self.fingerprint, "config": self.config.to_toml()}

    def stored(self) -> "xr.Dataset | None":
        """Return the dataset of an earlier run if it is complete, else None.

        Raises MismatchError if ``out`` holds another sweep whose cases this one does not have, SweepError if
        it is no sweep's dataset.
        """
        if self.journal_path.exists() or not self.out.exists():
            return None
        found = _read_sweep(self.out)
        if found.attrs["title"] == self.config.title and not differences(_header(found), self.fingerprint):
            return found
        self._carried(found)
        return None

    def _carried(self, found: "xr.Dataset") -> np.ndarray:
        """Records of an earlier dataset, numbered as cases of this sweep; MismatchError if it lacks any."""
        kept = self._grown(_header(found), lambda dtype: growth.records_of(found, dtype))
        if kept is None:
            differing = "; ".join(differences(_header(found), self.journal_header))
            raise MismatchError(f"{self.out}: holds another sweep ({differing})")
        return kept

    def _grown(self, header: dict[str, str], records: Callable[[np.dtype], np.ndarray]) -> np.ndarray | None:
        """Records of an earlier sweep, numbered as cases of this one; None if it lacks any or is another."""
        ours = {**self.fingerprint, "config_sha256": header.get("config_sha256", "")}
        if differences(header, ours):
            return None
        there = Sweep(config.parse(header["config"]), self.out)
        known = records(there.dtype)
        kept = growth.carried(known, (there.config, there.rows), (self.config, self.rows))
        return kept if len(kept) == len(known) else None

    def _journal(self, fresh: bool) -> Journal:
        """The journal, open; unless ``fresh`` cases of an earlier run of a smaller sweep are in it."""
        path = self.journal_path
        if fresh:
            self.discard()
        elif self.out.exists() and not path.exists():
            self._begin_with(self._carried(_read_sweep(self.out)))
        try:
            return Journal(path, self.dtype, self.journal_header)
        except MismatchError:
            kept = self._grown(journal.header(path), lambda dtype: journal.read(path, dtype))
            if kept is None:
                raise
            self._begin_with(kept)
            return Journal(path, self.dtype, self.journal_header)

    def _begin_with(self, kept: np.ndarray) -> None:
        if len(kept):
            log.info("%s: %d of %d cases are there from an earlier run", self.out, len(kept), self.count)
        journal.rewrite(self.journal_path, kept, self.journal_header)

    def discard(self) -> None:
        """Delete the journal of earlier runs; their dataset stays until another one takes its place.

        Raises SweepError if ``out`` is neither empty nor the dataset of a sweep.
        """
        if self.out.exists() and not (self.out.is_file() and self.out.stat().st_size == 0):
            _read_sweep(self.out)
        journal.discard(self.journal_path)

    def run(
        self,
        n_jobs: int = 2,
        case_timeout: float | None = None,
        fail_fast: bool = False,
        progress: Progress = lambda records, total: None,
        backend: Backend | None = None,
        fresh: bool = False,
        tell: Callable[[str], None] = lambda remark: None,
    ) -> "xr.Dataset":
        """Run the cases that are not finished yet, or all if ``fresh``, and write the dataset.

        Parameters
        ----------
        n_jobs : int
            Number of parallel jobs.
        case_timeout : float, optional
            Time limit per case (s), instead of the config's.
        fail_fast : bool
            Whether to raise CaseFailedError at the first failed case; finished cases stay in the journal.
        progress : callable
            Called in this process, first with the records of earlier runs, then as cases finish.
        backend : Backend, optional
            Where the cases run; by default the backend of this machine that suits the solver.
        fresh : bool
            Whether to discard the results of earlier runs.
        tell : callable
            Called with a remark when workers die and are replaced.

        Returns
        -------
        xarray.Dataset
            The dataset, as it is stored in ``out``.

        Raises
        ------
        MismatchError
            An earlier run has cases that this sweep lacks, or was of another version.
        SweepError
            The sweep cannot start, go on or be stored.
        """
        started = datetime.now(UTC)
        with ExitStack() as opened:
            pool = self._open(opened, backend or local(self.settings.method), n_jobs)
            kept = opened.enter_context(self._journal(fresh))
            parts = opened.enter_context(closing(self._all_records(kept, pool, case_timeout, tell)))
            records = self._empty()
            for part in parts:
                records[part["index"]] = part
                progress(part, len(records))
                if fail_fast:
                    self._require_ok(part)
            result = self.assembled(records, started)
            dataset.write(result, self.out)
            self.journal_path.unlink()
        return result

    def run_here(self) -> "xr.Dataset":
        """Run all cases one after the other in this process; nothing is stored."""
        started = datetime.now(UTC)
        return self.assembled(self.solve(np.arange(self.count)), started)

    def solve(self, indices: np.ndarray, case_timeout: float | None = None) -> np.ndarray:
        """Solve the cases with these indices (in a continuation: whole rows) in this process."""
        limit = self._limit(case_timeout)
        return solve_chunk(self._chunk_of(indices, limit))

    def _open(self, opened: ExitStack, backend: Backend, n_jobs: int) -> Pool:
        with interrupts_ignored():
            return opened.enter_context(backend(n_jobs, partial(fingerprint, self.config)))

    def _all_records(
        self, kept: Journal, pool: Pool, case_timeout: float | None, tell: Callable[[str], None]
    ) -> Generator[np.ndarray, None, None]:
        whole = kept.records[~np.isin(kept.records["status"], RETRIED)]
        complete = self.rows.complete(whole["index"])
        todo = self.rows.without(complete)
        if len(todo):
            compile_once(self.settings, self.kit, self.config.system)
        log.debug("%s: %d cases of an earlier run", self.journal_path, len(whole))
        yield whole[np.isin(self.rows.of(whole["index"]), complete)]
        workers = Workers(
            pool,
            partial(self.rows.chunks, method=self.settings.method),
            partial(self._chunk, self._limit(case_timeout)),
            self.rows.of,
            tell,
        )
        with closing(workers.solve(todo)) as parts:
            for records in parts:
                kept.append(records)
                log.debug("%d cases solved in %.3g s", len(records), records["wall_time"].sum())
                yield records

    def _chunk(self, case_timeout: float, rows: np.ndarray) -> Chunk:
        """The task to solve some rows of cases."""
        cases = self.rows.cases(rows).ravel()
        return self._chunk_of(cases, case_timeout)

    def _chunk_of(self, cases: np.ndarray, case_timeout: float) -> Chunk:
        """The task to solve some cases, shape (n,)."""
        records, transients = self.config.records(cases), self.config.transients(cases)
        return Chunk(records, cases, self.settings, case_timeout, self.dtype, transients)

    def _empty(self) -> np.ndarray:
        """Room for the records of all cases; the system hands it out as they are filled in."""
        try:
            return np.empty(self.count, self.dtype)
        except MemoryError as error:
            needed = f"{self.count * self.dtype.itemsize / 1e9:.3g} GB"
            raise SweepError(
                f"{self.count} cases need {needed} of memory; split the sweep into several configs"
            ) from error

    def _limit(self, case_timeout: float | None) -> float:
        return self.settings.case_timeout if case_timeout is None else case_timeout

    def _require_ok(self, records: np.ndarray) -> None:
        failed = records[records["status"] != Outcome.OK]
        if failed.size:
            where = self.config.case_in_words(failed[0]["index"])
            raise CaseFailedError(f"{where}: {failed[0]['message'].decode()}")

    def assembled(self, records: np.ndarray, started: datetime) -> "xr.Dataset":
        """Assemble the dataset from the records of all cases."""
        sweep, coords = self.config.sweep, {**self.config.case_coordinates(), **self._time()}
        assembled = dataset.assemble(
            records,
            dataset.coordinates(coords, self.sizes),
            dict(zip(sweep.dims, sweep.shape, strict=True)),
            {
                **physics(self.config),
                **labels.attributes(self.config),
                **provenance.attributes(self.config, started, self.command),
            },
            labels.long_names(self.config),
        )
        assembled = assembled.assign(breakaway(self.config))
        return rotation.with_units(assembled) if self.config.turns else assembled

    def _time(self) -> dict[str, Any]:
        """Coordinates of the stored waveforms of an input that does not repeat: time, and the input."""
        transient = self.settings.transient
        if transient is None or not self.settings.keep_waveforms:
            return {}
        sweep = self.config.sweep
        dims, cases = sweep.along(sweep.keys_of_input)
        tables = self.config.tables_of_input(cases.ravel())
        inputs = self.config.inputs(tables)
        return transients.coordinates(tables, inputs, (*dims, "time"), cases.shape, transient)


def _header(ds: "xr.Dataset") -> dict[str, str]:
    """Fingerprint and config of a dataset, as the header of its journal had them."""
    return {**json_object(ds.attrs["fingerprint"]), "config": ds.attrs["config"]}


def _read_sweep(path: Path) -> "xr.Dataset":
    found = dataset.read_sweep(path)
    try:
        json_object(found.attrs["fingerprint"]), found.attrs["config"]
    except (KeyError, TypeError, ValueError) as error:
        raise SweepError(
            f"{path}: not the dataset of a sweep, as its fingerprint is missing; it is not overwritten"
        ) from error
    return found
