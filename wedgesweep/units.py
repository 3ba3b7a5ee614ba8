"""Units of recorded channels, and those in which datasets are shown."""

import re
from math import prod
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import xarray as xr

INCH, FOOT, POUND, GRAVITY = 0.0254, 0.3048, 4.4482216152605, 9.80665
# Mass of a pound (kg).
POUND_MASS = 0.45359237
PREFIXES = {"n": 1e-9, "u": 1e-6, "m": 1e-3, "c": 1e-2, "k": 1e3, "M": 1e6}
TURN = 6.283185307179586
# Units of time whose zero is a date: texts, serial days of Excel, seconds since 1970.
DAY = 86400.0
DATES = {"datetime": 1.0, "excel": DAY, "epoch": 1.0}
# Seconds since 1970 of this century.
EPOCH = (1e9, 4e9)


def _prefixed(unit: str, prefixes: str) -> dict[str, float]:
    """Sizes in SI of a unit of SI alone, and behind each of the ``prefixes``."""
    return {unit: 1.0} | {f"{prefix}{unit}": PREFIXES[prefix] for prefix in prefixes}


# Sizes in SI of the units of each quantity; angles, of an oscillator that turns, stand in place of lengths.
UNITS = {
    "time": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0, **DATES},
    "displacement": {
        **_prefixed("m", "mucnk"),
        **{"in": INCH, "mil": 1e-3 * INCH, "ft": FOOT},
        **{"rad": 1.0, "mrad": 1e-3, "deg": TURN / 360.0, "rev": TURN},
    },
    "velocity": {
        **_prefixed("m/s", "mucnk"),
        **{"km/h": 1.0 / 3.6, "in/s": INCH, "ft/s": FOOT},
        **{"rad/s": 1.0, "mrad/s": 1e-3, "deg/s": TURN / 360.0, "rpm": TURN / 60.0, "rev/s": TURN},
    },
    "acceleration": {
        **_prefixed("m/s^2", "muc"),
        **{"g": GRAVITY, "mg": 1e-3 * GRAVITY, "in/s^2": INCH, "ft/s^2": FOOT},
        **{"rad/s^2": 1.0, "deg/s^2": TURN / 360.0},
    },
    "force": {
        **_prefixed("N", "mukM"),
        "daN": 10.0,
        **{"lbf": POUND, "lb": POUND, "kip": 1e3 * POUND, "kgf": GRAVITY, "gf": 1e-3 * GRAVITY},
        **{"N m": 1.0, "mN m": 1e-3, "kN m": 1e3, "N cm": 1e-2, "N mm": 1e-3},
        **{"lbf in": POUND * INCH, "lbf ft": POUND * FOOT},
    },
}

# Units of other quantities, that a file may name.
FOREIGN = {
    *("V", "mV", "uV", "A", "mA", "bar", "mbar", "psi", "Pa", "kPa", "MPa", "C", "K", "F", "W", "degC"),
    *("Hz", "%", "counts", "mV/V", "ticks", "inc", "ohm", "volt", "volts", "Volt", "amp", "amps", "-"),
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
    "\u207b": "-",
    "\u00b9": "1",
}
# A power of a second at the end of a product, and the date behind a unit of time, as netCDF has them.
PER_SECOND, SINCE = re.compile(r"[ .*]s\^?-([12])$"), re.compile(r" since \S.*$")
POWERS_OF_RATES = {"1": "/s", "2": "/s^2"}
WORDS = {
    **{"sec": "s", "secs": "s", "seconds": "s", "second": "s", "msec": "ms"},
    **{"milliseconds": "ms", "microseconds": "us", "minutes": "min"},
    **{
        "\u00b0": "deg",
        "\u00b0/s": "deg/s",
        "inch": "in",
        "inches": "in",
        "G": "g",
        "lbs": "lb",
        **dict.fromkeys(("rev/min", "r/min", "1/min", "min-1", "min^-1", "u/min", "tr/min"), "rpm"),
        **{"\u00b0C": "degC", "\u00b0F": "F", "dps": "deg/s"},
        **dict.fromkeys(("newton", "newtons"), "N"),
        **dict.fromkeys(("degree", "degrees"), "deg"),
        **dict.fromkeys(("radian", "radians"), "rad"),
        **dict.fromkeys(("revs", "turns", "revolutions"), "rev"),
        **dict.fromkeys(("meter", "meters", "metres"), "m"),
        **{f"{p}N{sign}m": f"{p}N m" for p in ("", "m", "k") for sign in ("", ".", "-", "*")},
        **{"Nmm": "N mm", "Ncm": "N cm"},
        **dict.fromkeys(("in-lb", "in-lbf", "lbf-in", "lb-in", "lbf.in"), "lbf in"),
        **dict.fromkeys(("ft-lb", "ft-lbf", "lbf-ft", "lb-ft", "lbf.ft"), "lbf ft"),
    },
}


def is_dated(unit: str, first: float) -> bool:
    """Whether time in a unit counts from a date: by the unit, or as the first stamp is one since 1970."""
    return unit in DATES or EPOCH[0] < UNITS["time"][unit] * first < EPOCH[1]


def angular(unit: str) -> bool:
    """Whether a unit is one of an angle, its rates or a torque."""
    return any(part in unit for part in ("rad", "deg", "rpm", "rev", "N m", "N cm", "lbf "))


def usual(unit: str) -> str:
    """A unit in the spelling used here: m/s2 and m s-2 are m/s^2, a micro sign is u, s since a date is s."""
    for other, own in SPELLINGS.items():
        unit = unit.replace(other, own)
    unit = PER_SECOND.sub(lambda found: POWERS_OF_RATES[found[1]], SINCE.sub("", unit))
    return WORDS.get(unit) or WORDS.get(unit.lower(), unit)


def is_unit(word: str) -> bool:
    """Whether a word, in its usual spelling, is a unit of anything."""
    return word in FOREIGN or any(word in units for units in UNITS.values())


# Systems of units in which numbers are shown: for a unit of SI the one in its place, and its size in it.
_US = {
    **{"m": ("in", INCH), "mm": ("in", 1e3 * INCH), "µm": ("mil", 1e3 * INCH)},
    "kg": ("lb", POUND_MASS),
}
SI = "si"
SYSTEMS: dict[str, dict[str, tuple[str, float]]] = {
    SI: {},
    "us": {
        **_US,
        **{"N": ("lbf", POUND), "J": ("in lbf", INCH * POUND), "mJ": ("in lbf", 1e3 * INCH * POUND)},
    },
    "us-kip": {
        **_US,
        **{
            "N": ("kip", 1e3 * POUND),
            "J": ("in kip", 1e3 * INCH * POUND),
            "mJ": ("in kip", 1e6 * INCH * POUND),
        },
    },
}
POWERS = str.maketrans("²³", "23", "^")
# A number of a text, the unit that it has, and a range of two such numbers or a unit in brackets.
_NUMBER = r"(?<![\w.,\u00a0])-?\d+(?:\.\d+)?(?:e[-+]?\d+)?"
_SYMBOLS = "|".join(sorted(SYSTEMS["us"], key=len)[::-1])
_UNIT = rf"(?:{_SYMBOLS})[-^\d²³]*(?:[ /](?:{_SYMBOLS}|s|rad)[-^\d²³]*)*(?![\w/^²³-])"
_WRITTEN = re.compile(rf"(?:({_NUMBER}) to )?({_NUMBER}) ({_UNIT})|\[({_UNIT})\]")


def in_system(ds: "xr.Dataset", name: str) -> "xr.Dataset":
    """A dataset in one of SYSTEMS, its coordinates as well; what has no unit of that system stays."""
    if name == SI:
        return ds
    shown: dict[Any, Any] = dict(ds.variables)
    for each, values in ds.variables.items():
        unit, size = unit_in(str(values.attrs.get("units", "1")), name)
        if size != 1.0:
            shown[each] = (values.dims, values.values / size, values.attrs | {"units": unit})
    # All coordinates anew, so that they keep their order.
    coords = {each: shown.pop(each) for each in ds.coords}
    return ds.assign_coords(coords).assign(shown)


def unit_in(unit: str, name: str) -> tuple[str, float]:
    """A unit, such as N/mm or N mm-1, in a system, and its size in the given one."""
    parts = [_product_in(part, SYSTEMS[name]) for part in unit.split("/")]
    (_, size), *below = parts
    return "/".join(words for words, _ in parts), size / prod(each for _, each in below)


def _product_in(unit: str, system: dict[str, tuple[str, float]]) -> tuple[str, float]:
    parts, size = [], 1.0
    for part in unit.split(" "):
        symbol = part.rstrip("-^0123456789²³")
        power = part.removeprefix(symbol)
        other, own = system.get(symbol, (symbol, 1.0))
        parts.append(other + power)
        size *= own ** int(power.translate(POWERS) or 1) if own != 1.0 else 1.0
    return " ".join(parts), size


def in_text(words: str, name: str) -> str:
    """A text with its numbers of a unit, and units in brackets, in a system."""

    def converted(match: re.Match[str]) -> str:
        first, number, unit, alone = match.groups()
        other, size = unit_in(unit or alone, name)
        if alone:
            return f"[{other}]"
        start = f"{_converted(first, size)} to " if first else ""
        return f"{start}{_converted(number, size)} {other}"

    return _WRITTEN.sub(converted, words)


def _converted(number: str, size: float) -> str:
    """A number in a unit of some size, with as many digits, at least three."""
    if size == 1.0:
        return number
    digits = sum(character.isdigit() for character in number.partition("e")[0].lstrip("-0."))
    return f"{float(number) / size:.{max(digits, 3)}g}"
