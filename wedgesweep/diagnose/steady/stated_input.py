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

from dataclasses import replace
from math import sqrt
from typing import TYPE_CHECKING

import numpy as np

from wedgesweep.diagnose.evaluation import Evaluation, Scenario
from wedgesweep.diagnose.fit_parameters import Values
from wedgesweep.diagnose.model import TIGHT
from wedgesweep.effects import merge
from wedgesweep.uncertain import DISTORTION, harmonic_of, with_harmonic

if TYPE_CHECKING:
    from wedgesweep.diagnose.steady.harmonic_data import HarmonicData

# Orders of the harmonics that inputs have.
ORDERS = {"second": 2, "third": 3}
# The finite-difference step of a harmonic of an input is the standard deviation of its real part, but at
# least this share of the fundamental over its order: the error of simulations would hide smaller steps.
LEAST_STEP = 1e-4


def covariance(data: "HarmonicData", scenario: Scenario) -> np.ndarray:
    """Of residuals over the noise of the responses, (T, m, m), by the response in a scenario."""
    here = data.compare([scenario], TIGHT)[0]
    point = replace(scenario.point, warm=here.warm)
    pulls = here.residual[:, :0], np.zeros(0)
    evaluation = Evaluation(point, here.response, here.residual, *pulls, here.found)
    columns: list[np.ndarray] = []
    for name in ORDERS:
        for turn in (1.0, 1j):
            columns += _changes_by(data, name, turn, scenario.values, evaluation)
    passed_on = np.stack(columns, axis=-1)
    return np.eye(passed_on.shape[1]) + passed_on @ np.swapaxes(passed_on, 1, 2)


def _changes_by(
    data: "HarmonicData", name: str, turn: complex, values: Values, here: Evaluation
) -> tuple[np.ndarray, np.ndarray]:
    """Columns k and sqrt(3) q, (T, m) each, of one part of a harmonic of the input.

    ``turn``: 1 for the real part, 1j for the imaginary one.
    """
    std = sqrt(0.5) * data.harmonics_std
    step = max(std, LEAST_STEP / ORDERS[name])
    moved = [Scenario(distorted(data, values, name, sign * turn * step), here.point) for sign in (1.0, -1.0)]
    (above, below), found = data.bare().changes(here, moved, TIGHT)
    size, known = std / step, (found[0] & found[1])[:, None]
    linear, quadratic = 0.5 * size * (above - below), 0.5 * size**2 * (above + below)
    return np.where(known, linear, 0.0), np.where(known, sqrt(3.0) * quadratic, 0.0)


def distorted(data: "HarmonicData", values: Values, name: str, change: complex) -> Values:
    """Values of effects (SI) with a change of one harmonic of the input."""
    own = merge(data.model.effects, values).get(DISTORTION, {})
    return {**values, DISTORTION: with_harmonic(own, name, harmonic_of(own, name) + change)}
