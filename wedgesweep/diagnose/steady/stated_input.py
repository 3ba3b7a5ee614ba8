"""Steady harmonics under inputs that are stated as sines, and whose harmonics are known to some percent.

A shaker distorts. Each stated harmonic of the input is a complex number over the fundamental: zero, with a
standard deviation of its magnitude that a laboratory knows; real and imaginary part have that over sqrt(2).
It differs from test to test. Where a harmonic meets a resonance, friction does not pass it on in proportion.
So with s the standard deviation of a part, a part u changes the residual by

    k u / s + q (u / s)^2

where k and q are half the difference and half the sum of the changes by u = s and u = -s. The residual then
has the second moments (as E u^4 = 3 s^4)

    I + sum (k k^T + 3 q q^T)

over all parts, in units of the responses' own noise and of the model error. Products of different parts are
left out. The directions k and q turn with the start phase of a record, and are those at the best phase of the
explanation that the covariance was taken at.
"""

from dataclasses import dataclass, fields, replace
from functools import cached_property
from math import sqrt

import numpy as np

from wedgesweep.diagnose.evaluation import Evaluation, Scenario
from wedgesweep.diagnose.fit_parameters import Values
from wedgesweep.diagnose.model import TIGHT
from wedgesweep.diagnose.steady.harmonic_data import HarmonicData, stated
from wedgesweep.diagnose.steady.whitened import real
from wedgesweep.effects import merge
from wedgesweep.uncertain import DISTORTION, harmonic_of, with_harmonic

# Orders of the harmonics that inputs have.
ORDERS = {"second": 2, "third": 3}
# The finite-difference step of a harmonic is the standard deviation of its real part, but at least this over
# its order: the error of simulations would hide smaller steps.
LEAST_STEP = 1e-4
# Newton steps from the best start phase without a covariance, and in rad their largest length and a
# negligible one.
NEWTON_STEPS, NEWTON_LENGTH, NEGLIGIBLE = 12, 0.05, 1e-7


@dataclass(frozen=True)
class StatedInputData(HarmonicData):
    """Harmonics of steady tests whose inputs are stated; ``harmonics_std``: of those of the input."""

    harmonics_std: float = 0.0

    def covariance(self, scenario: Scenario) -> np.ndarray:
        here = self.compare([scenario], TIGHT)[0]
        point = replace(scenario.point, warm=here.warm)
        evaluation = Evaluation(point, here.response, here.residual, np.zeros(0), here.found, 0)
        columns: list[np.ndarray] = []
        for name in ORDERS:
            for turn in (1.0, 1j):
                columns += self._changes_by(name, turn, scenario.values, evaluation)
        passed_on = np.stack(columns, axis=-1)
        return np.eye(passed_on.shape[1]) + passed_on @ np.swapaxes(passed_on, 1, 2)

    def _changes_by(
        self, name: str, turn: complex, values: Values, here: Evaluation
    ) -> tuple[np.ndarray, np.ndarray]:
        """Columns k and sqrt(3) q, (T, m) each, of one part of a harmonic of the input.

        ``turn``: 1 for the real part, 1j for the imaginary one.
        """
        std = sqrt(0.5) * self.harmonics_std
        step = max(std, LEAST_STEP / ORDERS[name])
        moved = [
            Scenario(self._distorted(values, name, sign * turn * step), here.point) for sign in (1.0, -1.0)
        ]
        (above, below), found = self.bare().changes(here, moved, TIGHT)
        size, known = std / step, (found[0] & found[1])[:, None]
        linear, quadratic = 0.5 * size * (above - below), 0.5 * size**2 * (above + below)
        return np.where(known, linear, 0.0), np.where(known, sqrt(3.0) * quadratic, 0.0)

    def _distorted(self, values: Values, name: str, change: complex) -> Values:
        """Values of effects (SI) with a change of one harmonic of the input."""
        own = merge(self.model.effects, values).get(DISTORTION, {})
        return {**values, DISTORTION: with_harmonic(own, name, harmonic_of(own, name) + change)}

    @cached_property
    def _precision(self) -> np.ndarray:
        """Inverse of the covariance, (T, m, m)."""
        assert self.whitening is not None
        return self.whitening @ self.whitening

    def start_phase(self, simulated: np.ndarray, other: np.ndarray | float = 0.0) -> np.ndarray:
        """The phase of the least misfit under the covariance, by Newton's method."""
        phase = super().start_phase(simulated, other)
        if self.whitening is None:
            return phase
        orders = self.turning_orders
        for _ in range(NEWTON_STEPS):
            turned = self.rotated(simulated, phase)
            left, slope = real(self.whitened - other - turned), real(-1j * orders * turned)
            weighted = self._weighted(slope)
            gauss = (weighted * slope).sum(-1)
            bend = gauss + (self._weighted(left) * real(orders**2 * turned)).sum(-1)
            # Far from the minimum the misfit may bend the other way.
            bend = np.where(bend > 0.0, bend, gauss)
            step = np.divide(-(weighted * left).sum(-1), bend, out=np.zeros_like(bend), where=bend > 0.0)
            step = np.clip(step, -NEWTON_LENGTH, NEWTON_LENGTH)
            phase = phase + step
            if np.abs(step).max(initial=0.0) < NEGLIGIBLE:
                break
        return phase

    def _weighted(self, values: np.ndarray) -> np.ndarray:
        """Real vectors (..., T, m) times the inverse of the covariance."""
        return (self._precision @ values[..., None])[..., 0]


def with_uncertain_harmonics(data: HarmonicData, std: float) -> HarmonicData:
    """The data of inputs whose harmonics have a relative standard deviation; 0: of exact sines."""
    if std == 0.0:
        return data
    own = {each.name: getattr(data, each.name) for each in fields(data)}
    found = StatedInputData(**own, harmonics_std=std)
    return found.with_covariance(stated(found))
