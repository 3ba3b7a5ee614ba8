"""Units of recorded channels."""

# Sizes in SI of the units of each quantity.
UNITS = {
    "time": {"s": 1.0, "ms": 1e-3},
    "displacement": {"m": 1.0, "mm": 1e-3, "um": 1e-6},
    "velocity": {"m/s": 1.0, "mm/s": 1e-3},
    "acceleration": {"m/s^2": 1.0, "mm/s^2": 1e-3, "g": 9.80665},
    "force": {"N": 1.0, "kN": 1e3},
}

# Other spellings, and those used here.
SPELLINGS = {"/s2": "/s^2", "\u00b2": "^2", "\u00b5": "u", "\u03bc": "u"}


def usual(unit: str) -> str:
    """A unit in the spelling used here: m/s2 is m/s^2, and a micro sign is u."""
    for other, own in SPELLINGS.items():
        unit = unit.replace(other, own)
    return unit
