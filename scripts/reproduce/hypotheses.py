"""The changes of the model that may explain the experiment, and what its unknown inputs may have been."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from types import MappingProxyType

import numpy as np

from reproduce.observations import FAST_HERTZ, OF_FAST, OF_SLOW, OF_SWEEP, SLOW_HERTZ
from wedgesweep.effects import EFFECTS
from wedgesweep.quantity import Quantity
from wedgesweep.systems.suspension import parameters

# Where the two faces can stick one at a time, set-valued friction has no rigid linkage to rely on (see
# effects' REGULARISES). It is replaced by a ramp, up to a twentieth of the largest velocity at 20 Hz: the
# threshold by which a plateau is recognised (observations.ON_THE_AXIS).
STEEP = MappingProxyType({"static": 0.29, "threshold_velocity": 1e-4})


@dataclass(frozen=True)
class Law:
    """A friction law, and those of its parameters that differ from Table 1."""

    name: str
    law: str
    friction: Mapping[str, float] = field(default_factory=dict)


COULOMB, STATIC_DYNAMIC, EXPONENTIAL = (Law(n, n) for n in ("coulomb", "static-dynamic", "exponential"))
STEEP_COULOMB = Law("coulomb (ramp to 0.1 mm/s)", "static-dynamic", STEEP)
LAWS = (COULOMB, STATIC_DYNAMIC, EXPONENTIAL)
# For hypotheses under which the faces can stick one at a time.
REGULARISED_LAWS = (STEEP_COULOMB, STATIC_DYNAMIC, EXPONENTIAL)
# deg; the paper does not say which way the columns lean.
COLUMN_ANGLES = (4.0, -4.0)


@dataclass(frozen=True)
class Hypothesis:
    """A change of the model: effects, whose parameters are free within their search ranges.

    Points are given as shares (0 to 1) of these ranges.
    """

    name: str
    description: str
    effects: tuple[str, ...]
    laws: tuple[Law, ...] = LAWS

    @cached_property
    def free(self) -> tuple[tuple[str, Quantity], ...]:
        """Effect and quantity of each free parameter."""
        return tuple(
            (effect, quantity)
            for effect in self.effects
            for quantity in EFFECTS[effect].quantities
            if quantity.search is not None
        )

    def values(self, shares: Sequence[float]) -> dict[str, dict[str, float]]:
        """Parameters (SI) by effect and name."""
        found = {
            effect: {q.name: q.factor * q.default for q in EFFECTS[effect].quantities if q.search is None}
            for effect in self.effects
        }
        for (effect, quantity), share in zip(self.free, shares, strict=True):
            found[effect][quantity.name] = quantity.factor * _within(quantity, share)
        return found

    def keys(self, shares: Sequence[float]) -> dict[str, float]:
        """The free parameters in the units of their config keys, by "effect.key"."""
        pairs = zip(self.free, shares, strict=True)
        return {f"{effect}.{quantity.key}": _within(quantity, share) for (effect, quantity), share in pairs}

    def record(self, law: Law, column_angle_deg: float, shares: Sequence[float]) -> np.ndarray:
        """Parameter record, shape (1,), with an arbitrary amplitude and frequency."""
        suspension = {"column_angle": np.radians(column_angle_deg)}
        return parameters.record(law.law, 1.0, 1.0, suspension, law.friction, self.values(shares))


def _within(quantity: Quantity, share: float) -> float:
    """Value in the key's unit at a share of the search range."""
    assert quantity.search is not None
    low, high = quantity.search
    if quantity.logarithmic:
        return float(low * (high / low) ** share)
    return float(low + (high - low) * share)


HYPOTHESES = (
    Hypothesis("small-input", "the friction law alone, at a small input", ()),
    Hypothesis("jamming", "forces locked in at rest", ("jamming",), (COULOMB,)),
    Hypothesis("preload", "more preload", ("preload",)),
    Hypothesis("guide-friction", "guide friction", ("guide_friction",)),
    Hypothesis("fixture-resonance", "fixture resonance", ("fixture_resonance",)),
    Hypothesis("column-compliance", "column compliance", ("column_compliance",), REGULARISED_LAWS),
    Hypothesis("cross-slip", "two-dimensional friction", ("cross_slip",), REGULARISED_LAWS),
)


@dataclass(frozen=True)
class Interpretation:
    """What the unknown inputs may have been.

    ``inputs`` is the number of free parameters, each a share of the range AMPLITUDES. Over the sweep the
    amplitude is proportional to 1/f^power; with ``power`` None a fourth parameter chooses between 0 and 2.
    """

    name: str
    inputs: int
    power: float | None

    @property
    def separate(self) -> tuple[tuple[slice, slice], ...]:
        """Inputs and the observations that each of them alone decides; none if one input decides all."""
        if self.power is not None:
            return ()
        return (slice(0, 1), OF_SLOW), (slice(1, 2), OF_FAST), (slice(2, 4), OF_SWEEP)

    def amplitudes(self, shares: np.ndarray, hertz: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Amplitudes (m) of the recordings at 20 and 30 Hz, shape (n, 2), and of the sweep, (n, f).

        ``shares`` has shape (n, inputs).
        """
        recorded = np.array([SLOW_HERTZ, FAST_HERTZ])
        if self.power is not None:
            at_20 = _amplitude(shares[:, :1])
            return at_20 * (SLOW_HERTZ / recorded) ** self.power, at_20 * (SLOW_HERTZ / hertz) ** self.power
        power = np.where(shares[:, 3:] < 0.5, 0.0, 2.0)
        return _amplitude(shares[:, :2]), _amplitude(shares[:, 2:3]) * (SLOW_HERTZ / hertz) ** power

    def as_independent_inputs(self, points: np.ndarray) -> np.ndarray:
        """Points of this interpretation as points of INDEPENDENT_INPUTS, of which it is a special case."""
        if self.power is None:
            return points
        at_20 = points[:, :1]
        span = np.log(AMPLITUDES[1] / AMPLITUDES[0])
        at_30 = at_20 - self.power * np.log(FAST_HERTZ / SLOW_HERTZ) / span
        power = np.full(at_20.shape, self.power / 2.0)
        return np.concatenate([at_20, at_30, at_20, power, points[:, 1:]], axis=1)


# Range (m) of the input at 20 Hz; the largest is 3 g there.
AMPLITUDES = (3e-6, 2e-3)


def _amplitude(share: np.ndarray) -> np.ndarray:
    return AMPLITUDES[0] * (AMPLITUDES[1] / AMPLITUDES[0]) ** share


# A search is seeded by the names: another name makes it another search.
INDEPENDENT_INPUTS = Interpretation("an input each", 4, None)
INTERPRETATIONS = (
    Interpretation("one amplitude", 1, 0.0),
    Interpretation("one acceleration", 1, 2.0),
    INDEPENDENT_INPUTS,
)
