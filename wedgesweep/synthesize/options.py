"""How measured data are made from a config and a plan of tests."""

from dataclasses import dataclass

# Kinds of noise, and recorded quantities.
NOISES = ("white", "ar1", "adc", "differentiated")
FORCE = "force"
QUANTITIES = ("displacement", "velocity", "acceleration", FORCE)


@dataclass(frozen=True)
class Options:
    """How the data are made; ``level``, ``input_level`` and ``amplitude_error`` are relative std.

    ``normal_force``: std (N) of the zero of the load cell that records the load of a column in steady tests;
    None if there is none.
    ``record_input``: quantity of the input that is recorded; its amplitude is then not stated.

    If ``sampling_hz`` is None, each test has a different rate, which does not divide the period: near 2 kHz
    for a rig like the bench.
    """

    noise: str = "white"
    level: float = 0.04
    seed: int = 0
    periods: float = 8.4
    sampling_hz: float | None = None
    settle_periods: int = 60
    amplitude_error: float = 1e-3
    record_input: str | None = None
    input_level: float = 0.01
    normal_force: float | None = None
