"""Properties of a config's model that figures refer to."""

from math import nan
from typing import Any

import numpy as np

from wedgesweep.config.cases import LAW, SAMPLE, Case
from wedgesweep.config.model import Config
from wedgesweep.effects.base import OSCILLATOR
from wedgesweep.systems import has_own_mechanics
from wedgesweep.systems.oscillator import parameters as oscillator
from wedgesweep.systems.suspension.equilibrium import resonance
from wedgesweep.systems.suspension.rest import breakaway_accelerations

# Variables of the dataset, and what Coulomb's law does at them.
BREAKAWAY = {"breakaway_min": "allows", "breakaway_max": "enforces"}


def physics(config: Config) -> dict[str, float]:
    """Frequencies (rad/s), breakaway from rest (m/s2) and rest position (m); NaN where there is none."""
    p = config.record(config.sweep.case(0)._replace(numbers=()))[0]
    if config.system == OSCILLATOR:
        decay = oscillator.friction_decay(p)
        return {
            "omega_n": config.omega_n,
            "frictionless_resonance": oscillator.resonance(p) or nan,
            "breakaway_acceleration": oscillator.breakaway_acceleration(p),
            **({"friction_decay_per_cycle": decay} if config.transient else {}),
        }
    numbers = {"omega_n": config.omega_n, "rest_position": float(p["geometry"]["rest"])}
    model = config.at_rest
    if has_own_mechanics(model.records_of_laws).any():  # not defined for the extended mechanics
        return numbers | {"frictionless_resonance": nan, "breakaway_acceleration": nan}
    least, _ = breakaway_accelerations(model.record(Case("coulomb", 1.0, 1e-3)))
    return numbers | {"frictionless_resonance": resonance(p), "breakaway_acceleration": float(least[0])}


def breakaway(config: Config) -> dict[str, tuple[tuple[str, ...], np.ndarray, dict[str, Any]]]:
    """Dataset variables ``breakaway_min`` and ``breakaway_max`` over the axes that change them.

    Least and most base acceleration (m/s2) at which Coulomb's law lets a suspension slip from rest; NaN where
    friction is not set-valued, or effects have mechanics of their own. Inf: it jams.
    """
    # Each sample is a model of its own, with a linear programme (0.1 ms) for bounds that nobody reads alone.
    if config.system == OSCILLATOR or SAMPLE in config.sweep.dims:
        return {}
    cases_of = set(config.sweep.keys) - set(config.sweep.keys_of_input)
    dims, cases = config.sweep.along((LAW, *cases_of))
    rows = config.at_rest.records(cases.ravel())
    defined = rows["friction"]["set_valued"].astype(bool) & ~has_own_mechanics(rows)
    values = np.where(defined, breakaway_accelerations(rows), nan).reshape(2, *cases.shape)
    about = "base acceleration at which Coulomb's law {} slip from rest"
    return {
        name: (dims, value, {"units": "m s-2", "long_name": about.format(verb)})
        for (name, verb), value in zip(BREAKAWAY.items(), values, strict=True)
    }
