"""Verification: random cases of a finished sweep, solved again by Radau at a tight tolerance.

A case of a fixed length is run from rest as it was. A steady state that was found by shooting is begun in its
state, and must come back to it: from rest it may take thousands of periods, or lead to another of several
coexisting responses. Where Radau's own result changes with its tolerance, the motion amplifies errors, and
the case cannot be verified.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import inf, isfinite, nan
from typing import NamedTuple

import joblib
import numpy as np
import xarray as xr

from wedgesweep import response
from wedgesweep.outcome import Outcome
from wedgesweep.simulate import Settings
from wedgesweep.solvers import radau
from wedgesweep.solvers.trajectory import CaseError, Window
from wedgesweep.sweep import variables
from wedgesweep.sweep.backend import in_order
from wedgesweep.sweep.batch import solve_batch
from wedgesweep.sweep.cases import compile_once
from wedgesweep.sweep.run import Sweep

RTOL, TIGHTER = 1e-9, 1e-10
# Wall time (s) after which Radau gives up a case.
TIME_LIMIT = 600.0
# Largest difference of amplitude ratios, as a share of the ratio or of SMALL_RATIO, and of stick fractions.
# Radau cannot verify a case in which its results at both tolerances differ by more than the share UNCERTAIN
# of these.
RATIO_BOUND, SMALL_RATIO, STICK_BOUND, UNCERTAIN = 1e-3, 0.1, 1e-2, 0.1


class Numbers(NamedTuple):
    """Numbers of a case that are compared: amplitude ratio and stick fraction."""

    ratio: float
    stick: float

    def apart(self, other: "Numbers") -> "Numbers":
        """Differences."""
        return Numbers(abs(self.ratio - other.ratio), abs(self.stick - other.stick))

    def over_bound(self, other: "Numbers") -> float:
        """The larger difference, over its bound; inf where a number is missing."""
        apart = self.apart(other)
        shares = apart.ratio / (RATIO_BOUND * max(SMALL_RATIO, other.ratio)), apart.stick / STICK_BOUND
        return max(shares) if all(map(isfinite, shares)) else inf


class VerifiedCase(NamedTuple):
    """A case in words, its numbers as stored and by Radau, and why Radau cannot verify it, if so."""

    case: str
    stored: Numbers
    reference: Numbers
    message: str = ""

    @property
    def apart(self) -> Numbers:
        """How far the stored numbers are off."""
        return self.stored.apart(self.reference)

    @property
    def is_wrong(self) -> bool:
        """Whether the stored numbers are off by more than the bounds."""
        return not self.message and self.stored.over_bound(self.reference) > 1.0


@dataclass(frozen=True)
class Verification:
    """The cases that were drawn with ``seed``, and how many could have been."""

    seed: int
    candidates: int
    cases: tuple[VerifiedCase, ...]

    @property
    def verifiable(self) -> list[VerifiedCase]:
        """Cases whose results by Radau do not depend on its tolerance."""
        return [case for case in self.cases if not case.message]


class _Task(NamedTuple):
    """One case for Radau: its parameter record, shape (1,), its start and what is stored of it."""

    description: str
    record: np.ndarray
    window: Window
    start: np.ndarray
    stored: Numbers


def verify(sweep: Sweep, ds: xr.Dataset, count: int, seed: int, n_jobs: int) -> Verification:
    """Solve ``count`` random cases of a sweep with dataset ``ds`` again, and compare.

    Cases that failed, and those without a steady state where one was looked for, are not drawn.
    """
    shape = sweep.config.sweep.shape
    values = {name: ds[name].values for name in ("status", "period", "amplitude_ratio", "stick_fraction")}
    stored = {name: each.reshape(shape).ravel() for name, each in values.items()}
    fine = stored["status"] == Outcome.OK
    if sweep.settings.steady:
        fine &= stored["period"] > 0
    candidates = np.flatnonzero(fine)
    drawn = np.random.default_rng(seed).choice(candidates, min(count, candidates.size), replace=False)
    tasks = [_task(sweep, stored, index) for index in np.sort(drawn).tolist()]
    compile_once(Settings("radau"), sweep.kit, sweep.config.system)
    found = in_order((joblib.delayed(_verified)(task) for task in tasks), n_jobs)
    return Verification(seed, candidates.size, tuple(sorted(found)))


def _task(sweep: Sweep, stored: dict[str, np.ndarray], index: int) -> _Task:
    record = sweep.config.records(np.array([index]))
    omega, period = float(record["input"]["omega"][0]), int(stored["period"][index])
    window, start = sweep.settings.window(omega), np.zeros(2)
    if sweep.settings.steady:
        # As many whole periods of the response as the sweep keeps, after one.
        whole = period * -(-window.periods // period)
        window, start = replace(window, settle_periods=period, periods=whole), _state(sweep, index)
    return _Task(
        sweep.config.case_in_words(index),
        record,
        window,
        start,
        Numbers(float(stored["amplitude_ratio"][index]), float(stored["stick_fraction"][index])),
    )


def _state(sweep: Sweep, index: int) -> np.ndarray:
    """The state in which the steady response of a case begins its period."""
    row = sweep.rows.cases(sweep.rows.of(np.array([index])))[0]
    numbers_only: Settings = replace(sweep.settings, keep_waveforms=False)
    dtype = variables.record_dtype({**sweep.sizes, "phase": 0}, sweep.settings.continuation)
    records = sweep.config.records(row)
    _, states = solve_batch(records, row, numbers_only, dtype, sweep.settings.continuation)
    return states[row.tolist().index(index)]


def _verified(task: _Task) -> VerifiedCase:
    try:
        numbers = _solved(task, RTOL)
        if task.stored.over_bound(numbers) <= 1.0:
            return VerifiedCase(task.description, task.stored, numbers)
        tighter = _solved(task, TIGHTER)
    except CaseError as error:
        return VerifiedCase(task.description, task.stored, Numbers(nan, nan), f"Radau fails: {error}")
    moved = numbers.apart(tighter)
    uncertain = numbers.over_bound(tighter) > UNCERTAIN
    message = (
        f"Radau moves by {moved.ratio:.1g} itself from rtol {RTOL:g} to {TIGHTER:g}" if uncertain else ""
    )
    return VerifiedCase(task.description, task.stored, tighter, message)


def _solved(task: _Task, rtol: float) -> Numbers:
    run = radau.solve(task.record, task.window, rtol, TIME_LIMIT, task.start)
    numbers = response.evaluate(run, task.record, variables.HARMONICS).numbers
    found = Numbers(float(numbers["amplitude_ratio"]), float(numbers["stick_fraction"]))
    if not all(map(isfinite, found)):
        raise CaseError("the response is not finite", "not_finite")
    return found


def largest(cases: Sequence[VerifiedCase], name: str) -> VerifiedCase:
    """The case whose ``ratio`` or ``stick`` is farthest off."""

    def size(case: VerifiedCase) -> float:
        apart = float(getattr(case.apart, name))
        return apart if isfinite(apart) else inf

    return max(cases, key=size)
