"""Coulomb's law (the paper's Eq. 1), set-valued at rest.

mu = mu_d sign(v)             for v != 0
mu in [-mu_d, mu_d]           for v = 0: the face sticks, see contact.py
"""

from wedgesweep.compiled import compiled, inlined

SET_VALUED = True


@inlined
def coefficient(velocity, branch, p):
    """Signed coefficient of friction on slip branch -1 or 1."""
    return branch * p.dynamic


@compiled
def slope(velocity, branch, p):
    """Derivative of ``coefficient`` with respect to the slip velocity (s/m)."""
    return 0.0
