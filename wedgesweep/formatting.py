"""Numbers as a reader wants them: few digits, and powers of ten in place of 1e-5."""

from collections.abc import Iterable
from math import floor, isfinite, log10

NONE = "–"
NO_BREAK = "\N{NO-BREAK SPACE}"
SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
# Outside of this range a number is written with a power of ten.
SMALL, LARGE = 1e-3, 1e6


def counted(count: int, noun: str, plural: str = "") -> str:
    """A count with its noun: 1 test, 12 tests."""
    return f"{count} {noun if count == 1 else plural or f'{noun}s'}"


def case(
    law: str, beta: float, amplitude: float, numbers: Iterable[tuple[str, float | str]] = (), unit: str = "m"
) -> str:
    """A case in words; its amplitude is in m or N, or a scale where ``unit`` is empty."""
    more = "".join(f", {key} {setting(value)}" for key, value in numbers)
    if not unit:
        return f"{law}, scale {amplitude:.6g}{more}"
    size = f"{amplitude * 1e3:.6g} mm" if unit == "m" else f"{amplitude:.6g} {unit}"
    return f"{law}, beta {beta:.6g}, amplitude {size}{more}"


def setting(value: float | str, digits: int = 6) -> str:
    """Write a number of a model, or a name that stands in its place."""
    return value if isinstance(value, str) else f"{value:.{digits}g}"


def number(value: float | None, digits: int = 3) -> str:
    """Write a number with significant digits and thousands apart; one that is not finite becomes a dash."""
    if value is None or not isfinite(value):
        return NONE
    if value == 0.0 or SMALL <= abs(value) < LARGE:
        return _decimal(value, digits)
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    return f"{mantissa} × {power(int(exponent))}"


def short(value: float | None, digits: int = 4) -> str:
    """Write a number with at most ``digits`` digits and no trailing zeros: 24, 0.1, 14.67."""
    text = number(value, digits)
    return text.rstrip("0").rstrip(".") if "." in text and "×" not in text else text


def percent(share: float | None) -> str:
    """Write a share in per cent; only a share of 1 or more becomes 100 %."""
    if share is None or not isfinite(share):
        return NONE
    places = 0 if share < 0.985 or share >= 1.0 else 1 if share < 0.9985 else 2
    return f"{100.0 * share if share >= 1.0 else min(100.0 * share, 99.99):.{places}f}{NO_BREAK}%"


def error(share: float | None) -> str:
    """Write a relative error in per cent, with two digits."""
    text = NONE if share is None else short(100.0 * share, 2)
    return text if text == NONE else f"{text}{NO_BREAK}%"


def power(exponent: int) -> str:
    """Write a power of ten: 10³."""
    return f"10{str(exponent).translate(SUPERSCRIPT)}"


def fixed(value: float, places: int) -> str:
    """Write a number with ``places`` decimals, thousands apart."""
    return f"{value:,.{places}f}".replace(",", "\N{NARROW NO-BREAK SPACE}")


def decimals(value: float, digits: int) -> int:
    """Count the decimals that give a number other than 0 at least ``digits`` significant digits."""
    return max(digits - 1 - floor(log10(abs(value))), 0)


def _decimal(value: float, digits: int) -> str:
    return fixed(value, 0 if value == 0.0 else decimals(value, digits))


def duration(seconds: float) -> str:
    """Format a time in seconds, minutes or hours."""
    if seconds < 10.0:
        return f"{seconds:.1f} s"
    if seconds < 120.0:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60.0)
    return f"{minutes} min" if minutes < 120 else f"{minutes // 60} h {minutes % 60} min"


def size(count: float) -> str:
    """Format a number of bytes in decimal units."""
    for unit in ("B", "kB", "MB"):
        if count < 999.5:
            return f"{count:.0f} {unit}"
        count /= 1000.0
    return f"{count:.1f} GB"
