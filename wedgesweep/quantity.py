"""A number of the configuration: its TOML key with the unit in it, default, range and meaning."""

from dataclasses import dataclass
from functools import cached_property
from math import inf, isinf, pi

from wedgesweep import natural_units
from wedgesweep.formatting import SUPERSCRIPT
from wedgesweep.rotation import ENDINGS

# How much wider than the searched range the range is in which a number may be followed: times the width, or
# as a factor of a logarithm. Ends that a number must not reach are left this share of the way.
WIDER, SHORT = 10.0, 0.01
# Endings of keys: what turns the unit into SI, and its dimension; without any of them a number is a share or
# a factor. The longest are first, so that "_N_per_mm" is not read as "_mm".
UNITS = {
    "_N_per_mm3": (1e9, natural_units.Dimension(mass=1, length=-2, time=-2)),
    "_N_per_mm": (1e3, natural_units.Dimension(mass=1, time=-2)),
    "_N_s2_per_m2": (1.0, natural_units.Dimension(mass=1, length=-1)),
    "_N_s_per_m": (1.0, natural_units.Dimension(mass=1, time=-1)),
    "_m_per_s2": (1.0, natural_units.ACCELERATION),
    "_rad_per_s": (1.0, natural_units.FREQUENCY),
    "_mm_per_s": (1e-3, natural_units.VELOCITY),
    "_per_K": (1.0, natural_units.SHARE),
    "_C": (1.0, natural_units.SHARE),
    "_deg": (pi / 180.0, natural_units.SHARE),
    "_kg": (1.0, natural_units.Dimension(mass=1)),
    "_mm": (1e-3, natural_units.LENGTH),
    "_hz": (1.0, natural_units.FREQUENCY),
    "_N": (1.0, natural_units.Dimension(mass=1, length=1, time=-2)),
    "_s": (1.0, natural_units.TIME),
}
# A rotation has an angle in place of a length, and so on; omega_n stays a frequency.
UNITS = {other: (1.0, UNITS[ending][1]) for ending, (other, _) in ENDINGS.items()} | UNITS
# Symbols that are not the letters of a key.
SYMBOLS = {"_deg": "°", "_hz": "Hz", "_C": "°C", "_per_K": "1/K"}


@dataclass(frozen=True)
class Quantity:
    """One number that a config may set.

    ``key`` is its TOML key, whose ending names the unit; ``name`` is the key without that ending and
    names the same number in SI. The range is in the unit of the key; ``above`` excludes its end.
    A default that is not finite is none: the key must be given. ``off`` is the number that stands for an
    absent effect, the default unless given. A fit looks for the number within ``search`` (None: it is
    not fitted), on a scale of its logarithm if ``logarithmic``. For an angle that is one turn about zero.
    ``search`` is for a model of the bench's size; see ``searched``.
    """

    key: str
    default: float
    meaning: str
    minimum: float = -inf
    above: float = -inf
    maximum: float = inf
    below: float = inf
    off: float | None = None
    search: tuple[float, float] | None = None
    logarithmic: bool = False

    @property
    def neutral(self) -> float:
        """The number of an absent effect, in the key's unit."""
        return self.default if self.off is None else self.off

    @cached_property
    def suffix(self) -> str:
        return next((suffix for suffix in UNITS if self.key.endswith(suffix)), "")

    @cached_property
    def name(self) -> str:
        return self.key.removesuffix(self.suffix)

    @cached_property
    def factor(self) -> float:
        """What turns a number in the key's unit into SI."""
        return UNITS[self.suffix][0] if self.suffix else 1.0

    @cached_property
    def unit(self) -> str:
        """Unit of the key, as CF writes it: N mm-1."""
        up, *down = self.suffix.split("_per_")
        above = [part for part in up.split("_") if part]
        below = [
            f"{part.rstrip('23')}-{part.lstrip('NmsradkghzK') or 1}"
            for each in down
            for part in each.split("_")
        ]
        units = {"deg": "degree", "hz": "Hz", "C": "degC"}
        return " ".join(units.get(part, part) for part in (*above, *below)) or "1"

    @property
    def symbol(self) -> str:
        """Unit of the key, as readers write it: N/mm."""
        words = self.suffix.removeprefix("_").replace("_per_", "/").replace("_", " ")
        return SYMBOLS.get(self.suffix, words.translate(SUPERSCRIPT))

    @cached_property
    def dimension(self) -> natural_units.Dimension:
        """Powers of mass, length and time."""
        return UNITS[self.suffix][1] if self.suffix else natural_units.SHARE

    def searched(self, units: natural_units.NaturalUnits = natural_units.BENCH) -> tuple[float, float]:
        """Search range in the key's unit for a model with these natural units; no limits if not fitted."""
        low, high = self.search or (-inf, inf)
        ratio = units.ratio(self.dimension)
        return ratio * low, ratio * high

    def wider(self, units: natural_units.NaturalUnits = natural_units.BENCH) -> tuple[float, float]:
        """A range around the searched one, as far as the number may go, in the key's unit."""
        low, high = self.searched(units)
        if self.logarithmic:
            wide = low / WIDER, high * WIDER
        else:
            wide = low - WIDER * (high - low), high + WIDER * (high - low)
        return (
            max(wide[0], self.minimum, _short_of(self.above, low)),
            min(wide[1], self.maximum, _short_of(self.below, high)),
        )

    @property
    def angle(self) -> bool:
        """Whether the number is an angle, which comes round again."""
        return self.suffix == "_deg"

    def nearest(self, value: float, other: float) -> float:
        """The same angle as ``value``, turned to lie closest to ``other``; any other number as it is."""
        if not (self.angle and self.search):
            return value
        turn = self.search[1] - self.search[0]
        return value - turn * round((value - other) / turn)

    def fault(self, value: float) -> str | None:
        """Why ``value`` (in the key's unit) cannot be right, or None."""
        if value < self.minimum:
            return f"must be at least {self.minimum:g}"
        if value <= self.above:
            return f"must be greater than {self.above:g}"
        if value > self.maximum:
            return f"must be at most {self.maximum:g}"
        if value >= self.below:
            return f"must be less than {self.below:g}"
        return None


def _short_of(end: float, inside: float) -> float:
    """A number just inside of an end, which may be infinite."""
    return end if isinf(end) else end + SHORT * (inside - end)
