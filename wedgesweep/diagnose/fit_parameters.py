"""Effects as bounded fit parameters in which their action is smooth.

A positive number that spans decades is fitted as its logarithm, an amplitude with its phase as cosine and
sine parts; everything else is fitted as it stands in a config. All of them are fitted as if the model had the
size of the bench, so that nothing in a fit depends on the size: a force is divided by the model's natural
unit of force over the bench's.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from math import atan2, cos, degrees, exp, hypot, inf, log, radians, sin

import numpy as np

from wedgesweep.effects import EFFECTS
from wedgesweep.natural_units import BENCH, NaturalUnits
from wedgesweep.quantity import Quantity

PHASE = "_phase_deg"
# Grid points of the first parameter of an effect, and of each further one, at which a fit may start.
FIRST, FURTHER = 12, 4
# Grid points closest to and farthest from a neutral value, as shares of the range.
CLOSEST, FARTHEST = 4e-3, 0.8
# With more parameters (amplitudes with phases) the response is linear enough to start at zero; not so beside
# one that is fitted as its logarithm: then the first one starts on either side, at this share of its range.
MOST_GRIDDED, WELL_INSIDE = 3, 0.4
# Scale of a logarithm, and scale of other parameters as a share of their range.
LOG_SCALE, RANGE_SCALE = 0.5, 0.1
# Effects by name, and their numbers by name (SI) or by key (in its unit).
Values = dict[str, dict[str, float]]


@dataclass(frozen=True)
class FitParameter:
    """One fitted number, with bounds (angles have none) and the value at which it does nothing.

    ``name``: "effect.key", with ".cos" or ".sin" for a part of an amplitude. ``low`` and ``high`` bound
    the searched range; ``wider``: bounds where a fit may leave that range.
    """

    name: str
    low: float
    high: float
    wider: tuple[float, float]
    logarithmic: bool = False
    neutral: float = 0.0

    @property
    def effect(self) -> str:
        return self.name.partition(".")[0]

    @property
    def key(self) -> str:
        """Key of the number, or of the amplitude that this is the cosine or sine part of."""
        return self.name.split(".")[1]

    @property
    def angle(self) -> bool:
        return self.name.endswith("_deg")

    @property
    def scale(self) -> float:
        """Size of a typical change, by which steps of fits and of differences are measured."""
        return LOG_SCALE if self.logarithmic else RANGE_SCALE * (self.high - self.low)

    @property
    def fades(self) -> bool:
        """Whether the effect fades towards a neutral value in the range: a mere switch does not."""
        return not self.logarithmic and self.low <= self.neutral <= self.high

    @property
    def switches(self) -> bool:
        """Whether the effect acts at all of its values: it is there or not."""
        return not (self.fades or self.logarithmic or self.angle)

    def grid(self, points: int) -> np.ndarray:
        """Points (points,) inside the range: evenly spaced, or ever closer towards a neutral value."""
        if self.logarithmic or self.angle or self.switches:
            return self.low + (self.high - self.low) * (np.arange(points) + 0.5) / points
        spans = [end - self.neutral for end in (self.low, self.high) if abs(end - self.neutral) > 0.0]
        shares = np.geomspace(CLOSEST, FARTHEST, points // len(spans))
        return np.concatenate([self.neutral + span * shares for span in spans])

    def ends(self) -> np.ndarray:
        """Points (2,) or (1,) on both sides of a neutral value, WELL_INSIDE of the range."""
        spans = [end - self.neutral for end in (self.low, self.high) if abs(end - self.neutral) > 0.0]
        return self.neutral + WELL_INSIDE * np.array(spans)


def _split(effect: str) -> Iterator[tuple[Quantity, Quantity | None]]:
    """Quantities of an effect that are fitted, each with its phase where that is a quantity too."""
    by_key = {quantity.key: quantity for quantity in EFFECTS[effect].quantities if quantity.search}
    for key, quantity in by_key.items():
        if not (key.endswith(PHASE) and key.removesuffix(PHASE) in by_key):
            yield quantity, by_key.get(key + PHASE)


def _parameters(effect: str) -> Iterator[FitParameter]:
    for quantity, phase in _split(effect):
        (low, high), wider = quantity.searched(), quantity.wider()
        name = f"{effect}.{quantity.key}"
        if phase:
            around = -wider[1], wider[1]
            yield from (FitParameter(f"{name}.{part}", -high, high, around) for part in ("cos", "sin"))
        elif quantity.logarithmic:
            yield FitParameter(name, log(low), log(high), (log(wider[0]), log(wider[1])), True)
        else:
            yield FitParameter(name, low, high, wider, neutral=quantity.neutral)


@dataclass(frozen=True)
class Hypothesis:
    """Some effects together, as a vector x (k,) of fit parameters; no effects: the base model.

    ``fixed``: numbers, as ("effect.key", value) in key units, that are known from elsewhere and not fitted.
    ``units``: of the model on trial. ``wider``: effects whose numbers may leave the range that was searched.
    """

    effects: tuple[str, ...] = ()
    fixed: tuple[tuple[str, float], ...] = ()
    units: NaturalUnits = BENCH
    wider: tuple[str, ...] = ()

    @cached_property
    def parameters(self) -> tuple[FitParameter, ...]:
        known = {name for name, _ in self.fixed}
        return tuple(each for name in self.effects for each in _parameters(name) if each.name not in known)

    @property
    def switches(self) -> bool:
        """Whether one of the effects acts at all of its values."""
        return any(each.switches for each in self.parameters)

    @cached_property
    def low(self) -> np.ndarray:
        """Lower bounds (k,)."""
        return self._bounds[0]

    @cached_property
    def high(self) -> np.ndarray:
        """Upper bounds (k,)."""
        return self._bounds[1]

    @cached_property
    def _bounds(self) -> np.ndarray:
        """Lower and upper bounds, (2, k)."""

        def ends(each: FitParameter) -> tuple[float, float]:
            if each.angle:
                return -inf, inf
            return each.wider if each.effect in self.wider else (each.low, each.high)

        return np.array([ends(each) for each in self.parameters]).reshape(-1, 2).T

    def vanishes(self, x: np.ndarray) -> bool:
        """Whether an effect of one length, such as a play, has the smallest one: it is as good as absent."""
        effects = [each.effect for each in self.parameters]
        return any(
            each.logarithmic and effects.count(each.effect) == 1 and value <= low
            for each, value, low in zip(self.parameters, x, self.low, strict=False)
        )

    @cached_property
    def scale(self) -> np.ndarray:
        """Typical changes of x, (k,); see ``FitParameter.scale``."""
        return np.array([each.scale for each in self.parameters])

    def in_key_units(self, x: np.ndarray) -> Values:
        """Every number of every effect by its key, in the key's unit."""
        rest, known = iter(x), dict(self.fixed)
        values: Values = {}
        for name in self.effects:
            values[name] = {q.key: q.default for q in EFFECTS[name].quantities}
            for quantity, phase in _split(name):
                if f"{name}.{quantity.key}" in known:
                    values[name][quantity.key] = known[f"{name}.{quantity.key}"]
                    continue
                value, unit = float(next(rest)), self.units.ratio(quantity.dimension)
                if phase:
                    other = float(next(rest))
                    values[name][quantity.key] = unit * hypot(value, other)
                    values[name][phase.key] = degrees(atan2(other, value))
                else:
                    value = exp(value) if quantity.logarithmic else quantity.nearest(value, 0.0)
                    values[name][quantity.key] = unit * value
        return values

    def values(self, x: np.ndarray) -> Values:
        """Every number of every effect in SI, as ``parameters.record`` takes them."""
        return {
            name: {q.name: numbers[q.key] * q.factor for q in EFFECTS[name].quantities}
            for name, numbers in self.in_key_units(x).items()
        }

    def at(self, values: Values) -> np.ndarray:
        """The vector x (k,) of numbers in key units."""
        known = dict(self.fixed)
        x: list[float] = []
        for name in self.effects:
            numbers = values[name]
            for quantity, phase in _split(name):
                if f"{name}.{quantity.key}" in known:
                    continue
                value = numbers[quantity.key] / self.units.ratio(quantity.dimension)
                if phase:
                    angle = radians(numbers[phase.key])
                    x += [value * cos(angle), value * sin(angle)]
                else:
                    x.append(log(value) if quantity.logarithmic else value)
        return np.array(x)

    def near_neutral(self, x: np.ndarray) -> np.ndarray:
        """The point (k,) with neutral parameters; logarithms, whose neutral value may be infinite, stay."""
        neutral = np.clip([each.neutral for each in self.parameters], self.low, self.high)
        return np.where([each.logarithmic for each in self.parameters], x, neutral)

    def starts(self) -> np.ndarray:
        """Points (n, k) from which a fit may start."""
        if len(self.parameters) <= MOST_GRIDDED:
            grids = [each.grid(FURTHER if i else FIRST) for i, each in enumerate(self.parameters)]
        elif any(each.logarithmic for each in self.parameters):
            grids = [self._beside_logarithm(each) for each in self.parameters]
        else:
            return np.clip(np.zeros(len(self.parameters)), self.low, self.high)[None]
        return np.array(list(product(*grids)))

    def _beside_logarithm(self, each: FitParameter) -> np.ndarray:
        """Values of a parameter where one is fitted as its logarithm: the first amplitude begins on a side.

        Others begin at zero: a second harmonic of a wave would do for one of half its length.
        """
        if each.logarithmic:
            return each.grid(FIRST)
        return each.ends() if each.key == self.parameters[0].key else np.array([each.neutral])
