"""Names of the kinds of noise, apart from their code so that the command line starts fast."""

NOISES = ("white", "ar1", "adc", "differentiated")
