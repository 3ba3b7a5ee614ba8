"""The suspension for general ODE libraries: one right-hand side without events, in numba and in jax.

The state is (x / a, x' / (a omega)), so that one absolute tolerance fits both. Coulomb is smoothed to
tanh(v / 0.02 mm/s); the regularised laws are as they stand. Friction acts with |N|: near the resonance
normal forces change their sign.
"""

from math import sin, tanh

import numba
import numpy as np
from workload import SMOOTHING

from wedgesweep import friction
from wedgesweep.damper import loads, reactions
from wedgesweep.parameters import RECORD

Pointer = numba.types.CPointer(numba.float64)
compiled = numba.njit(error_model="numpy")


@compiled
def _coefficient(velocity, p):
    if p.set_valued:
        return p.dynamic * tanh(velocity / SMOOTHING)
    return friction.coefficient(velocity, friction.branch_at(velocity, p), p)


@compiled
def _acceleration(t, x, velocity, p):
    base = -p.amplitude * p.omega**2 * sin(p.omega * t)
    along, into, vertical = loads(x, velocity, base, 0, p)
    column_mu = _coefficient(p.column_ratio * velocity, p)
    bolster_mu = _coefficient(p.bolster_ratio * velocity, p)
    now = reactions(along, into, vertical, column_mu, bolster_mu, p)
    for column, bolster in ((1, -1), (-1, 1), (-1, -1)):
        if now.column > 0.0 and now.bolster > 0.0:
            break
        other = reactions(along, into, vertical, column * column_mu, bolster * bolster_mu, p)
        if column * other.column > 0.0 and bolster * other.bolster > 0.0:
            return other.acceleration
    return now.acceleration


@compiled
def rate(t, y, rates, p):
    """Write the derivative of the scaled state."""
    size = p.amplitude * p.omega
    rates[0] = p.omega * y[1]
    rates[1] = _acceleration(t, p.amplitude * y[0], size * y[1], p) / size


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
    # Newton's equations of damper.reactions for the four pairs of signs at once.
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

    scaled = velocity / p["threshold_velocity"]
    speed = jnp.maximum(jnp.abs(scaled), 1.0)
    sliding = (
        p["dynamic"] * jnp.sign(velocity) * jnp.where(p["law"] == 2.0, speed ** p["velocity_exponent"], 1.0)
    )
    regular = jnp.where(jnp.abs(scaled) <= 1.0, p["static"] * scaled, sliding)
    return jnp.where(p["set_valued"] > 0.0, p["dynamic"] * jnp.tanh(velocity / SMOOTHING), regular)
