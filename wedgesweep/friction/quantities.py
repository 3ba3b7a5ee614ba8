"""Numbers of the friction laws that a config may set."""

from wedgesweep.quantity import Quantity

FRICTION = (
    Quantity("dynamic", 0.29, "coefficient of dynamic friction, mu_d", minimum=0.0),
    Quantity("static", 0.32, "coefficient of static friction, mu_s", minimum=0.0),
    Quantity("threshold_velocity_mm_per_s", 1.0, "end of the sticking branch, v_t", above=0.0),
    Quantity(
        "velocity_exponent",
        -0.1,
        "decay of the exponential law above v_t",
        minimum=-1.0,
        maximum=1.0,
    ),
    Quantity(
        "velocity_unit_mm_per_s",
        1.0,
        "velocity at which the exponential law's decay begins at mu_d",
        above=0.0,
    ),
)
# Names of the same numbers in parameter records.
SYMBOLS = {
    **{"dynamic": "mu_d", "static": "mu_s", "threshold_velocity": "v_t"},
    **{"velocity_exponent": "exponent", "velocity_unit": "unit"},
}
