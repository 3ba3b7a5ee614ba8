"""Config names of the friction laws; a law's place in this tuple is its code in compiled code."""

LAW_NAMES = ("coulomb", "static-dynamic", "exponential")
# Laws that only oscillators have.
OSCILLATOR_LAWS = ("hyperbolic", "lugre")
