"""Fitted parameters with their 95 % intervals."""

from collections.abc import Mapping
from math import exp, isfinite, log, sqrt
from typing import Any

import numpy as np

from wedgesweep.diagnose.fit_parameters import PHASE
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.smoothing import TWO_SIDED
from wedgesweep.effects import EFFECTS
from wedgesweep.quantity import Quantity


def parameters(fit: Fit) -> dict[str, dict[str, dict[str, Any]]]:
    """Fitted parameters of every effect with their 95 % intervals, in key units.

    Intervals are symmetric in the fit parameter, which may be a logarithm, and end at the bounds of the fit.
    A number outside of the range that was searched first comes with that range ("searched").
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
        searched, units = quantity.searched(hypothesis.units), hypothesis.units
        low, high = quantity.wider(units) if name in hypothesis.wider else searched
        # The two parts of a number with a phase are bounded each by itself.
        limits = low, high * (sqrt(2.0) if quantity.key + PHASE in here[name] else 1.0)
        ends = interval(quantity, value, TWO_SIDED * std, limits)
        found: dict[str, Any] = {"value": value, "ci95": list(ends)}
        if not (quantity.angle or searched[0] <= value <= searched[1]):
            found["searched"] = list(searched)
        return found

    return {
        name: {q.key: estimate(name, q) for q in EFFECTS[name].quantities if q.search}
        for name in hypothesis.effects
    }


def widen(numbers: Mapping[str, Mapping[str, Any]], others: Mapping[str, Mapping[str, Any]]) -> None:
    """Let the intervals of parameters hold those that another explanation finds for the same effects."""
    for name in numbers.keys() & others.keys():
        for key, own in numbers[name].items():
            low, high = zip(own["ci95"], others[name][key]["ci95"], strict=True)
            own["ci95"] = [min(low), max(high)]


def change(quantity: Quantity, value: float, moved: float) -> float:
    """Change of a number in the form in which it is fitted: a logarithm, or the number itself."""
    if quantity.logarithmic:
        return log(moved / value)
    return quantity.nearest(moved, value) - value


def interval(
    quantity: Quantity, value: float, half: float, limits: tuple[float, float]
) -> tuple[float, float]:
    """Ends of an interval within limits; ``half`` its width is in the form in which the number is fitted."""
    low, high = limits
    if quantity.angle:
        half = min(half, 0.5 * (high - low))
        return value - half, value + half
    if quantity.logarithmic:
        half = min(half, log(high / low))
        return max(value * exp(-half), low), min(value * exp(half), high)
    return max(value - half, low), min(value + half, high)


def uncertain(fit: Fit) -> dict[str, dict[str, float]]:
    """Uncertain parameters of the base model as fitted, with their standard deviations.

    That of a scale is ``std``, that of a harmonic's magnitude is named after it, as ``second_std``.
    """
    size = fit.model.size
    found = uncertain_values(fit)
    std = np.sqrt(np.maximum(np.diag(fit.covariance)[size:], 0.0))
    for number, value in zip(fit.model.uncertain.numbers, std.tolist(), strict=True):
        keys = {quantity.name: quantity.key for quantity in EFFECTS[number.effect].quantities}
        name = "std" if number.factor else f"{keys[number.part[0]]}_std"
        own = found[number.effect]
        own[name] = max(own.get(name, 0.0), value)
    return found


def uncertain_values(fit: Fit) -> dict[str, dict[str, float]]:
    """Uncertain parameters of the base model as fitted, by the keys of their effects."""
    return fit.model.uncertain.by_key(fit.x[fit.model.size :])


def finite(value: Any) -> Any:
    """A value as JSON takes it: numbers that are not finite are null, at any depth."""
    if isinstance(value, Mapping):
        return {key: finite(each) for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [finite(each) for each in value]
    return None if isinstance(value, float) and not isfinite(value) else value
