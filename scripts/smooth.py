"""The suspension for general ODE libraries: one right-hand side without events, in numba and in jax.

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
MODE = ContactMode(1, 1, 1, 1, 1, 0, 0, 0)
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


@compiled
def rate_into(t, y, rates, parameters):
    """Derivative of the scaled state, as CVODE asks for it."""
    rate(t, y, rates, parameters[0])


@numba.cfunc(
    numba.types.void(numba.float64, Pointer, Pointer, numba.types.CPointer(numba.from_dtype(RECORD))),
    error_model="numpy",
)
def rate_at(t, y, rates, parameters):
    """Derivative of the scaled state at addresses, as numbalsoda asks for it."""
    rate(t, y, rates, numba.carray(parameters, 1)[0])


def jax_rate(t, y, p):
    """The same in jax; ``p`` is a dict of numbers."""
    from jax import numpy as jnp

    size = p["amplitude"] * p["omega"]
    x, velocity = p["amplitude"] * y[0], size * y[1]
    base = -size * p["omega"] * jnp.sin(p["omega"] * t)
    weight = p["gravity"] + base
    z, r = p["rest"] + x, p["column_ratio"]
    wedge = p["wedge_preload"] - p["wedge_spring"] * r * p["cos_column"] * z - p["wedge_mass"] * weight
    vertical = -p["bolster_spring"] * z - p["bolster_mass"] * weight
    into = wedge * p["sin_column"]
    # Newton's equations of newton.reactions for the four pairs of signs at once.
    column_sign, bolster_sign = jnp.array([1.0, 1.0, -1.0, -1.0]), jnp.array([1.0, -1.0, 1.0, -1.0])
    column_mu = column_sign * _jax_coefficient(r * velocity, p)
    bolster_mu = bolster_sign * _jax_coefficient(p["bolster_ratio"] * velocity, p)
    lift = p["sin_wedge"] + bolster_mu * p["cos_wedge"]
    normal = p["cos_included"] - bolster_mu * p["sin_included"]
    inertia = p["wedge_mass"] * r / p["bolster_mass"]
    determinant = p["sin_included"] + bolster_mu * p["cos_included"] + column_mu * normal
    determinant += 2.0 * inertia * lift
    bolster = (wedge * p["cos_column"] - column_mu * into - inertia * vertical) / determinant
    column = into + bolster * normal
    consistent = (column_sign * column > 0.0) & (bolster_sign * bolster > 0.0)
    acceleration = ((vertical + 2.0 * bolster * lift) / p["bolster_mass"])[jnp.argmax(consistent)]
    return jnp.stack([p["omega"] * y[1], acceleration / size])


def _jax_coefficient(velocity, p):
    from jax import numpy as jnp

    scaled = velocity / p["v_t"]
    speed = jnp.maximum(jnp.abs(scaled), 1.0)
    falls = p["law"] == friction.code("exponential")
    sliding = p["mu_d"] * jnp.sign(velocity) * jnp.where(falls, speed ** p["exponent"], 1.0)
    regular = jnp.where(jnp.abs(scaled) <= 1.0, p["mu_s"] * scaled, sliding)
    return jnp.where(p["set_valued"] > 0.0, p["mu_d"] * jnp.tanh(velocity / SMOOTHING), regular)
