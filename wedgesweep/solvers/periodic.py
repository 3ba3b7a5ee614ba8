"""Steady responses of many cases by shooting (shooting.py), each from a neighbour's state: for fits."""

from collections.abc import Sequence
from math import ceil, pi
from typing import Any, NamedTuple

import numpy as np

from wedgesweep import response, sensor
from wedgesweep.compiled import allocating, borrowed, compiled
from wedgesweep.hybrid.accumulators import clear
from wedgesweep.hybrid.state import OK
from wedgesweep.solvers.period_detection import LONGEST_PERIOD
from wedgesweep.solvers.period_map import memory, prepared, run_case
from wedgesweep.solvers.shooting import copy, known, run_map, settle_pointer, shooting
from wedgesweep.systems import grouped, state_count

__all__ = ["OK", "Accuracy", "Periodic", "Warm", "at_rest", "joined", "respond", "sampled"]

# Time constants after which the lag of the velocity channel no longer depends on its start.
LAG_TIMES = 16.0


class Warm(NamedTuple):
    """Warm start of a search for steady responses, one row per case: what was found for a neighbour.

    ``state`` (n, S) at phase 0 (NaN: nowhere; start at rest), ``period`` (n,) of the response in forcing
    periods (0: it does not repeat), ``map`` (n, S, S) the derivative of the state a period later by
    that at phase 0 (NaN: unknown).
    """

    state: Any
    period: Any
    map: Any

    def repeated(self, times: int) -> "Warm":
        """All rows, repeated as a block."""
        return Warm(*(np.concatenate([each] * times) for each in self))

    def of(self, rows: Any) -> "Warm":
        """Some of the rows."""
        return Warm(*(each[rows] for each in self))

    def where(self, chosen: np.ndarray, other: "Warm") -> "Warm":
        """The rows with those of another one where ``chosen`` (n,) is true."""
        found = Warm(*(each.copy() for each in self))
        for mine, its in zip(found, other, strict=True):
            mine[chosen] = its[chosen]
        return found


def at_rest(cases: int) -> Warm:
    """Start at rest, without neighbours."""
    n = state_count()
    return Warm(np.full((cases, n), np.nan), np.zeros(cases, np.int64), np.full((cases, n, n), np.nan))


def joined(some: Sequence[Warm]) -> Warm:
    """The rows of several, one after the other."""
    return Warm(*map(np.concatenate, zip(*some, strict=True)))


class Periodic(NamedTuple):
    """Steady responses, one row per case (SI units); NaN where there is none.

    ``spectra`` (n, 2, H), complex: D_h, h = 1..H, of displacement x - y = -z and of its rate, as the sensors
    show them; ``warm``: where they were found. ``outcome`` (n,) is OK or one of event_driven.MESSAGES;
    ``periods`` run, ``extremes`` (n, 2) lowest and highest deflection (m), ``stuck`` share of time,
    ``lifted`` share of time with a negative normal force (NaN if no forces were asked for). ``load``
    (n, samples): normal force of the first contact (N) over a period from phase 0, NaN where it is not
    determined; (n, 0) if it was not asked for.
    """

    spectra: Any
    warm: Warm
    outcome: Any
    periods: Any
    extremes: Any
    stuck: Any
    lifted: Any
    load: Any


class Accuracy(NamedTuple):
    """When a response counts as steady.

    ``tolerance``: change of the state per repetition, over input amplitude and velocity; ``most_periods``:
    a response without a repetition in that number is not periodic; ``rtol``: of a step.
    """

    tolerance: float
    most_periods: int
    rtol: float


def respond(
    parameters: np.ndarray,
    warm: Warm,
    accuracy: Accuracy,
    samples_per_period: int,
    harmonics: int,
    forces: bool = False,
    load: bool = False,
) -> Periodic:
    """Steady responses of parameter records, shape (n,).

    Parameters
    ----------
    parameters : structured array, shape (n,)
        See systems.suspension.parameters.record.
    warm : Warm, n rows
        Where to start from.
    accuracy : Accuracy
        When a response counts as steady.
    samples_per_period, harmonics : int
        Samples from which the harmonics are taken, and how many.
    forces : bool
        Also determine ``lifted``; with effects that have their own mechanics this doubles the time.
    load : bool
        Also sample the normal force.
    """
    n = len(parameters)
    found = Periodic(
        np.full((n, 2, harmonics), np.nan, np.complex128),
        Warm(*(each.copy() for each in warm)),
        np.zeros(n, np.int64),
        np.zeros(n, np.int64),
        np.full((n, 2), np.nan),
        np.full(n, np.nan),
        np.full(n, np.nan),
        np.full((n, samples_per_period if load else 0), np.nan),
    )
    room = memory(accuracy.rtol, samples_per_period, energies=forces, forces=load)
    motion = np.full((n, 2, samples_per_period), np.nan)
    for rows, records in grouped(parameters):
        cases = prepared(records)
        _respond_all(cases, rows, settle_pointer(cases, room), accuracy, room, found, motion)
    found.spectra[:] = np.fft.rfft(motion)[..., 1 : harmonics + 1] * (2.0 / samples_per_period)
    _sense_all(parameters, found.spectra.view(float).reshape(n, 2, harmonics, 2))
    return found


@compiled
def _respond_all(cases, rows, settle, accuracy, room, found, motion):
    """Write the steady responses of the cases into these rows of ``found``."""
    room, found = borrowed(room), borrowed(found)
    for k in range(rows.size):
        i, search = rows[k], shooting(cases, k, accuracy, room, True)
        n = search.size.size
        y, before = found.warm.state[i, :n].copy(), found.warm.period[i]
        jacobian = found.warm.map[i, :n, :n].copy()
        outcome, period, run, kept = settle(y, before, jacobian, search)
        if outcome == OK and not kept:
            # If the response does not repeat, its mean over as many periods as there is room for.
            kept = period if period else LONGEST_PERIOD
            clear(room.sums)
            outcome = run_map(run if period == 0 else 0, kept, y, True, search)
            run += kept
        found.outcome[i], found.periods[i] = outcome, run
        found.warm.state[i], found.warm.period[i], found.warm.map[i] = 0.0, period, np.nan
        copy(y, found.warm.state[i, :n])
        for j in range(n):
            copy(jacobian[j], found.warm.map[i, j, :n])
        if outcome != OK:
            found.warm.state[i] = np.nan
        else:
            _reduce(i, kept, room, found, motion[i])


@allocating
def _reduce(i, periods, room, found, motion):
    """Write the results of the kept periods; ``motion`` (2, samples): displacement x - y and its rate."""
    n = periods * room.samples_per_period
    response.mean_period(room.x[:n], -1.0, motion[0])
    response.mean_period(room.velocity[:n], -1.0, motion[1])
    if found.load.shape[1] > 0:
        response.mean_period(room.normal[0, :n], 1.0, found.load[i])
    one = room.sums[0]
    found.extremes[i, 0], found.extremes[i, 1] = one.lowest, one.highest
    found.stuck[i] = one.stuck_time / one.time
    if room.energies:
        found.lifted[i] = one.lifted_time / one.time


@compiled
def _sense_all(parameters, spectra):
    for i in range(parameters.size):
        sensor.apply_to_spectra(spectra[i], parameters[i])


class Sampled(NamedTuple):
    """Samples (n, k) of displacement (m), velocity (m/s) and acceleration (m/s^2; (n, 0) without).

    ``state`` (n, S): before and after.
    """

    x: Any
    velocity: Any
    acceleration: Any
    state: Any


def sampled(
    parameters: np.ndarray,
    states: np.ndarray,
    settle_periods: int,
    periods: int,
    samples_per_period: int,
    rtol: float,
    acceleration: bool = False,
) -> Sampled:
    """Displacement and velocity as the sensors show them; if wanted the acceleration, which has no sensor.

    For responses that do not repeat: each case starts at phase 0 from ``states`` (n, S; a row with NaN:
    at rest) and runs ``settle_periods`` before the kept ones. NaN where the case has no answer.
    """
    n, kept = len(parameters), periods * samples_per_period
    found = Sampled(
        np.full((n, kept), np.nan),
        np.full((n, kept), np.nan),
        np.full((n, kept if acceleration else 0), np.nan),
        np.array(states, dtype=float),
    )
    slowest = float((parameters["velocity_lag"]["time"] * parameters["input"]["omega"]).max()) / (2.0 * pi)
    # The lag of the velocity channel dies out before the kept samples.
    before = min(settle_periods, ceil(LAG_TIMES * slowest))
    room = memory(
        rtol,
        samples_per_period,
        before + periods,
        energies=False,
        forces=False,
        acceleration=acceleration,
        summed=False,
    )
    spans = np.array([settle_periods - before, before + periods])
    for rows, cases in grouped(parameters):
        _sample_all(prepared(cases), parameters[rows], rows, spans, room, found)
    return found


@compiled
def _sample_all(cases, parameters, rows, spans, room, out):
    """Run the cases of these rows; ``spans``: periods that are not kept, and periods that are."""
    room, out = borrowed(room), borrowed(out)
    for k in range(rows.size):
        i, p = rows[k], parameters[k]
        y = np.zeros(cases.scales.shape[1])
        if known(out.state[i : i + 1]):
            copy(out.state[i, : y.size], y)
        outcome = OK
        if spans[0] > 0:
            outcome = run_case(cases, k, 0, spans[0], y, False, room)
        if outcome == OK:
            outcome = run_case(cases, k, spans[0], spans[1], y, True, room)
        out.state[i] = 0.0
        copy(y, out.state[i, : y.size])
        if outcome != OK:
            out.state[i] = np.nan
        else:
            step = cases.cycle[k] / room.samples_per_period
            seen, first = sensor.lagged(room.velocity, step, False, p), room.x.size - out.x.shape[1]
            for j in range(out.x.shape[1]):
                out.x[i, j] = p.displacement_gain.scale * room.x[first + j]
                out.velocity[i, j] = seen[first + j]
            for j in range(out.acceleration.shape[1]):
                out.acceleration[i, j] = room.acceleration[first + j]
