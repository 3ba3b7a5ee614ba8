"""scipy's Radau, mode by mode: it never steps across a corner of the equations.

Each call of ``solve_ivp`` follows one mode until one of its event functions reaches zero. Right-hand side and
event functions are compiled; what remains is scipy's.
"""

from cmath import isfinite
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import replace
from math import inf, isnan, pi
from time import perf_counter
from typing import Any

import numpy as np
from scipy.integrate import Radau, solve_ivp
from scipy.optimize import brentq, minimize_scalar

from wedgesweep.hybrid import accumulators
from wedgesweep.solvers import radau_system as system
from wedgesweep.solvers.integrate import EVENTS_PER_PERIOD
from wedgesweep.solvers.trajectory import CaseError, Trajectory, Window, empty_samples
from wedgesweep.systems import compact

# A mode of the system, a tuple of integers.
Mode = Any
# Absolute tolerances, as a share of rtol times input amplitude and input velocity: motions far smaller
# than the input, as they occur near breakaway, are resolved as well.
ABSOLUTE = 1e-2
# Least number of steps per period of the fastest input: a step is too short for a stop and the start after
# it. While contacts hold the mass nothing else limits its length.
STEPS_PER_PERIOD, STEPS_HELD = 16, 64
# Phase (rad) after which an event function that is passing zero is safely away from it.
LOOK_AHEAD = 1e-8
# Error of the place of a minimum, as a share of a step.
PLACE_OF_MINIMUM = 1e-9
# If a mode ends where it began, its first step is divided by SHORTER, down to this share of a period.
SHORTER, SHORTEST = 10.0, 1e-13
# While a run settles, its tolerance may be this much coarser.
COARSER = 100.0
GAUSS_POINTS, GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(4)


def inverse(matrix: np.ndarray) -> np.ndarray:
    """Inverse of a 2 x 2 matrix, real or complex."""
    (a, b), (c, d) = matrix.tolist()
    return np.array([[d, -b], [-c, a]]) / (a * d - b * c)


class StrictRadau(Radau):
    """scipy's Radau that rejects a step whose error cannot be estimated.

    After a rejection scipy estimates the error once more, by the rate where the step begins, moved by the
    error. A wedge may lock there, so that no rate exists: scipy raises ValueError, and would accept the step
    if it did not check.
    """

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self.solve: Any = self.solve_lu  # type: ignore[has-type]
        self.solve_lu = self._solved

    def _solved(self, factors: Any, right: np.ndarray) -> np.ndarray:
        # A list is quicker than numpy for a few numbers.
        known = all(map(isfinite, right.tolist()))
        return self.solve(factors, right) if known else np.full_like(right, np.inf)


class SmallRadau(StrictRadau):
    """The same with the linear algebra of a 2 x 2 system.

    LAPACK's wrappers take a third of the time of a case; an explicit inverse gives the same Newton
    iteration.
    """

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self.lu, self.solve = self._inverse, np.dot

    def _inverse(self, matrix: np.ndarray) -> np.ndarray:
        self.nlu += 1
        return inverse(matrix)


def solve(
    parameters: np.ndarray,
    window: Window,
    rtol: float,
    time_limit: float,
    start: Sequence[float] | np.ndarray = (0.0, 0.0),
    settled: float | None = None,
) -> Trajectory:
    """Run one case.

    Parameters
    ----------
    parameters : structured array, shape (1,)
        Of the suspension (see systems.suspension.parameters.record), or of another system.
    window : Window
        Time span and what to keep of it.
    rtol : float
        Relative tolerance of each step.
    time_limit : float
        Wall time (s) after which the case is given up.
    start : sequence of float
        State at t = 0: deflection from the rest position (m), its rate (m/s), then the states of effects,
        which may be left out where they are 0.
    settled : float, optional
        Settling ends early where a period changes the state by less than this share of input amplitude
        and input velocity; the window then begins earlier. Most of it is run at a coarser tolerance.

    Raises
    ------
    CaseError
        If the system locks, the time limit passes or the integrator fails.
    """
    return _Run(parameters, window, rtol, time_limit).trajectory(start, settled)


class _Run:
    """A run of one case: its current state, and what it has kept."""

    def __init__(self, parameters: np.ndarray, window: Window, rtol: float, time_limit: float) -> None:
        self.window, self.rtol = window, rtol
        self.case = compact(parameters)
        self.deadline = perf_counter() + time_limit
        self.time_limit = time_limit
        self.scales, fastest = system.description(self.case)
        self.period = 2.0 * pi / fastest
        self.statistics: Counter[str] = Counter(rate_evaluations=0, steps=0, switches=0)
        self.sums = accumulators.empty()
        self.first_step: float | None = None
        self.last_event = -1

    def trajectory(self, start: Sequence[float] | np.ndarray, settled: float | None) -> Trajectory:
        """Follow the modes to the end of the window."""
        y = np.zeros(self.scales.size)
        y[: len(start)] = start[: y.size]
        mode, unique = system.initial_mode(0.0, y, self.case)
        self._require(unique, 0.0)
        y, mode = self._settle(y, mode, settled)
        self.samples = empty_samples(self.window.sample_times)
        self._follow(self.window.keep, self.window.end, y, mode)
        return Trajectory(self.samples, self.sums, self.window.periods, dict(self.statistics))

    def _settle(self, y: np.ndarray, mode: Mode, settled: float | None) -> tuple[np.ndarray, Mode]:
        """Follow the modes to the kept part of the window, which begins earlier if the state repeats."""
        if settled is None:
            return self._follow(0.0, self.window.keep, y, mode)
        most, close = self.window.settle_periods, self.scales * settled
        self.window = replace(self.window, settle_periods=0)
        for coarseness, last in ((COARSER, most - most // 4), (1.0, most)):
            self.rtol *= coarseness
            for periods in range(self.window.settle_periods + 1, last + 1):
                before, began = y, self.window.keep
                self.window = replace(self.window, settle_periods=periods)
                y, mode = self._follow(began, self.window.keep, y, mode)
                if np.all(np.abs(y - before) < close):
                    break
            self.rtol /= coarseness
        return y, mode

    def _follow(self, t: float, stop: float, y: np.ndarray, mode: Mode) -> tuple[np.ndarray, Mode]:
        """Follow the modes from one time to another."""
        while t < stop:
            t, y, event = self._follow_mode(t, stop, y, mode)
            if event >= 0:
                y, mode = self._after(t, y, mode, event)
        return y, mode

    def _follow_mode(self, t: float, stop: float, y: np.ndarray, mode: Mode) -> tuple[float, np.ndarray, int]:
        """Follow one mode; the time and state where it ends, and the event (-1 at ``stop``)."""
        moment = LOOK_AHEAD / self.window.omega
        ahead = system.events(t, y, mode, self.case, moment)
        for place in np.flatnonzero(ahead < 0.0).tolist():
            if not self._just_passed(place):
                return t, y, place  # it came at the same time as the event before
        places = np.flatnonzero(np.isfinite(ahead)).tolist()
        at_rest, moving = system.of_mode(y, mode, self.case)
        result = self._integrate(t, stop, y[:moving], mode, places, at_rest)
        if at_rest:
            _truncate_at_grazing(result, lambda t: system.events(t, result.sol(t), mode, self.case)[places])
        reached = [place for place, times in zip(places, result.t_events, strict=False) if times.size]
        if reached and result.t[-1] == t:
            self._shorten_first_step(t)
            return t, y, -1
        fault = system.check(result.t, result.y, mode, self.case)
        self._require(fault != system.LOCKED, result.t[-1])
        if fault == system.MISSED:
            raise CaseError(
                f"a switch was missed between t = {t:.6g} s and {result.t[-1]:.6g} s", "solver_failure"
            )
        if result.t.size > 2:
            self.first_step = result.t[-2] - result.t[-3]
        if t >= self.window.keep:
            self._keep(result, mode)
        return result.t[-1], result.y[:, -1], reached[0] if reached else -1

    def _just_passed(self, place: int) -> bool:
        """Whether an event is of the same pair as the last one: then its function begins at 0."""
        return place // 2 == self.last_event // 2

    def _shorten_first_step(self, t: float) -> None:
        """Begin the mode again with a shorter first step: the last one saw only the end of a short motion."""
        self.first_step = (self.first_step or self.period) / SHORTER
        if self.first_step < SHORTEST * self.period:
            raise CaseError(f"no progress at t = {t:.6g} s", "solver_failure")

    def _integrate(
        self, t: float, stop: float, y: np.ndarray, mode: Mode, places: list[int], at_rest: bool
    ) -> Any:
        moving = y.size
        result = solve_ivp(
            self._rate(mode),
            (t, stop),
            y,
            method=SmallRadau if moving == 2 else StrictRadau,
            jac=self._jacobian(mode),
            events=[*(self._event(t, mode, place) for place in places), _turn],
            dense_output=at_rest or t >= self.window.keep,
            rtol=self.rtol,
            atol=ABSOLUTE * self.rtol * self.scales[:moving],
            max_step=self.period / (STEPS_HELD if at_rest else STEPS_PER_PERIOD),
            first_step=min(self.first_step, stop - t) if self.first_step else None,
        )
        self._check(result)
        if moving < self.scales.size:
            output = result.sol
            result.sol, result.y = (lambda t: self._all(output(t))), self._all(result.y)
            result.y_events = [self._all(states.T).T if states.size else states for states in result.y_events]
        return result

    def _all(self, y: np.ndarray) -> np.ndarray:
        """All states, shape (n,) or (n, k), from those that move: the others are 0."""
        if len(y) == self.scales.size:
            return y
        states = np.zeros((self.scales.size, *y.shape[1:]))
        states[: len(y)] = y
        return states

    def _rate(self, mode: Mode) -> Callable[[float, np.ndarray], np.ndarray]:
        case, deadline = self.case, self.deadline

        def limited_rate(t: float, y: np.ndarray) -> np.ndarray:
            if perf_counter() > deadline:
                raise CaseError(f"gave up after {self.time_limit:g} s at t = {t:.6g} s", "time_limit")
            return system.rate(t, self._all(y), mode, case)[: y.size]

        return limited_rate

    def _jacobian(self, mode: Mode) -> Callable[[float, np.ndarray], np.ndarray]:
        case = self.case

        def determined(t: float, y: np.ndarray) -> np.ndarray:
            found = system.jacobian(t, self._all(y), mode, case)[: y.size, : y.size]
            self._require(bool(np.isfinite(found).all()), t)
            return found

        return determined

    def _event(self, start: float, mode: Mode, place: int) -> Callable[[float, np.ndarray], float]:
        case = self.case

        def event(t: float, y: np.ndarray) -> float:
            value = system.events(t, self._all(y), mode, case)[place]
            self._require(not isnan(value), t)
            # An event that begins at zero may be negative there by rounding, which would hide its return.
            return max(value, 0.0) if t == start else value

        # scipy reads these two from the function.
        event.terminal, event.direction = True, -1  # type: ignore[attr-defined]
        return event

    def _after(self, t: float, y: np.ndarray, mode: Mode, event: int) -> tuple[np.ndarray, Mode]:
        self.statistics["switches"] += 1
        self.last_event = event
        if self.statistics["switches"] > EVENTS_PER_PERIOD * (1.0 + t / self.period):
            raise CaseError(
                f"more than {EVENTS_PER_PERIOD} switches per period at t = {t:.6g} s", "solver_failure"
            )
        sums = self.sums if t >= self.window.keep else None
        y, mode, unique = system.transition(t, y, mode, event, self.case, sums)
        self._require(unique, t)
        return y, mode

    def _check(self, result: Any) -> None:
        self.statistics["rate_evaluations"] += result.nfev
        self.statistics["steps"] += result.t.size - 1
        if not np.isfinite(result.y).all():
            raise CaseError(f"state not finite at t = {result.t[-1]:.6g} s", "not_finite")
        if result.status < 0:
            raise CaseError(f"{result.message} (at t = {result.t[-1]:.6g} s)", "solver_failure")

    def _require(self, unique: bool, t: float) -> None:
        if not unique:
            raise CaseError(f"normal forces not unique at t = {t:.6g} s: the system locks", "locked")

    def _keep(self, result: Any, mode: Mode) -> None:
        half = 0.5 * np.diff(result.t)
        t = ((result.t[:-1] + half)[:, None] + half[:, None] * GAUSS_POINTS).ravel()
        self._add(t, result.sol(t), mode, np.outer(half, GAUSS_WEIGHTS).ravel())
        self._add(result.t[[0, -1]], result.y[:, [0, -1]], mode)
        self._add(result.t_events[-1], result.y_events[-1].reshape(-1, self.scales.size).T, mode)
        here = slice(*np.searchsorted(self.samples.t, (result.t[0], result.t[-1])))
        if here.start < here.stop:
            times = self.samples.t[here]
            seen = system.sample(times, result.sol(times), mode, self.case)
            self.samples.x[here], self.samples.velocity[here] = seen[:2]
            self.samples.normal[:, here], self.samples.sticks[here] = seen[2:4], seen[4]
            self.samples.acceleration[here] = seen[5]

    def _add(self, t: np.ndarray, y: np.ndarray, mode: Mode, weight: np.ndarray | None = None) -> None:
        system.add(self.sums, t, y, weight, mode, self.case)


def _turn(t: float, y: np.ndarray) -> float:
    """Zero where x is extreme."""
    return y[1]


def _truncate_at_grazing(result: Any, values: Callable[[float], np.ndarray]) -> None:
    """Let a result of ``solve_ivp``, with dense output, end where an event function is first zero.

    ``solve_ivp`` looks at the ends of each step, and misses one that passes zero and comes back within a
    step. ``values``: the event functions (k,) at a time, in the order of the first k events.
    """
    at_ends = np.array([values(t) for t in result.t])
    for i in range(1, len(at_ends) - 1):
        lowest = (at_ends[i] <= at_ends[i - 1]) & (at_ends[i] <= at_ends[i + 1])
        found = [
            (_first_zero(values, k, result.t[i - 1], result.t[i + 1]), k)
            for k in np.flatnonzero(lowest).tolist()
        ]
        reached = min(found, default=(inf, 0))
        if reached[0] < inf:
            _end_at(result, *reached)
            return


def _first_zero(values: Callable[[float], np.ndarray], k: int, before: float, after: float) -> float:
    """Time at which an event function is first zero between two times around its minimum; inf if never."""

    def value(t: float) -> float:
        return float(values(t)[k])

    close = PLACE_OF_MINIMUM * (after - before)
    least = minimize_scalar(value, bounds=(before, after), method="bounded", options={"xatol": close})
    if value(before) <= 0.0 or least.fun >= 0.0:
        return inf
    return float(brentq(value, before, least.x, xtol=close))


def _end_at(result: Any, t: float, k: int) -> None:
    """Let a result of ``solve_ivp`` end at a time, with event k."""
    y = result.sol(t)
    kept = result.t < t
    result.t, result.y = np.append(result.t[kept], t), np.column_stack([result.y[:, kept], y])
    for i, times in enumerate(result.t_events):
        before = times < t
        result.t_events[i], result.y_events[i] = times[before], result.y_events[i][before]
    result.t_events[k], result.y_events[k] = np.array([t]), y[None]
