"""Config names of the solvers."""

SOLVERS = ("radau", "event-driven")
