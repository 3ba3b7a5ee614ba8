"""The changes of the model that may explain the experiment, and how its inputs may be read."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from types import MappingProxyType

import numpy as np

from wedgesweep import parameters
from wedgesweep.effects import EFFECTS
from wedgesweep.quantity import Quantity
from wedgesweep.reproduce.observations import OF_FAST, OF_SLOW, OF_SWEEP, SLOW_HERTZ

# Where the two faces can stick one at a time, set-valued friction has no rigid linkage to rely on (see
# parameters.REGULARISING): there it is a ramp, here up to a twentieth of the largest velocity at 20 Hz,
# which is what a plateau is told by (observations.ON_THE_AXIS).
STEEP = MappingProxyType({"static": 0.29, "threshold_velocity": 1e-4})


@dataclass(frozen=True)
class Law:
    """A friction law and what of its numbers is not Table 1's."""

    name: str
    law: str
    friction: Mapping[str, float] = field(default_factory=dict)


COULOMB, STATIC_DYNAMIC, EXPONENTIAL = (Law(n, n) for n in ("coulomb", "static-dynamic", "exponential"))
STEEP_COULOMB = Law("coulomb (ramp to 0.1 mm/s)", "static-dynamic", STEEP)
LAWS = (COULOMB, STATIC_DYNAMIC, EXPONENTIAL)
LAWS_OF_A_PLANE = (STEEP_COULOMB, STATIC_DYNAMIC, EXPONENTIAL)
LEANS = (4.0, -4.0)  # deg; the paper does not say which way the columns lean


@dataclass(frozen=True)
class Suspect:
    """A change of the model: effects, whose numbers are free within the ranges that they declare."""

    name: str
    words: str
    effects: tuple[str, ...]
    laws: tuple[Law, ...] = LAWS

    @cached_property
    def free(self) -> tuple[tuple[str, Quantity], ...]:
        """Effect and quantity of each free number."""
        return tuple(
            (effect, quantity)
            for effect in self.effects
            for quantity in EFFECTS[effect].quantities
            if quantity.search is not None
        )

    def values(self, shares: Sequence[float]) -> dict[str, dict[str, float]]:
        """Numbers (SI) by effect and name, from shares (0 to 1) of the ranges."""
        found: dict[str, dict[str, float]] = {effect: {} for effect in self.effects}
        for (effect, quantity), share in zip(self.free, shares, strict=True):
            found[effect][quantity.name] = quantity.factor * _within(quantity, share)
        for effect in self.effects:
            fixed = {q.name: q.factor * q.default for q in EFFECTS[effect].quantities if q.search is None}
            found[effect] = fixed | found[effect]
        return found

    def keys(self, shares: Sequence[float]) -> dict[str, float]:
        """The free numbers as a config writes them, by effect.key."""
        pairs = zip(self.free, shares, strict=True)
        return {f"{effect}.{quantity.key}": _within(quantity, share) for (effect, quantity), share in pairs}

    def record(self, law: Law, lean: float, shares: Sequence[float]) -> np.ndarray:
        """Parameter record, shape (1,); its amplitude and omega are still to be set."""
        suspension = {"column_angle": np.radians(lean)}
        return parameters.record(law.law, 1.0, 1.0, suspension, law.friction, self.values(shares))


def _within(quantity: Quantity, share: float) -> float:
    """Value in the key's unit at a share of the range to search."""
    assert quantity.search is not None
    low, high = quantity.search
    if quantity.logarithmic:
        return float(low * (high / low) ** share)
    return float(low + (high - low) * share)


SUSPECTS = (
    Suspect("small-input", "the friction law alone, at a small input", ()),
    Suspect("preload", "more preload", ("preload",)),
    Suspect("guide-friction", "guide friction", ("guide_friction",)),
    Suspect("fixture-resonance", "fixture resonance", ("fixture_resonance",)),
    Suspect("column-compliance", "column compliance", ("column_compliance",), LAWS_OF_A_PLANE),
    Suspect("cross-slip", "two-dimensional friction", ("cross_slip",), LAWS_OF_A_PLANE),
)


@dataclass(frozen=True)
class Reading:
    """How the unknown inputs may be meant: ``inputs`` free numbers, each a share of the range AMPLITUDES."""

    name: str
    inputs: int
    power: float | None  # amplitude ~ 1/f^power over the sweep; None: a fourth free number tells 0 from 2

    @property
    def separate(self) -> tuple[tuple[slice, slice], ...]:
        """Inputs and the observations that each alone decides; none where one input decides all."""
        if self.power is not None:
            return ()
        return (slice(0, 1), OF_SLOW), (slice(1, 2), OF_FAST), (slice(2, 4), OF_SWEEP)

    def amplitudes(self, shares: np.ndarray, hertz: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Amplitudes (m) of the recordings at 20 and 30 Hz, shape (n, 2), and of the sweep, (n, f).

        ``shares`` has shape (n, inputs).
        """
        tested = np.array([SLOW_HERTZ, 1.5 * SLOW_HERTZ])
        if self.power is not None:
            level = _amplitude(shares[:, :1])
            return level * (SLOW_HERTZ / tested) ** self.power, level * (SLOW_HERTZ / hertz) ** self.power
        power = np.where(shares[:, 3:] < 0.5, 0.0, 2.0)
        return _amplitude(shares[:, :2]), _amplitude(shares[:, 2:3]) * (SLOW_HERTZ / hertz) ** power

    def as_an_input_each(self, points: np.ndarray) -> np.ndarray:
        """Points of this reading as points of the widest one, which holds the others."""
        if self.power is None:
            return points
        level = points[:, :1]
        later = level - self.power * np.log(1.5) / np.log(AMPLITUDES[1] / AMPLITUDES[0])
        power = np.full(level.shape, self.power / 2.0)
        return np.concatenate([level, later, level, power, points[:, 1:]], axis=1)


AMPLITUDES = (3e-6, 2e-3)  # m; at 20 Hz where they change with frequency; the last one is 3 g there


def _amplitude(share: np.ndarray) -> np.ndarray:
    return AMPLITUDES[0] * (AMPLITUDES[1] / AMPLITUDES[0]) ** share


AN_INPUT_EACH = Reading("an input each", 4, None)
READINGS = (Reading("one amplitude", 1, 0.0), Reading("one acceleration", 1, 2.0), AN_INPUT_EACH)
