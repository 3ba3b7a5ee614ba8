"""Numbers that a measurement declares uncertain, each with what is stated and a standard deviation.

They are named by the effect that changes them. An effect that scales a number of the model, or the gain of a
sensor, gives a factor, stated as 1; a delay between channels gives a time, stated as 0. Harmonics of the
input, the same in all tests, give a cosine and a sine part each, over the input's amplitude and stated as the
model has them.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import sqrt
from typing import NamedTuple

import numpy as np

from wedgesweep.effects import EFFECTS, Numbers, channel_delay, input_distortion

DISTORTION = input_distortion.EFFECT.name
# Harmonics that inputs have, with the number of their phase.
HARMONICS = {"second": "second_phase", "third": "third_phase"}
# Parts of a harmonic.
COSINE, SINE = "cos", "sin"
FACTOR, DELAY = ("scale",), ("time",)
# A change of any of these numbers that matters.
SCALE = 0.1
# Farther from what is stated (standard deviations) a number is a cause, and no model makes up for it.
FARTHEST = 5.0
# Least factor.
LEAST = 0.2
# Harmonics that are no larger are zero: a config has no numbers as small as rounding errors.
ROUNDING = 1e-12


class UncertainNumber(NamedTuple):
    """One fitted number of an ``effect``, stated as ``mean``.

    ``part``: number of the effect, and for a harmonic which part of it.
    """

    effect: str
    part: tuple[str, ...]
    mean: float
    std: float

    @property
    def factor(self) -> bool:
        return self.part == FACTOR


@dataclass(frozen=True)
class UncertainNumbers:
    """All u of them, in the order of fit parameters."""

    numbers: tuple[UncertainNumber, ...]

    def __len__(self) -> int:
        return len(self.numbers)

    @cached_property
    def mean(self) -> np.ndarray:
        """As stated, (u,)."""
        return self._each("mean")

    @cached_property
    def std(self) -> np.ndarray:
        """Standard deviations, (u,)."""
        return self._each("std")

    @cached_property
    def low(self) -> np.ndarray:
        """Lower bounds, (u,)."""
        least = [LEAST if each.factor else -np.inf for each in self.numbers]
        return np.maximum(self.mean - FARTHEST * self.std, least)

    @cached_property
    def high(self) -> np.ndarray:
        """Upper bounds, (u,)."""
        return self.mean + FARTHEST * self.std

    @property
    def scale(self) -> np.ndarray:
        """Changes that matter, (u,)."""
        return np.array([each.std if each.part == DELAY else SCALE for each in self.numbers], float)

    def _each(self, name: str) -> np.ndarray:
        return np.array([getattr(each, name) for each in self.numbers], float)

    @property
    def effects(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(each.effect for each in self.numbers))

    def values(self, x: Sequence[float] | np.ndarray) -> dict[str, dict[str, float]]:
        """Numbers of the effects (SI) at a vector x (u,)."""
        parts: dict[str, dict[tuple[str, ...], float]] = {name: {} for name in self.effects}
        for each, value in zip(self.numbers, x, strict=True):
            parts[each.effect][each.part] = float(value)
        return {
            name: _harmonics(own) if name == DISTORTION else {part[0]: value for part, value in own.items()}
            for name, own in parts.items()
        }

    def by_key(self, x: Sequence[float] | np.ndarray) -> dict[str, dict[str, float]]:
        """Numbers of the effects in the units of their keys, at a vector x (u,)."""
        found = self.values(x)
        for name in EFFECTS.keys() & found:
            found[name] = {q.key: found[name][q.name] / q.factor for q in EFFECTS[name].quantities}
        return found

    def at(self, values: Numbers) -> np.ndarray:
        """The vector x (u,) of numbers of the effects (SI); as stated where they are not among them."""
        return np.array(
            [_part(values.get(each.effect), each.part, each.mean) for each in self.numbers], float
        )


def uncertain_numbers(stds: Mapping[str, float], stated: Numbers) -> UncertainNumbers:
    """Everything with a standard deviation, by effect, beside the ``stated`` effects (SI) of a model."""
    found: list[UncertainNumber] = []
    for name, std in stds.items():
        if name == DISTORTION:
            found += _parts(std, stated.get(name, {}))
        elif name == channel_delay.NAME:
            found.append(UncertainNumber(name, DELAY, 0.0, std))
        else:
            found.append(UncertainNumber(name, FACTOR, 1.0, std))
    return UncertainNumbers(tuple(found))


def _parts(std: float, stated: Mapping[str, float]) -> Iterable[UncertainNumber]:
    """Cosine and sine parts, whose magnitude has the standard deviation (rms)."""
    for harmonic in HARMONICS:
        for part in (COSINE, SINE):
            mean = _part(stated, (harmonic, part))
            yield UncertainNumber(DISTORTION, (harmonic, part), mean, sqrt(0.5) * std)


def _part(numbers: Mapping[str, float] | None, part: tuple[str, ...], stated: float = 0.0) -> float:
    """A fitted number, from those of its effect (SI); as stated without them."""
    if numbers is None:
        return stated
    if part in (FACTOR, DELAY):
        return numbers[part[0]]
    harmonic, turn = part
    value = harmonic_of(numbers, harmonic)
    return value.real if turn == COSINE else value.imag


def _harmonics(parts: Mapping[tuple[str, ...], float]) -> dict[str, float]:
    """Harmonics of the input by magnitude and phase (rad)."""
    found: dict[str, float] = {}
    for harmonic in HARMONICS:
        value = complex(parts[harmonic, COSINE], parts[harmonic, SINE])
        found |= with_harmonic({}, harmonic, value if abs(value) > ROUNDING else 0j)
    return found


def harmonic_of(numbers: Mapping[str, float], harmonic: str) -> complex:
    """A harmonic of the input over its amplitude, from numbers (SI) of the effect; 0 if not among them."""
    return complex(numbers.get(harmonic, 0.0) * np.exp(1j * numbers.get(HARMONICS[harmonic], 0.0)))


def with_harmonic(numbers: Mapping[str, float], harmonic: str, value: complex) -> dict[str, float]:
    """The numbers (SI) of the effect with another value of a harmonic."""
    return {**numbers, harmonic: abs(value), HARMONICS[harmonic]: float(np.angle(value))}
