"""Many cases at once with the event-driven solver: one compiled loop, no Python per case."""

from time import perf_counter

import numpy as np

from wedgesweep import response
from wedgesweep.hybrid.state import OK
from wedgesweep.simulate import Settings
from wedgesweep.solvers import event_driven
from wedgesweep.solvers.event_driven import Batch, BatchSettings
from wedgesweep.sweep import variables

WAVEFORMS = ("normal_force_column", "normal_force_bolster", "stuck")


def solve_batch(
    cases: np.ndarray, indices: np.ndarray, settings: Settings, dtype: np.dtype, continuation: bool = False
) -> tuple[np.ndarray, np.ndarray]:
    """Records of some cases, and their states (m, m/s) at the end, shape (n, states).

    ``cases`` are parameter records, shape (n,); they start from rest, in a ``continuation`` where the one
    before ended, unless that failed. The wall time of a case is its share of the batch's.
    """
    began = perf_counter()
    settle = settings.settling(cases["input"]["omega"])
    samples = settings.kept_periods * settings.samples_per_period
    batch = event_driven.empty_batch(
        len(cases), variables.HARMONICS, samples if "displacement" in (dtype.names or ()) else 0
    )
    event_driven.run_batch(cases, settle, _batch_settings(settings, continuation), _rtol(settings), batch)
    records = variables.blank(dtype, indices)
    _fill(records, batch, settings)
    records["wall_time"] = (perf_counter() - began) / len(cases)
    return records, batch.state


def _rtol(settings: Settings) -> float:
    """Tolerance of a step; a state cannot repeat more closely than it is computed."""
    return min(settings.rtol, settings.steady_tolerance) if settings.steady else settings.rtol


def _batch_settings(settings: Settings, continuation: bool) -> BatchSettings:
    return BatchSettings(
        settings.kept_periods,
        settings.samples_per_period,
        settings.steady,
        settings.steady_tolerance,
        settings.max_periods,
        continuation,
    )


def _fill(records: np.ndarray, batch: Batch, settings: Settings) -> None:
    """Copy a batch into its records; cases that failed stay blank but for status and message."""
    fine = (batch.outcome == OK) & np.isfinite(batch.numbers["amplitude_ratio"])
    columns = {name: batch.numbers[name] for name in response.NUMBERS.names or ()}
    columns |= {
        "displacement_harmonics": batch.spectra[:, 0],
        "velocity_harmonics": batch.spectra[:, 1],
        **dict(zip(event_driven.STATISTICS, batch.statistics.T, strict=True)),
        "settled_periods": batch.settled,
    }
    if settings.steady:
        columns["period"] = batch.period
    if batch.waveforms.size:
        columns["displacement"], columns["velocity"] = -batch.waveforms[:, :2].swapaxes(0, 1)
        columns |= dict(zip(WAVEFORMS, batch.waveforms[:, 2:].swapaxes(0, 1), strict=True))
    for name, values in columns.items():
        records[name][fine] = values[fine]
    records["status"][fine] = variables.STATUSES.index("ok")
    for case in np.flatnonzero(~fine).tolist():
        status, message = _failure(batch, case)
        records[case]["status"] = variables.STATUSES.index(status)
        records[case]["message"] = message.encode()[: variables.MESSAGE_BYTES]


def _failure(batch: Batch, case: int) -> tuple[str, str]:
    if batch.outcome[case] == OK:
        return "not_finite", "the response is not finite"
    status, message = event_driven.MESSAGES[batch.outcome[case]]
    return status, f"{message} (at t = {batch.time[case]:.6g} s)"
