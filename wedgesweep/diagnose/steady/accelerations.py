"""Acceleration that the model predicts in the states of a given motion."""

from math import pi

from wedgesweep import contact as contacts
from wedgesweep import excitation
from wedgesweep.compiled import compiled
from wedgesweep.damper import Contact


@compiled
def accelerations(parameters, x, v, out):
    """Write z'' (m/s^2) in the states x (m) and v (m/s) on an even grid over one period from phase 0.

    ``parameters``: a record of shape (1,); a bolster that friction holds has none.
    """
    p = parameters[0]
    for i in range(x.size):
        t = 2.0 * pi / p.omega * i / x.size
        contact, _ = contacts.initial(t, x[i], v[i], p)
        base = excitation.acceleration(t, p)
        if contacts.stuck(contact, p):
            out[i] = 0.0
        else:
            out[i] = contacts.acting(x[i], v[i], base, Contact(*contact), p).acceleration
