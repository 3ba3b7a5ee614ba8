"""Fitted parameters with their 95 % intervals."""

from math import exp, isfinite, log, sqrt
from typing import Any

import numpy as np

from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.profile_likelihood import TWO_SIDED
from wedgesweep.effects import EFFECTS
from wedgesweep.natural_units import BENCH, NaturalUnits
from wedgesweep.quantity import Quantity


def parameters(fit: Fit) -> dict[str, dict[str, dict[str, Any]]]:
    """Fitted parameters of every effect with their 95 % intervals, in key units.

    Intervals are symmetric in the fit parameter, which may be a logarithm, and end where the searched range
    ends.
    """
    hypothesis, size, known = fit.model.hypothesis, fit.model.size, fit.model.data.known
    x, covariance = fit.x[:size], fit.covariance[:size, :size]
    here = hypothesis.in_key_units(x)
    step = 1e-5 * hypothesis.scale
    moved = [hypothesis.in_key_units(x + step * row) for row in np.eye(size)]

    def estimate(name: str, quantity: Quantity) -> dict[str, Any]:
        value = here[name][quantity.key]
        slope = np.array([change(quantity, value, m[name][quantity.key]) for m in moved]) / step
        std = sqrt(max(float(slope @ covariance @ slope), 0.0))
        if f"{name}.{quantity.key}" in known:
            std = change(quantity, value, value + known[f"{name}.{quantity.key}"][1])
        ends = interval(quantity, value, TWO_SIDED * std, hypothesis.units)
        return {"value": finite(value), "ci95": [finite(end) for end in ends]}

    return {
        name: {q.key: estimate(name, q) for q in EFFECTS[name].quantities if q.search}
        for name in hypothesis.effects
    }


def change(quantity: Quantity, value: float, moved: float) -> float:
    """Change of a number in the form in which it is fitted, logarithm or not."""
    if quantity.logarithmic:
        return log(moved / value)
    return quantity.nearest(moved, value) - value


def interval(
    quantity: Quantity, value: float, half: float, units: NaturalUnits = BENCH
) -> tuple[float, float]:
    """Ends of an interval; ``half`` of its width is in the form in which the number is fitted."""
    low, high = quantity.searched(units)
    if quantity.angle:
        half = min(half, 0.5 * (high - low))
        return value - half, value + half
    if quantity.logarithmic:
        half = min(half, log(high / low))
        return max(value * exp(-half), low), min(value * exp(half), high)
    return max(value - half, low), min(value + half, high)


def uncertain(fit: Fit) -> dict[str, dict[str, float]]:
    """Uncertain parameters of the base model as fitted."""
    size = fit.model.size
    return {
        name: {"scale": float(value), "std": float(sqrt(max(fit.covariance[size + i, size + i], 0.0)))}
        for i, (name, value) in enumerate(zip(fit.model.uncertain, fit.x[size:], strict=True))
    }


def finite(value: Any) -> float | None:
    """A number as JSON takes it."""
    return float(value) if value is not None and isfinite(value) else None
