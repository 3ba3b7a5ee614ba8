"""Config names of the friction laws; a law's place in ``friction.LAWS`` is its code in parameter records."""

LAW_NAMES = ("coulomb", "static-dynamic", "exponential")
# Laws that only oscillators have.
OSCILLATOR_LAWS = ("hyperbolic", "lugre")
