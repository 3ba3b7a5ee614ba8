"""Friction that follows the temperature of the faces, as of linings that fade or run warm.

Both coefficients change by the same share of their value per kelvin, and are never negative. A test has one
temperature, which it states; all tests at one temperature show another level of friction and no drift.
Neutral and default: share_per_K = 0. Neutral as well: temperature = reference.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from wedgesweep.effects.base import NUMERICAL, Effect
from wedgesweep.quantity import Quantity

EQUATIONS = (
    "mu -> mu (1 + share (temperature - reference))  for share (temperature - reference) >= -1",
    "mu -> 0  for share (temperature - reference) < -1",
)
TEMPERATURE = Quantity("temperature_C", 20.0, "temperature of the faces, which each test states")
EFFECT = Effect(
    name="thermal_drift",
    family="friction-law",
    branch=NUMERICAL,
    meaning="friction that follows the temperature of the {faces}",
    quantities=(
        Quantity(
            "share_per_K", 0.0, "change of mu_s and mu_d per kelvin, over their value", search=(-0.02, 0.02)
        ),
        TEMPERATURE,
        Quantity("reference_C", 20.0, "temperature at which the coefficients are the nominal ones"),
    ),
    condition=TEMPERATURE,
)


def adjust(p: np.void, share: float, temperature: float, reference: float) -> None:
    """Change the coefficients of friction in a parameter record."""
    factor = max(1.0 + share * (temperature - reference), 0.0)
    p["friction"]["mu_s"] *= factor
    p["friction"]["mu_d"] *= factor


def of_test(keys: Mapping[str, Any]) -> dict[str, float]:
    """The temperature among the keys of a test, as a number of its model."""
    key = TEMPERATURE.key
    return {f"effects.{EFFECT.name}.{key}": keys[key]} if key in keys else {}


def at_temperature(
    effects: Mapping[str, Mapping[str, float]], temperature: float | None
) -> dict[str, dict[str, float]]:
    """Numbers of effects (SI) with the drift, if it is one of them, at a temperature if that is stated."""
    found = {name: dict(numbers) for name, numbers in effects.items()}
    if EFFECT.name in found and temperature is not None:
        found[EFFECT.name][TEMPERATURE.name] = temperature
    return found
