"""Properties of a config's nominal model that figures refer to."""

from math import nan

from wedgesweep.config.cases import Case
from wedgesweep.config.model import Config
from wedgesweep.effects.base import OSCILLATOR
from wedgesweep.systems import has_own_mechanics
from wedgesweep.systems.oscillator import parameters as oscillator
from wedgesweep.systems.suspension.equilibrium import breakaway_acceleration, resonance


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
    model = config.closed  # as far as the resonance and breakaway from rest are concerned
    if has_own_mechanics(model.records_of_laws).any():  # not defined for the extended mechanics
        return numbers | {"frictionless_resonance": nan, "breakaway_acceleration": nan}
    coulomb = model.record(Case("coulomb", 1.0, 1e-3))[0]
    return numbers | {
        "frictionless_resonance": resonance(p),
        "breakaway_acceleration": breakaway_acceleration(coulomb),
    }
