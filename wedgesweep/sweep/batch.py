"""Many cases at once with the event-driven solver: one compiled loop, no Python per case."""

from time import perf_counter

import numpy as np

from wedgesweep import response, tally
from wedgesweep.simulate import Settings
from wedgesweep.solvers import event_driven, extended
from wedgesweep.solvers.event_driven import Batch, Plan
from wedgesweep.solvers.march import OK, workspace
from wedgesweep.sweep import dataset

WAVEFORMS = ("normal_force_column", "normal_force_bolster", "stuck")


def solve_batch(
    cases: np.ndarray,
    indices: np.ndarray,
    settings: Settings,
    dtype: np.dtype,
    chain: bool = False,
) -> tuple[np.ndarray, np.ndarray]:
    """Records of some cases, and their states (m, m/s) at the end, shape (n, 2).

    ``cases`` are parameter records, shape (n,); they start from rest, in a ``chain`` where the one before
    ended, unless that failed. The wall time of a case is its share of the batch's.
    """
    began = perf_counter()
    settle = settings.settling(cases["omega"])
    samples = settings.kept_periods * settings.samples_per_period
    batch = event_driven.empty_batch(
        len(cases), dataset.HARMONICS, samples if "displacement" in (dtype.names or ()) else 0
    )
    plan, rtol = _plan(settings, chain), _rtol(settings)
    # All cases have the effects of one config.
    if cases["extended"].any():
        extended.run_batch(cases, settle, plan, rtol, batch)
    else:
        event_driven.run_batch(cases, settle, plan, tally.empty(), workspace(rtol), batch)
    records = dataset.blank(dtype, indices)
    _fill(records, batch, settings)
    records["wall_time"] = (perf_counter() - began) / len(cases)
    return records, batch.state


def _rtol(settings: Settings) -> float:
    """Tolerance of a step; a state cannot repeat more closely than it is computed."""
    return min(settings.rtol, settings.steady_tolerance) if settings.steady else settings.rtol


def _plan(settings: Settings, chain: bool) -> Plan:
    return Plan(
        settings.kept_periods,
        settings.samples_per_period,
        settings.steady,
        settings.steady_tolerance,
        settings.max_periods,
        chain,
    )


def _fill(records: np.ndarray, batch: Batch, settings: Settings) -> None:
    """Copy a batch into its records; cases that failed stay blank but for status and message."""
    fine = (batch.outcome == OK) & np.isfinite(batch.numbers[:, 0])
    columns = dict(zip(response.NUMBERS, batch.numbers.T, strict=True))
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
    records["status"][fine] = dataset.STATUSES.index("ok")
    for case in np.flatnonzero(~fine).tolist():
        status, message = _failure(batch, case)
        records[case]["status"] = dataset.STATUSES.index(status)
        records[case]["message"] = message.encode()[: dataset.MESSAGE_BYTES]


def _failure(batch: Batch, case: int) -> tuple[str, str]:
    if batch.outcome[case] == OK:
        return "not_finite", "the response is not finite"
    status, message = event_driven.MESSAGES[batch.outcome[case]]
    return status, f"{message} (at t = {batch.time[case]:.6g} s)"
