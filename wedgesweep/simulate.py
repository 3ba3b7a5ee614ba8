"""One case from its parameters to its numbers."""

from dataclasses import dataclass, field, replace
from importlib import import_module
from math import pi
from typing import Any

import numpy as np

from wedgesweep import response
from wedgesweep.response import Response
from wedgesweep.sampled_input import SampledInput, set_sampled
from wedgesweep.solvers.trajectory import Trajectory, TransientWindow, Window


@dataclass(frozen=True, eq=False)
class Transient:
    """A motion under an input that does not repeat, from t = 0 to ``span`` (s).

    ``sampled``: the input at scale 1; ``length``: what its motions are compared with (m; under a force N);
    ``omega`` (rad/s): the natural frequency or so; ``start``: state of the mass at scale 1 (m, m/s);
    ``samples``: how many are stored.
    """

    sampled: SampledInput
    length: float
    omega: float
    span: float
    samples: int
    start: tuple[float, float]

    def first(self, samples: int) -> "Transient":
        """The motion up to one of its samples."""
        return replace(self, samples=samples, span=self.span * samples / self.samples)


@dataclass(frozen=True)
class Settings:
    """How a case is run; either ``duration`` (s) or ``settle_periods`` is given, or it is ``steady``."""

    method: str = "radau"
    rtol: float = 1e-6
    duration: float | None = 1.5
    settle_periods: int | None = None
    kept_periods: int = 3
    samples_per_period: int = 256
    case_timeout: float = 60.0
    steady: bool = False
    steady_tolerance: float = 1e-7
    max_periods: int = 5000
    keep_waveforms: bool = True
    continuation: bool = False
    transient: Transient | None = field(default=None, compare=False)

    def window(self, omega: float) -> Window:
        """Time span of a case: whole forcing periods, at least one more than are kept.

        If ``steady`` the solver finds the settling time itself, and the one here is 0.
        """
        return Window(omega, int(self.settling(np.array(omega))), self.kept_periods, self.samples_per_period)

    def settling(self, omega: np.ndarray) -> np.ndarray:
        """Settling periods of many cases (see ``window``), of the shape of ``omega``."""
        if self.settle_periods or self.duration is None:
            return np.full(omega.shape, self.settle_periods or 0)
        # The paper's 1.5 s are cut to whole periods, so that phase 0 is phase 0 of the input.
        whole = np.floor(self.duration * omega / (2.0 * pi) * (1.0 + 1e-12)).astype(int)
        return np.maximum(whole - self.kept_periods, 1)


def trajectory(parameters: np.ndarray, settings: Settings) -> Trajectory:
    """Run one case; parameters as from systems.suspension.parameters.record. Raises CaseError."""
    window = settings.window(float(parameters["input"]["omega"][0]))
    return _solver(settings).solve(parameters, window, settings.rtol, settings.case_timeout)


def _solver(settings: Settings) -> Any:
    # Only the one that is asked for: scipy takes a quarter of a second to load.
    return import_module(f"wedgesweep.solvers.{settings.method.replace('-', '_')}")


def transient(parameters: np.ndarray, given: Transient, scale: float, settings: Settings) -> Trajectory:
    """Run a case under an input times ``scale``; parameters: a full record, shape (1,). Raises CaseError."""
    case = parameters.copy()
    set_sampled(case, given.sampled, scale * given.length, given.omega, given.span, scale)
    window = TransientWindow(given.omega, 0, 1, given.samples, given.span)
    start = (scale * given.start[0], scale * given.start[1])
    return _solver(settings).solve(case, window, settings.rtol, settings.case_timeout, start)


def respond(parameters: np.ndarray, settings: Settings, harmonics: int) -> tuple[Response, dict[str, int]]:
    """Run one case to its response and the solver's statistics. Raises CaseError."""
    run = trajectory(parameters, settings)
    return response.evaluate(run, parameters, harmonics), run.statistics
