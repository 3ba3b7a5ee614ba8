"""Units of recorded channels, and those in which datasets are shown."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import xarray as xr

INCH, FOOT, POUND, GRAVITY = 0.0254, 0.3048, 4.4482216152605, 9.80665
# Mass of a pound (kg).
POUND_MASS = 0.45359237
PREFIXES = {"n": 1e-9, "u": 1e-6, "m": 1e-3, "c": 1e-2, "k": 1e3, "M": 1e6}
TURN = 6.283185307179586
# Units of time whose zero is a date: ISO 8601 texts, serial days of Excel, seconds since 1970.
DAY = 86400.0
DATES = {"datetime": 1.0, "excel": DAY, "epoch": 1.0}


def _prefixed(unit: str, prefixes: str) -> dict[str, float]:
    """Sizes in SI of a unit of SI alone, and behind each of the ``prefixes``."""
    return {unit: 1.0} | {f"{prefix}{unit}": PREFIXES[prefix] for prefix in prefixes}


# Sizes in SI of the units of each quantity; angles, of an oscillator that turns, stand in place of lengths.
UNITS = {
    "time": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "min": 60.0, **DATES},
    "displacement": {
        **_prefixed("m", "mucnk"),
        **{"in": INCH, "mil": 1e-3 * INCH, "ft": FOOT},
        **{"rad": 1.0, "mrad": 1e-3, "deg": TURN / 360.0},
    },
    "velocity": {
        **_prefixed("m/s", "mucnk"),
        **{"km/h": 1.0 / 3.6, "in/s": INCH, "ft/s": FOOT},
        **{"rad/s": 1.0, "mrad/s": 1e-3, "deg/s": TURN / 360.0, "rpm": TURN / 60.0},
    },
    "acceleration": {
        **_prefixed("m/s^2", "muc"),
        **{"g": GRAVITY, "mg": 1e-3 * GRAVITY, "in/s^2": INCH, "ft/s^2": FOOT},
        **{"rad/s^2": 1.0, "deg/s^2": TURN / 360.0},
    },
    "force": {
        **_prefixed("N", "mukM"),
        **{"lbf": POUND, "lb": POUND, "kip": 1e3 * POUND, "kgf": GRAVITY, "gf": 1e-3 * GRAVITY},
        **{"N m": 1.0, "mN m": 1e-3, "kN m": 1e3},
    },
}

# Units of other quantities, that a file may name.
FOREIGN = {
    *("V", "mV", "uV", "A", "mA", "bar", "mbar", "psi", "Pa", "kPa", "MPa", "C", "K", "F", "W", "degC"),
    *("Hz", "%", "counts", "ticks", "inc", "ohm", "volt", "volts", "Volt", "amp", "amps", "-"),
}

# Other spellings, and those used here.
SPELLINGS = {
    "/sec": "/s",
    "/s2": "/s^2",
    "/s/s": "/s^2",
    "\u00b2": "^2",
    "\u00b5": "u",
    "\u03bc": "u",
    "\u00b7": " ",
}
WORDS = {
    **{"sec": "s", "secs": "s", "seconds": "s", "second": "s", "msec": "ms", "Nm": "N m"},
    **{
        "\u00b0": "deg",
        "\u00b0/s": "deg/s",
        "inch": "in",
        "inches": "in",
        "G": "g",
        "lbs": "lb",
        "rev/min": "rpm",
        **dict.fromkeys(("newton", "newtons", "Newton"), "N"),
        **dict.fromkeys(("degree", "degrees"), "deg"),
        **dict.fromkeys(("radian", "radians"), "rad"),
        **dict.fromkeys(("meter", "meters", "metres"), "m"),
    },
}


def angular(unit: str) -> bool:
    """Whether a unit is one of an angle, its rates or a torque."""
    return any(part in unit for part in ("rad", "deg", "rpm", "N m"))


def usual(unit: str) -> str:
    """A unit in the spelling used here: m/s2 is m/s^2, and a micro sign is u."""
    for other, own in SPELLINGS.items():
        unit = unit.replace(other, own)
    return WORDS.get(unit, unit)


def is_unit(word: str) -> bool:
    """Whether a word, in its usual spelling, is a unit of anything."""
    return word in FOREIGN or any(word in units for units in UNITS.values())


# Systems of units in which a dataset is shown: for a unit of SI the one in its place, and its size in SI.
_US = {"m": ("in", INCH), "mm": ("in", 1e3 * INCH), "kg": ("lb", POUND_MASS)}
SI = "si"
SYSTEMS: dict[str, dict[str, tuple[str, float]]] = {
    SI: {},
    "us": {**_US, "N": ("lbf", POUND), "J": ("in lbf", INCH * POUND)},
    "us-kip": {**_US, "N": ("kip", 1e3 * POUND), "J": ("in kip", 1e3 * INCH * POUND)},
}

# Units that a dataset has in none but these.
CUSTOMARY = {unit for system in SYSTEMS.values() for unit, _ in system.values()}


def in_system(ds: "xr.Dataset", name: str) -> "xr.Dataset":
    """A dataset in one of SYSTEMS, its coordinates as well; what has no unit of that system stays."""
    if name == SI:
        return ds
    shown: dict[Any, Any] = dict(ds.variables)
    for each, values in ds.variables.items():
        unit, size = _unit_in(str(values.attrs.get("units", "1")), SYSTEMS[name])
        if size != 1.0:
            shown[each] = (values.dims, values.values / size, values.attrs | {"units": unit})
    # All coordinates anew, so that they keep their order.
    coords = {each: shown.pop(each) for each in ds.coords}
    return ds.assign_coords(coords).assign(shown)


def _unit_in(unit: str, system: dict[str, tuple[str, float]]) -> tuple[str, float]:
    """A unit as CF writes it, such as N mm-1, in another system, and its size in the given one."""
    parts, size = [], 1.0
    for part in unit.split():
        symbol = part.rstrip("-0123456789")
        power = part.removeprefix(symbol)
        other, own = system.get(symbol, (symbol, 1.0))
        parts.append(other + power)
        size *= own ** int(power or 1)
    return " ".join(parts), size
