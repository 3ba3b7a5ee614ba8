"""A sweep: config -> cases -> joblib -> dataset, with every finished case safe on disk at once."""

import json
import platform
import subprocess
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from functools import cached_property
from importlib.metadata import version
from pathlib import Path
from time import perf_counter
from typing import Any

import joblib
import numpy as np
import xarray as xr

from wedgesweep import __version__, contact, damper, dataset, simulate
from wedgesweep.compiled import CACHE_DIR, PACKAGE, source_digest
from wedgesweep.config import Case, Config
from wedgesweep.journal import Journal
from wedgesweep.simulate import Settings
from wedgesweep.solvers.trajectory import CaseError

PACKAGES = ("numpy", "scipy", "numba", "xarray", "netCDF4", "joblib")
SAME_RESULTS = ("numpy", "scipy", "numba")
SOURCE = "wedgesweep: friction wedge suspension of a three-piece bogie, half model"
REFERENCES = (
    "Numerical investigation on the friction wedge damper dynamics - a comparative study; "
    "Den Hartog (1930), Forced vibrations with combined Coulomb and viscous friction"
)

Progress = Callable[[np.ndarray], None]


class SweepError(Exception):
    """A sweep that cannot start, go on or be stored."""


@dataclass(frozen=True)
class Sweep:
    """All cases of a config and where their dataset goes."""

    config: Config
    out: Path

    @cached_property
    def parameters(self) -> np.ndarray:
        """Parameter records of all cases, shape (n,)."""
        return np.concatenate([self.config.record(case) for case in self.config.case_list()])

    @cached_property
    def settings(self) -> Settings:
        return self.config.solver

    @property
    def sizes(self) -> dict[str, int]:
        """Sizes of the dataset's dimensions within a case."""
        samples = self.settings.samples_per_period
        return {
            "phase": self.settings.kept_periods * samples,
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
        return {
            "config_sha256": self.config.sha256,
            "wedgesweep": __version__,
            "source_sha256": source_digest(),
            "python": platform.python_version(),
            **{name: version(name) for name in SAME_RESULTS},
        }

    def run(
        self,
        n_jobs: int = 2,
        case_timeout: float | None = None,
        fail_fast: bool = False,
        progress: Progress = lambda records: None,
        command: str = "",
    ) -> xr.Dataset:
        """Run what is not finished yet and write the dataset.

        ``progress`` is called in this process with the records of cases as they finish, first with those
        of earlier runs. Raises SweepError at the first failed case if ``fail_fast``; what is finished
        stays in the journal.
        """
        started = datetime.now(UTC)
        header = {**self.fingerprint, "cases": str(len(self.parameters)), "sizes": json.dumps(self.sizes)}
        with Journal(self.journal_path, self.dtype, header) as journal:
            kept = journal.records[journal.records["status"] != dataset.STATUSES.index("time_limit")]
            progress(kept)
            finished = [kept]
            todo = np.setdiff1d(np.arange(len(self.parameters)), kept["index"])
            for records in self._solve(todo, n_jobs, case_timeout):
                journal.append(records)
                progress(records)
                finished.append(records)
                if fail_fast and records["status"].any():
                    failed = records[records["status"] != 0][0]
                    message = f"case {failed['index']}: {failed['message'].decode()}"
                    raise SweepError(message)
        result = self.assembled(np.concatenate(finished), started, command)
        dataset.write(result, self.out)
        self.journal_path.unlink()
        return result

    def _solve(
        self, todo: np.ndarray, n_jobs: int, case_timeout: float | None
    ) -> Iterator[np.ndarray]:
        settings = self.settings
        limit = settings.case_timeout if case_timeout is None else case_timeout
        if not todo.size:
            return
        compile_once(self.parameters[todo[:1]], settings)
        pool = joblib.Parallel(n_jobs=n_jobs, return_as="generator_unordered")
        yield from pool(
            joblib.delayed(solve_cases)(
                self.parameters[[index]], np.array([index]), settings, limit, self.dtype
            )
            for index in todo
        )

    def assembled(self, records: np.ndarray, started: datetime, command: str) -> xr.Dataset:
        """Dataset of all cases from their records."""
        shape, coords = self.config.case_coordinates()
        return dataset.assemble(
            records,
            dataset.coordinates(coords, self.sizes),
            shape,
            {**self._physics(), **self._provenance(started, command)},
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

    def _provenance(self, started: datetime, command: str) -> dict[str, str]:
        stamp = started.strftime("%Y-%m-%dT%H:%M:%SZ")
        commit = git_commit()
        return {
            "title": self.config.title,
            "source": f"{SOURCE}, version {__version__}",
            "references": REFERENCES,
            "history": f"{stamp}: {command}",
            "start_time": stamp,
            "config": self.config.to_toml(),
            "config_sha256": self.config.sha256,
            "fingerprint": json.dumps(self.fingerprint),
            "wedgesweep_version": __version__,
            "package_versions": json.dumps({name: version(name) for name in PACKAGES}),
            **({"git_commit": commit} if commit else {}),
        }


def compile_once(parameters: np.ndarray, settings: Settings) -> None:
    """Fill numba's cache here, so that the workers of a first run do not all compile the same."""
    if CACHE_DIR.exists():
        return
    short = Settings(method=settings.method, settle_periods=1, kept_periods=2)
    try:
        simulate.respond(parameters, short, dataset.HARMONICS)
    except CaseError:
        pass


def solve_cases(
    parameters: np.ndarray,
    indices: np.ndarray,
    settings: Settings,
    case_timeout: float,
    dtype: np.dtype,
) -> np.ndarray:
    """Records of some cases; a case that fails is a status and a message, never an exception."""
    records = dataset.blank(dtype, indices)
    for case in range(len(indices)):
        started = perf_counter()
        try:
            _solve_case(parameters[case : case + 1], settings, case_timeout, records[case])
            status, message = "ok", ""
        except CaseError as error:
            status, message = error.status, str(error)
        except Exception as error:  # noqa: BLE001  one bad case must not take the sweep with it
            status, message = "solver_failure", f"{type(error).__name__}: {error}"
        if status != "ok":
            records[case] = dataset.blank(dtype, indices[case : case + 1])[0]
        records[case]["status"] = dataset.STATUSES.index(status)
        records[case]["message"] = message.encode()[: dataset.MESSAGE_BYTES]
        records[case]["wall_time"] = perf_counter() - started
    return records


def _solve_case(
    parameters: np.ndarray, settings: Settings, case_timeout: float, record: np.void
) -> None:
    limited = replace(settings, case_timeout=case_timeout)
    result, statistics = simulate.respond(parameters, limited, dataset.HARMONICS)
    if not np.isfinite(result.numbers["amplitude_ratio"]):
        message = "the response is not finite"
        raise CaseError("not_finite", message)
    for name, spectrum in result.spectra.items():
        record[name] = np.stack([spectrum.real, spectrum.imag], axis=-1)
    for name, value in {**result.numbers, **result.waveforms, **statistics}.items():
        record[name] = value


def git_commit() -> str | None:
    """Commit of the checkout that the package runs from, if it is one."""
    command = ["git", "-C", str(PACKAGE), "rev-parse", "HEAD"]
    try:
        result = subprocess.run(command, capture_output=True, text=True, check=False, timeout=5)
    except (OSError, subprocess.TimeoutExpired):
        return None
    return result.stdout.strip() or None
