"""scipy's Radau, piece by piece: it never steps across a corner of the friction law.

Each piece runs with one contact until one of its switches reaches zero. The right-hand side and its
Jacobian are compiled; what remains is scipy's.
"""

from collections import Counter
from collections.abc import Callable
from math import pi
from time import perf_counter
from typing import Any

import numpy as np
from scipy.integrate import Radau, solve_ivp

from wedgesweep import contact as contacts
from wedgesweep import excitation, tally
from wedgesweep.compiled import compiled
from wedgesweep.damper import Contact, stiffness_and_damping
from wedgesweep.solvers.sticking import LOCKED, release
from wedgesweep.solvers.trajectory import CaseError, Samples, Trajectory, Window

# Absolute tolerances, as a share of rtol times input amplitude and input velocity: motions far smaller
# than the input, as they occur near breakaway, are resolved as well.
ABSOLUTE = 1e-2
# A step this long cannot hold a stop and the start after it.
STEPS_PER_PERIOD = 16
SWITCHES_PER_PERIOD = 1000
# When a piece ends where it began, its first step is made shorter, down to this share of a period.
SHORTER, SHORTEST = 10.0, 1e-13
GAUSS_POINTS, GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(4)


@compiled
def rate(t, y, contact, parameters):
    """Derivative of the state (x, x'), shape (2,)."""
    p = parameters[0]
    now = contacts.acting(y[0], y[1], excitation.acceleration(t, p), contact, p)
    return np.array([y[1], now.acceleration])


@compiled
def jacobian(t, y, contact, parameters):
    """Derivative of ``rate`` with respect to the state, shape (2, 2)."""
    p = parameters[0]
    base_acceleration = excitation.acceleration(t, p)
    by_x = by_velocity = 0.0
    if not contacts.held(contact):
        by_x, by_velocity = stiffness_and_damping(y[0], y[1], base_acceleration, contact, p)
    return np.array([[0.0, 1.0], [by_x, by_velocity]])


@compiled
def switch_value(t, y, contact, place, parameters):
    """One switching function."""
    out = np.empty(contacts.SWITCHES)
    contacts.switches(t, y[0], y[1], contact, parameters[0], out)
    return out[place]


@compiled
def switch_values(t, y, contact, parameters):
    """All switching functions at a state, shape (SWITCHES,); inf for those a contact does not have."""
    out = np.empty(contacts.SWITCHES)
    contacts.switches(t, y[0], y[1], contact, parameters[0], out)
    return out


@compiled
def first_locked(t, y, contact, parameters):
    """Index of the first of the states, shape (2, n), at which the wedge locks; -1 if none."""
    for i in range(t.size):
        if not contacts.unique(t[i], y[0, i], y[1, i], contact, parameters[0]):
            return i
    return -1


@compiled
def missed_switch(t, y, contact, parameters):
    """Whether a switch is negative at any of the states but the ends."""
    out = np.empty(contacts.SWITCHES)
    for i in range(1, t.size - 1):
        contacts.switches(t[i], y[0, i], y[1, i], contact, parameters[0], out)
        if out.min() < 0.0:
            return True
    return False


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

    Raises
    ------
    CaseError
        If the wedge locks, the time limit passes or the integrator fails.
    """
    return _Run(parameters, window, rtol, time_limit).trajectory(start)


class _Run:
    """One case on its way: the current state, and what is kept so far."""

    def __init__(self, parameters: np.ndarray, window: Window, rtol: float, time_limit: float) -> None:
        self.parameters, self.window, self.rtol = parameters, window, rtol
        self.p = parameters[0]
        self.deadline = perf_counter() + time_limit
        self.time_limit = time_limit
        self.period = 2.0 * pi / window.omega
        velocity = self.p["amplitude"] * window.omega
        self.atol = ABSOLUTE * rtol * np.array([self.p["amplitude"], velocity])
        self.statistics: Counter[str] = Counter(rate_evaluations=0, steps=0, switches=0)
        times = window.sample_times
        self.samples = Samples(
            times, np.empty(times.size), np.empty(times.size), np.empty((times.size, 5), np.int8)
        )
        self.tally = tally.empty()
        self.first_step: float | None = None
        self.last_switch = -1

    def trajectory(self, start: tuple[float, float]) -> Trajectory:
        """Follow the pieces to the end of the window."""
        t, y = 0.0, np.array(start)
        contact, unique = contacts.initial(t, *start, self.p)
        self._require(unique, t)
        for stop in (self.window.keep, self.window.end):
            while t < stop:
                t, y, switch = self._piece(t, stop, y, contact)
                if switch >= 0:
                    contact, y = self._switched(t, y, contact, switch)
        return Trajectory(self.samples, self.tally, self.window.periods, dict(self.statistics))

    def _piece(self, t: float, stop: float, y: np.ndarray, contact: Contact) -> tuple[float, np.ndarray, int]:
        """Follow one contact; the time and state where it ends, and the switch (-1 at ``stop``)."""
        if contacts.stuck(contact, self.p):
            return self._wait(t, stop, y, contact)
        return self._slide(t, stop, y, contact)

    def _wait(self, t: float, stop: float, y: np.ndarray, contact: Contact) -> tuple[float, np.ndarray, int]:
        end, switch = release(t, stop, y[0], contact, self.parameters)
        self._require(switch != LOCKED, end)
        if t >= self.window.keep:
            self._sample(t, end, lambda times: np.outer(y, np.ones(times.size)), contact)
            self._add(np.array([t]), y[:, None], contact, np.array([end - t]))
        return end, y, switch

    def _slide(self, t: float, stop: float, y: np.ndarray, contact: Contact) -> tuple[float, np.ndarray, int]:
        ahead = self._switches_ahead(t, y, contact)
        for place in np.flatnonzero(ahead < 0.0).tolist():
            if not self._just_passed(place):
                return t, y, place  # it came at the same time as the switch before
        places = np.flatnonzero(np.isfinite(ahead)).tolist()
        result = self._integrate(t, stop, y, contact, places)
        reached = [place for place, times in zip(places, result.t_events, strict=False) if times.size]
        if reached and result.t[-1] == t and self._just_passed(reached[0]):
            self._shorten_first_step(t)
            return t, y, -1
        self._require(first_locked(result.t, result.y, contact, self.parameters) < 0, result.t[-1])
        if missed_switch(result.t, result.y, contact, self.parameters):
            message = f"a switch was missed between t = {t:.6g} s and {result.t[-1]:.6g} s"
            raise CaseError(message, "solver_failure")
        if result.t.size > 2:
            self.first_step = result.t[-2] - result.t[-3]
        if t >= self.window.keep:
            self._keep(result, contact)
        return result.t[-1], result.y[:, -1], reached[0] if reached else -1

    def _switches_ahead(self, t: float, y: np.ndarray, contact: Contact) -> np.ndarray:
        """Switches a moment later, when one that is passing zero has left the rounding behind."""
        moment = contacts.LOOK_AHEAD / self.window.omega
        y = y + moment * rate(t, y, contact, self.parameters)
        return switch_values(t + moment, y, contact, self.parameters)

    def _just_passed(self, place: int) -> bool:
        """Whether a switch belongs to the face, or the forces, that switched last: it begins at 0."""
        return place // 2 == self.last_switch // 2

    def _shorten_first_step(self, t: float) -> None:
        """Begin again where one step saw nothing of a short slip but its end."""
        self.first_step = (self.first_step or self.period) / SHORTER
        if self.first_step < SHORTEST * self.period:
            message = f"no progress at t = {t:.6g} s"
            raise CaseError(message, "solver_failure")

    def _integrate(self, t: float, stop: float, y: np.ndarray, contact: Contact, places: list[int]) -> Any:
        result = solve_ivp(
            self._rate(contact),
            (t, stop),
            y,
            method=SmallRadau,
            jac=lambda t, y: jacobian(t, y, contact, self.parameters),
            events=[*(self._event(t, contact, place) for place in places), _turn],
            dense_output=t >= self.window.keep,
            rtol=self.rtol,
            atol=self.atol,
            max_step=self.period / STEPS_PER_PERIOD,
            first_step=min(self.first_step, stop - t) if self.first_step else None,
        )
        self._check(result)
        return result

    def _rate(self, contact: Contact) -> Callable[[float, np.ndarray], np.ndarray]:
        parameters, deadline = self.parameters, self.deadline

        def limited_rate(t: float, y: np.ndarray) -> np.ndarray:
            if perf_counter() > deadline:
                message = f"gave up after {self.time_limit:g} s at t = {t:.6g} s"
                raise CaseError(message, "time_limit")
            return rate(t, y, contact, parameters)

        return limited_rate

    def _event(self, start: float, contact: Contact, place: int) -> Callable[[float, np.ndarray], float]:
        parameters = self.parameters

        def event(t: float, y: np.ndarray) -> float:
            value = switch_value(t, y, contact, place, parameters)
            # A switch that begins at zero may be negative there by rounding, which would hide its return.
            return max(value, 0.0) if t == start else value

        # scipy reads these two from the function.
        event.terminal, event.direction = True, -1  # type: ignore[attr-defined]
        return event

    def _switched(self, t: float, y: np.ndarray, contact: Contact, switch: int) -> tuple[Contact, np.ndarray]:
        self.statistics["switches"] += 1
        self.last_switch = switch
        if self.statistics["switches"] > SWITCHES_PER_PERIOD * (1.0 + t / self.period):
            message = f"more than {SWITCHES_PER_PERIOD} switches per period at t = {t:.6g} s"
            raise CaseError(message, "solver_failure")
        if self.p["set_valued"] and switch < contacts.COLUMN_NORMAL:
            y = np.array([y[0], 0.0])
        contact, unique = contacts.successor(t, y[0], y[1], contact, switch, self.p)
        self._require(unique, t)
        return contact, y

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

    def _keep(self, result: Any, contact: Contact) -> None:
        half = 0.5 * np.diff(result.t)
        t = ((result.t[:-1] + half)[:, None] + half[:, None] * GAUSS_POINTS).ravel()
        self._add(t, result.sol(t), contact, np.outer(half, GAUSS_WEIGHTS).ravel())
        self._add(result.t[[0, -1]], result.y[:, [0, -1]], contact)
        self._add(result.t_events[-1], result.y_events[-1].reshape(-1, 2).T, contact)
        self._sample(result.t[0], result.t[-1], result.sol, contact)

    def _add(self, t: np.ndarray, y: np.ndarray, contact: Contact, weight: np.ndarray | None = None) -> None:
        weight = np.zeros(t.size) if weight is None else weight
        tally.add_all(self.tally, t, y[0], y[1], weight, contact, self.parameters)

    def _sample(
        self,
        start: float,
        end: float,
        state: Callable[[np.ndarray], np.ndarray],
        contact: Contact,
    ) -> None:
        samples = self.samples
        here = slice(*np.searchsorted(samples.t, (start, end)))
        if here.start < here.stop:
            samples.x[here], samples.velocity[here] = state(samples.t[here])
            samples.contact[here] = contact


def _turn(t: float, y: np.ndarray) -> float:
    """Zero where x is extreme."""
    return y[1]
