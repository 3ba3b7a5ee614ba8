"""Solving cases: each gives a record, also if it fails."""

from collections.abc import Sequence
from dataclasses import replace
from math import inf
from pathlib import Path
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np

from wedgesweep import kernels, simulate
from wedgesweep.outcome import Outcome
from wedgesweep.simulate import Settings, Transient
from wedgesweep.solvers.trajectory import CaseError
from wedgesweep.sweep import variables
from wedgesweep.sweep.batch import solve_batch
from wedgesweep.sweep.continuation import solve_rows
from wedgesweep.sweep.transients import solve_case
from wedgesweep.systems import example

SUSPENSION = "suspension"


def is_compiled(settings: Settings, kit: int = 0, system: str = SUSPENSION) -> bool:
    """Whether the code for these settings is kept, for records of a system that need a kit of parts."""
    mark = _mark_of(settings, kit, system)
    return mark is not None and mark.exists()


def compile_once(settings: Settings, kit: int = 0, system: str = SUSPENSION) -> None:
    """Compile in this process what its jobs need, so that they load it.

    Nor does compile time count against the time limit of a case.
    """
    if is_compiled(settings, kit, system):
        return
    # It sticks and slips, so that it uses all compiled functions.
    short, dtype = short_run(settings)
    solve_cases(example(system, kit), np.array([0]), short, inf, dtype)
    if mark := _mark_of(settings, kit, system):
        mark.touch()


def short_run(settings: Settings) -> tuple[Settings, np.dtype]:
    """Settings of a short run, for which the same code is compiled, and the layout of its records."""
    motion = settings.transient.first(2) if settings.transient else None
    settle = None if settings.steady else 1
    short = Settings(settings.method, kept_periods=2, samples_per_period=32, settle_periods=settle)
    sizes = {"time": 0} if motion else {"phase": 64, "harmonic": variables.HARMONICS, "part": 2}
    short = replace(short, steady=settings.steady, transient=motion, max_periods=5)
    return short, variables.record_dtype(sizes)


def _mark_of(settings: Settings, kit: int, system: str) -> Path | None:
    """File that exists once all code that these settings need is kept; the folder itself exists earlier."""
    run = "transient" if settings.transient else "steady" if settings.steady else "periods"
    folder = kernels.folder()
    return folder and folder / f"{settings.method}-{run}-{system}-{kit}.complete"


class Chunk(NamedTuple):
    """Arguments of ``solve_cases`` as one object, which a cluster sends along with the task.

    Dask would place separate arrays on one worker, and lose them if it is killed.
    """

    cases: np.ndarray
    indices: np.ndarray
    settings: Settings
    case_timeout: float
    dtype: np.dtype
    transients: tuple[Transient, ...] = ()


def solve_chunk(chunk: Chunk) -> np.ndarray:
    """Solve the cases of a chunk; their records."""
    return solve_cases(*chunk)


def solve_cases(
    cases: np.ndarray,
    indices: np.ndarray,
    settings: Settings,
    case_timeout: float,
    dtype: np.dtype,
    transients: Sequence[Transient] = (),
) -> np.ndarray:
    """Solve some cases; a case that fails gives a status and a message, never an exception.

    Parameters
    ----------
    cases : structured array, shape (n,)
        Parameter records (see parameters.record); in a continuation whole rows (see chunks.Rows).
    indices : array, shape (n,)
        Indices of the cases in the sweep.
    settings : Settings
        Solver and its settings.
    case_timeout : float
        Time limit per case (s); radau only.
    dtype : dtype
        Layout of the records (see variables.record_dtype).
    transients : sequence of Transient, n
        The input of each case, unless all have that of the settings.

    Returns
    -------
    structured array, shape (n,)
        Records of the cases.
    """
    if settings.transient is None and settings.continuation:
        return solve_rows(cases, indices, settings, dtype)
    if settings.transient is None and settings.method == "event-driven":
        return solve_batch(cases, indices, settings, dtype)[0]
    records = variables.blank(dtype, indices)
    for case in range(len(indices)):
        started = perf_counter()
        try:
            own = replace(settings, transient=transients[case]) if transients else settings
            _solve_case(cases[case : case + 1], own, case_timeout, records[case])
            outcome, message = Outcome.OK, ""
        except CaseError as error:
            outcome, message = Outcome[error.status.upper()], str(error)
        except OSError:  # the fault of the machine, such as a full disk, and not of the case
            raise
        except Exception as error:  # one bad case must not take the sweep with it
            outcome, message = Outcome.SOLVER_FAILURE, f"{type(error).__name__}: {error}"
        if outcome != Outcome.OK:
            records[case] = variables.blank(dtype, indices[case : case + 1])[0]
        records[case]["status"] = outcome
        records[case]["message"] = message.encode()[: variables.MESSAGE_BYTES]
        records[case]["wall_time"] = perf_counter() - started
    return records


def _solve_case(case: np.ndarray, settings: Settings, case_timeout: float, record: np.void) -> None:
    limited = replace(settings, case_timeout=case_timeout)
    if settings.transient is not None:
        solve_case(case, limited, record)
        return
    result, statistics = simulate.respond(case, limited, variables.HARMONICS)
    if not np.isfinite(result.numbers["amplitude_ratio"]):
        status, message = "not_finite", "the response is not finite"
        raise CaseError(message, status)
    values: dict[str, Any] = {**result.numbers, **result.spectra, **result.waveforms, **statistics}
    for name in values.keys() & set(record.dtype.names or ()):
        record[name] = values[name]
    record["settled_periods"] = settings.window(float(case["input"]["omega"][0])).settle_periods
