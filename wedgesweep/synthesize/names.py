"""Names of the kinds of noise, for the command line, which reads them before anything heavy is loaded."""

NOISES = ("white", "ar1", "adc", "differentiated")
