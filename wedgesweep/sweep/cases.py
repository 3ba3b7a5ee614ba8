"""Cases to records: whatever becomes of a case, it is data."""

from dataclasses import replace
from math import inf
from pathlib import Path
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np

from wedgesweep import simulate
from wedgesweep.compiled import CACHE_DIR
from wedgesweep.outcome import Outcome
from wedgesweep.simulate import Settings
from wedgesweep.solvers.trajectory import CaseError
from wedgesweep.sweep import dataset
from wedgesweep.sweep.batch import solve_batch
from wedgesweep.sweep.continuation import solve_lines
from wedgesweep.systems.suspension import parameters


def describe(law: str, beta: float, amplitude: float) -> str:
    """A case in words; amplitude in m."""
    return f"{law}, beta {beta:.6g}, amplitude {amplitude * 1e3:.6g} mm"


def is_compiled(method: str, extended: bool = False) -> bool:
    """Whether a solver's compiled code is cached, that of effects with mechanics of their own too."""
    return _compiled_mark(method, extended).exists()


def compile_once(method: str, extended: bool = False) -> None:
    """Fill numba's cache here, so that the jobs of a first run do not all compile the same.

    Nor does that take from the time limit of a case.
    """
    if is_compiled(method, extended):
        return
    short = Settings(method=method, settle_periods=1, kept_periods=2, samples_per_period=32)
    # This case sticks and slips, so that nothing is left to compile.
    effects = {"viscous_damping": {"coefficient": 1.0}} if extended else {}
    case = parameters.record("coulomb", 5e-3, 85.0, effects=effects)
    dtype = dataset.record_dtype({"phase": 64, "harmonic": dataset.HARMONICS, "part": 2})
    solve_cases(case, np.array([0]), short, inf, dtype)
    _compiled_mark(method, extended).touch()


def _compiled_mark(method: str, extended: bool) -> Path:
    # That the folder exists says little: reading parameters compiles a first few functions.
    return CACHE_DIR / f"{method}{'-extended' * extended}.complete"


class Chunk(NamedTuple):
    """Arguments of ``solve_cases``, as one that a cluster sends whole.

    Arrays of their own Dask would place on one worker, and they would be lost if that was killed.
    """

    cases: np.ndarray
    indices: np.ndarray
    settings: Settings
    case_timeout: float
    dtype: np.dtype


def solve_chunk(chunk: Chunk) -> np.ndarray:
    """``solve_cases`` of a chunk."""
    return solve_cases(*chunk)


def solve_cases(
    cases: np.ndarray,
    indices: np.ndarray,
    settings: Settings,
    case_timeout: float,
    dtype: np.dtype,
) -> np.ndarray:
    """Records of some cases; a case that fails is a status and a message, never an exception.

    In a continuation the cases are whole lines of the grid.
    """
    if settings.continuation:
        return solve_lines(cases, indices, settings, dtype)
    if settings.method == "event-driven":
        return solve_batch(cases, indices, settings, dtype)[0]
    records = dataset.blank(dtype, indices)
    for case in range(len(indices)):
        started = perf_counter()
        try:
            _solve_case(cases[case : case + 1], settings, case_timeout, records[case])
            outcome, message = Outcome.OK, ""
        except CaseError as error:
            outcome, message = Outcome[error.status.upper()], str(error)
        except Exception as error:  # one bad case must not take the sweep with it
            outcome, message = Outcome.SOLVER_FAILURE, f"{type(error).__name__}: {error}"
        if outcome != Outcome.OK:
            records[case] = dataset.blank(dtype, indices[case : case + 1])[0]
        records[case]["status"] = outcome
        records[case]["message"] = message.encode()[: dataset.MESSAGE_BYTES]
        records[case]["wall_time"] = perf_counter() - started
    return records


def _solve_case(case: np.ndarray, settings: Settings, case_timeout: float, record: np.void) -> None:
    limited = replace(settings, case_timeout=case_timeout)
    result, statistics = simulate.respond(case, limited, dataset.HARMONICS)
    if not np.isfinite(result.numbers["amplitude_ratio"]):
        status, message = "not_finite", "the response is not finite"
        raise CaseError(message, status)
    variables: dict[str, Any] = {
        **result.numbers,
        **result.spectra,
        **result.waveforms,
        **statistics,
    }
    for name in variables.keys() & set(record.dtype.names or ()):
        record[name] = variables[name]
    record["settled_periods"] = settings.window(float(case["input"]["omega"][0])).settle_periods
