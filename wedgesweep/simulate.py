"""One case from its parameters to its numbers."""

from dataclasses import dataclass
from importlib import import_module
from math import pi

import numpy as np

from wedgesweep import response
from wedgesweep.response import Response
from wedgesweep.solvers.trajectory import Trajectory, Window


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
    # Only the one that is asked for: scipy takes a quarter of a second to load.
    solver = import_module(f"wedgesweep.solvers.{settings.method.replace('-', '_')}")
    return solver.solve(parameters, window, settings.rtol, settings.case_timeout)


def respond(parameters: np.ndarray, settings: Settings, harmonics: int) -> tuple[Response, dict[str, int]]:
    """Run one case to its response and the solver's statistics. Raises CaseError."""
    run = trajectory(parameters, settings)
    return response.evaluate(run, parameters, harmonics), run.statistics
