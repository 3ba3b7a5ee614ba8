"""scipy's Radau, piece by piece: it never steps across a corner of the friction law.

Each piece runs on one mode until one of its switches reaches zero. What modes there are is the
business of pieces.py; right-hand side and Jacobian are compiled, what remains is scipy's.
"""

from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from math import pi
from time import perf_counter
from typing import Any

import numpy as np
from scipy.integrate import Radau, solve_ivp

from wedgesweep import tally
from wedgesweep.compiled import compiled
from wedgesweep.contact import LOOK_AHEAD
from wedgesweep.solvers import dips
from wedgesweep.solvers.pieces import Mode, pieces_of
from wedgesweep.solvers.sticking import LOCKED
from wedgesweep.solvers.trajectory import CaseError, Trajectory, Window, empty_samples

# Absolute tolerances, as a share of rtol times input amplitude and input velocity: motions far smaller
# than the input, as they occur near breakaway, are resolved as well.
ABSOLUTE = 1e-2
# Steps per period of the fastest input: one as long cannot hold a stop and the start after it. While the
# bolster rides nothing else limits them.
STEPS_PER_PERIOD, STEPS_RIDING = 16, 64
SWITCHES_PER_PERIOD = 1000
# When a piece ends where it began, its first step is made shorter, down to this share of a period.
SHORTER, SHORTEST = 10.0, 1e-13
# While a run settles, its tolerance may be this much coarser.
COARSER = 100.0
GAUSS_POINTS, GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(4)


@compiled
def inverse(matrix):
    """Inverse of a 2 x 2 matrix, real or complex."""
    (a, b), (c, d) = matrix
    return np.array([[d, -b], [-c, a]]) / (a * d - b * c)


class SmallRadau(Radau):
    """scipy's Radau with the linear algebra of a 2 x 2 system.

    LAPACK's wrappers take a third of the time of a case; an explicit inverse gives the same Newton
    iteration.
    """

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self.lu = self._inverse
        self.solve_lu = np.dot

    def _inverse(self, matrix: np.ndarray) -> np.ndarray:
        self.nlu += 1
        return inverse(matrix)


def solve(
    parameters: np.ndarray,
    window: Window,
    rtol: float,
    time_limit: float,
    start: tuple[float, float] = (0.0, 0.0),
    settled: float | None = None,
) -> Trajectory:
    """Run one case.

    Parameters
    ----------
    parameters : structured array, shape (1,)
        See parameters.record.
    window : Window
        Time span and what to keep of it.
    rtol : float
        Relative tolerance of each step.
    time_limit : float
        Wall time (s) after which the case is given up.
    start : tuple of float
        Deflection from the rest position (m) and its rate (m/s) at t = 0.
    settled : float, optional
        Settling ends early where a period changes the state by less than this share of input amplitude
        and input velocity; the window then begins earlier. Most of it is run at a coarser tolerance.

    Raises
    ------
    CaseError
        If the wedge locks, the time limit passes or the integrator fails.
    """
    return _Run(parameters, window, rtol, time_limit).trajectory(start, settled)


class _Run:
    """One case on its way: the current state, and what is kept so far."""

    def __init__(self, parameters: np.ndarray, window: Window, rtol: float, time_limit: float) -> None:
        self.window, self.rtol = window, rtol
        self.pieces = pieces_of(parameters)
        self.deadline = perf_counter() + time_limit
        self.time_limit = time_limit
        self.period = 2.0 * pi / self.pieces.fastest
        self.atol = ABSOLUTE * rtol * self.pieces.scale
        self.statistics: Counter[str] = Counter(rate_evaluations=0, steps=0, switches=0)
        self.tally = tally.empty()
        self.first_step: float | None = None
        self.last_switch = -1

    def trajectory(self, start: tuple[float, float], settled: float | None) -> Trajectory:
        """Follow the pieces to the end of the window."""
        y = np.zeros(self.pieces.scale.size)
        y[:2] = start
        mode, unique = self.pieces.initial(0.0, y)
        self._require(unique, 0.0)
        y, mode = self._settle(y, mode, settled)
        self.samples = empty_samples(self.window.sample_times)
        self._follow(self.window.keep, self.window.end, y, mode)
        return Trajectory(self.samples, self.tally, self.window.periods, dict(self.statistics))

    def _settle(self, y: np.ndarray, mode: Mode, settled: float | None) -> tuple[np.ndarray, Mode]:
        """Follow the pieces to the kept part of the window; it is moved to where the state repeats."""
        if settled is None:
            return self._follow(0.0, self.window.keep, y, mode)
        most, close = self.window.settle_periods, self.atol / (ABSOLUTE * self.rtol) * settled
        self.window = replace(self.window, settle_periods=0)
        for coarseness, last in ((COARSER, most - most // 4), (1.0, most)):
            self.rtol, self.atol = self.rtol * coarseness, self.atol * coarseness
            for periods in range(self.window.settle_periods + 1, last + 1):
                before, began = y, self.window.keep
                self.window = replace(self.window, settle_periods=periods)
                y, mode = self._follow(began, self.window.keep, y, mode)
                if np.all(np.abs(y - before) < close):
                    break
            self.rtol, self.atol = self.rtol / coarseness, self.atol / coarseness
        return y, mode

    def _follow(self, t: float, stop: float, y: np.ndarray, mode: Mode) -> tuple[np.ndarray, Mode]:
        """Follow the pieces from one time to another."""
        while t < stop:
            t, y, switch = self._piece(t, stop, y, mode)
            if switch >= 0:
                mode, y = self._switched(t, y, mode, switch)
        return y, mode

    def _piece(self, t: float, stop: float, y: np.ndarray, mode: Mode) -> tuple[float, np.ndarray, int]:
        """Follow one mode; the time and state where it ends, and the switch (-1 at ``stop``)."""
        if self.pieces.waits(mode):
            return self._wait(t, stop, y, mode)
        return self._slide(t, stop, y, mode)

    def _wait(self, t: float, stop: float, y: np.ndarray, mode: Mode) -> tuple[float, np.ndarray, int]:
        end, switch = self.pieces.release(t, stop, y, mode)
        self._require(switch != LOCKED, end)
        if t >= self.window.keep:
            self._sample(t, end, lambda times: np.outer(y, np.ones(times.size)), mode)
            self._add(np.array([t]), y[:, None], mode, np.array([end - t]))
        return end, y, switch

    def _slide(self, t: float, stop: float, y: np.ndarray, mode: Mode) -> tuple[float, np.ndarray, int]:
        ahead = self._switches_ahead(t, y, mode)
        for place in np.flatnonzero(ahead < 0.0).tolist():
            if not self._just_passed(place):
                return t, y, place  # it came at the same time as the switch before
        places = np.flatnonzero(np.isfinite(ahead)).tolist()
        rides = self.pieces.rides(mode)
        result = self._integrate(t, stop, y, mode, places, rides)
        if rides:
            dips.cut(result, lambda t: self.pieces.switches(t, result.sol(t), mode)[places])
        reached = [place for place, times in zip(places, result.t_events, strict=False) if times.size]
        if reached and result.t[-1] == t:
            self._shorten_first_step(t)
            return t, y, -1
        self._require(self.pieces.first_locked(result.t, result.y, mode) < 0, result.t[-1])
        if self.pieces.missed_switch(result.t, result.y, mode):
            message = f"a switch was missed between t = {t:.6g} s and {result.t[-1]:.6g} s"
            raise CaseError(message, "solver_failure")
        if result.t.size > 2:
            self.first_step = result.t[-2] - result.t[-3]
        if t >= self.window.keep:
            self._keep(result, mode)
        return result.t[-1], result.y[:, -1], reached[0] if reached else -1

    def _switches_ahead(self, t: float, y: np.ndarray, mode: Mode) -> np.ndarray:
        """Switches a moment later, when one that is passing zero has left the rounding behind."""
        moment = LOOK_AHEAD / self.window.omega
        # Half-way: where a run begins the rate itself is rounding.
        y = y + moment * self.pieces.rate(t + 0.5 * moment, y, mode)
        return self.pieces.switches(t + moment, y, mode)

    def _just_passed(self, place: int) -> bool:
        """Whether a switch belongs to the face, or the forces, that switched last: it begins at 0."""
        return place // 2 == self.last_switch // 2

    def _shorten_first_step(self, t: float) -> None:
        """Begin again where one step saw nothing of a short slip but its end."""
        self.first_step = (self.first_step or self.period) / SHORTER
        if self.first_step < SHORTEST * self.period:
            message = f"no progress at t = {t:.6g} s"
            raise CaseError(message, "solver_failure")

    def _integrate(
        self, t: float, stop: float, y: np.ndarray, mode: Mode, places: list[int], rides: bool
    ) -> Any:
        result = solve_ivp(
            self._rate(mode),
            (t, stop),
            y,
            method=SmallRadau if y.size == 2 else Radau,
            jac=lambda t, y: self.pieces.jacobian(t, y, mode),
            events=[*(self._event(t, mode, place) for place in places), _turn],
            dense_output=rides or t >= self.window.keep,
            rtol=self.rtol,
            atol=self.atol,
            max_step=self.period / (STEPS_RIDING if rides else STEPS_PER_PERIOD),
            first_step=min(self.first_step, stop - t) if self.first_step else None,
        )
        self._check(result)
        return result

    def _rate(self, mode: Mode) -> Callable[[float, np.ndarray], np.ndarray]:
        pieces, deadline = self.pieces, self.deadline

        def limited_rate(t: float, y: np.ndarray) -> np.ndarray:
            if perf_counter() > deadline:
                message = f"gave up after {self.time_limit:g} s at t = {t:.6g} s"
                raise CaseError(message, "time_limit")
            return pieces.rate(t, y, mode)

        return limited_rate

    def _event(self, start: float, mode: Mode, place: int) -> Callable[[float, np.ndarray], float]:
        pieces = self.pieces

        def event(t: float, y: np.ndarray) -> float:
            value = pieces.switches(t, y, mode)[place]
            # A switch that begins at zero may be negative there by rounding, which would hide its return.
            return max(value, 0.0) if t == start else value

        # scipy reads these two from the function.
        event.terminal, event.direction = True, -1  # type: ignore[attr-defined]
        return event

    def _switched(self, t: float, y: np.ndarray, mode: Mode, switch: int) -> tuple[Mode, np.ndarray]:
        self.statistics["switches"] += 1
        self.last_switch = switch
        if self.statistics["switches"] > SWITCHES_PER_PERIOD * (1.0 + t / self.period):
            message = f"more than {SWITCHES_PER_PERIOD} switches per period at t = {t:.6g} s"
            raise CaseError(message, "solver_failure")
        y = y.copy()
        mode, unique = self.pieces.successor(t, y, mode, switch)
        self._require(unique, t)
        return mode, y

    def _check(self, result: Any) -> None:
        self.statistics["rate_evaluations"] += result.nfev
        self.statistics["steps"] += result.t.size - 1
        if not np.isfinite(result.y).all():
            message = f"state not finite at t = {result.t[-1]:.6g} s"
            raise CaseError(message, "not_finite")
        if result.status < 0:
            message = f"{result.message} (at t = {result.t[-1]:.6g} s)"
            raise CaseError(message, "solver_failure")

    def _require(self, unique: bool, t: float) -> None:
        if not unique:
            message = f"normal forces not unique at t = {t:.6g} s: the wedge locks"
            raise CaseError(message, "locked")

    def _keep(self, result: Any, mode: Mode) -> None:
        half = 0.5 * np.diff(result.t)
        t = ((result.t[:-1] + half)[:, None] + half[:, None] * GAUSS_POINTS).ravel()
        self._add(t, result.sol(t), mode, np.outer(half, GAUSS_WEIGHTS).ravel())
        self._add(result.t[[0, -1]], result.y[:, [0, -1]], mode)
        self._add(result.t_events[-1], result.y_events[-1].reshape(-1, self.pieces.scale.size).T, mode)
        self._sample(result.t[0], result.t[-1], result.sol, mode)

    def _add(self, t: np.ndarray, y: np.ndarray, mode: Mode, weight: np.ndarray | None = None) -> None:
        weight = np.zeros(t.size) if weight is None else weight
        self.pieces.add(self.tally, t, y, weight, mode)

    def _sample(
        self,
        start: float,
        end: float,
        state: Callable[[np.ndarray], np.ndarray],
        mode: Mode,
    ) -> None:
        samples = self.samples
        here = slice(*np.searchsorted(samples.t, (start, end)))
        if here.start < here.stop:
            y = state(samples.t[here])
            samples.x[here], samples.velocity[here] = y[:2]
            samples.contact[here] = self.pieces.contacts(y, mode)
            samples.normal[:, here] = self.pieces.normal_forces(samples.t[here], y, mode)


def _turn(t: float, y: np.ndarray) -> float:
    """Zero where x is extreme."""
    return y[1]
