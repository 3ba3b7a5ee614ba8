"""Friction laws: the signed coefficient of a face as a function of its slip velocity.

A law is a file with three smooth branches, -1, 0 and 1: sliding backward, the branch around v = 0, and
sliding forward. Which branch holds is decided outside (contact.py), so that no integrator ever steps
across a corner. Under a set-valued law branch 0 means stuck, and no coefficient is defined there.
"""

from wedgesweep.compiled import compiled, inlined
from wedgesweep.friction import coulomb, exponential, static_dynamic
from wedgesweep.friction.names import LAW_NAMES

LAWS = dict(zip(LAW_NAMES, (coulomb, static_dynamic, exponential), strict=True))


@inlined
def coefficient(velocity, branch, p):
    """Signed coefficient of friction of the case's law; velocity in m/s."""
    if p.law == 0:
        return coulomb.coefficient(velocity, branch, p)
    if p.law == 1:
        return static_dynamic.coefficient(velocity, branch, p)
    return exponential.coefficient(velocity, branch, p)


@compiled
def slope(velocity, branch, p):
    """Derivative of ``coefficient`` with respect to velocity (s/m)."""
    if p.law == 0:
        return coulomb.slope(velocity, branch, p)
    if p.law == 1:
        return static_dynamic.slope(velocity, branch, p)
    return exponential.slope(velocity, branch, p)


@compiled
def branch_at(velocity, p):
    """Branch that holds at a slip velocity; 0 within the threshold, or at rest if set-valued."""
    threshold = 0.0 if p.set_valued else p.threshold_velocity
    if velocity > threshold:
        return 1
    return -1 if velocity < -threshold else 0
