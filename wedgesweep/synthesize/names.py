"""Names of the kinds of noise and of recorded inputs: apart from their code, for a fast start."""

NOISES = ("white", "ar1", "adc", "differentiated")
FORCE = "force"
QUANTITIES = ("displacement", "velocity", "acceleration", FORCE)
