"""The restoring torque of a pendulum, k sin(x) with k = m g l, in place of that of a spring, k x."""

from math import sin

from wedgesweep.compiled import inlined

NAME = "pendulum"
# The part of a record: k (N m/rad), 0 for a spring.
NUMBERS = ("stiffness",)


@inlined
def force_on_mass(z, velocity, y, p):
    """What a sine has beside a straight line (N m), at an angle z (rad)."""
    return p.pendulum.stiffness * (z - sin(z))
