"""The suspension for general ODE libraries: one right-hand side without events.

The state is (x / a, x' / (a omega)), so that one absolute tolerance fits both. Coulomb is smoothed to
tanh(v / 0.02 mm/s); the regularised laws are as they stand. Friction acts with |N|: near the resonance
normal forces change their sign.
"""

from math import tanh

import numba
import numpy as np
from workload import SMOOTHING

from wedgesweep import friction
from wedgesweep.systems import compact
from wedgesweep.systems.suspension import parameters
from wedgesweep.systems.suspension.modes import ContactMode
from wedgesweep.systems.suspension.newton import Coefficients, loads, reactions

Pointer = numba.types.CPointer(numba.float64)
RECORD = compact(parameters.record("coulomb", 1.0, 1.0)).dtype
# Nothing but friction depends on the mode here.
MODE = ContactMode(1, 1, 1, 0, 1, 1, 0, 0)
compiled = numba.njit(error_model="numpy")


@compiled
def _coefficient(velocity, p):
    if p.friction.set_valued:
        return p.friction.mu_d * tanh(velocity / SMOOTHING)
    return friction.coefficient(velocity, friction.branch_at(velocity, p), p.friction.mu_s, p)


@compiled
def _acceleration(t, x, velocity, p):
    load = loads(t, (x, velocity), MODE, p)
    column_mu = _coefficient(p.geometry.column_ratio * velocity, p)
    bolster_mu = _coefficient(p.geometry.bolster_ratio * velocity, p)
    now = reactions(load, Coefficients(column_mu, bolster_mu, 0.0, 0.0), p)[0]
    for column, bolster in ((1, -1), (-1, 1), (-1, -1)):
        if now.column > 0.0 and now.bolster > 0.0:
            break
        other = reactions(load, Coefficients(column * column_mu, bolster * bolster_mu, 0.0, 0.0), p)[0]
        if column * other.column > 0.0 and bolster * other.bolster > 0.0:
            return other.acceleration
    return now.acceleration


@compiled
def rate(t, y, rates, p):
    """Write the derivative of the scaled state."""
    amplitude, omega = p.input.amplitude, p.input.omega
    size = amplitude * omega
    rates[0] = omega * y[1]
    rates[1] = _acceleration(t, amplitude * y[0], size * y[1], p) / size


@compiled
def rate_of(t, y, parameters):
    """Derivative of the scaled state, as scipy asks for it."""
    rates = np.empty(2)
    rate(t, y, rates, parameters[0])
    return rates


@numba.cfunc(
    numba.types.void(numba.float64, Pointer, Pointer, numba.types.CPointer(numba.from_dtype(RECORD))),
    error_model="numpy",
)
def rate_at(t, y, rates, parameters):
    """Derivative of the scaled state at addresses, as numbalsoda asks for it."""
    rate(t, y, rates, numba.carray(parameters, 1)[0])
