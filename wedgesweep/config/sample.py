"""Samples of numbers of the model: [sweep.sample], and the points that it draws.

For Sobol indices the points are those of Saltelli (2010): two independent sets A and B, and for each number
the set A with that number from B.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import inf, nan
from typing import Any

import numpy as np

from wedgesweep.config.axes import TOLERANCE, Varied, WithNumbers, is_model_key
from wedgesweep.config.keys import Choice, Flag, Number, Whole
from wedgesweep.config.tables import Table, table
from wedgesweep.hints import show

SOBOL, LATIN = KINDS = ("sobol", "latin-hypercube")
DISTRIBUTION = "distribution"
# A share of 0, which Sobol points may have, has no finite quantile.
LEAST = 2.0**-64


def _distribution(name: str, meaning: str, **numbers: str) -> Table:
    kind = Choice(DISTRIBUTION, meaning, choices=(name,), example=name)
    positive = ("std", "sigma", "median")
    keys = (Number.new(key, about, above=0.0 if key in positive else -inf) for key, about in numbers.items())
    return table("", meaning, kind, *keys)


DISTRIBUTIONS = {
    "uniform": _distribution("uniform", "equally likely", low="smallest", high="largest"),
    "normal": _distribution("normal", "normal", mean="mean", std="standard deviation"),
    "lognormal": _distribution(
        "lognormal", "logarithm is normal", median="median", sigma="standard deviation of the logarithm"
    ),
}
KEYS = (
    Choice("kind", "how points are drawn", choices=KINDS, default=SOBOL),
    Whole.new("num", "number of points, of sobol a power of 2", minimum=2, maximum=2**24, example=1024),
    Whole.new("seed", "seed of the random numbers", 0, minimum=0, maximum=2**31 - 1),
    Flag("indices", "num x (2 + numbers) points, for plot sensitivity", default=False),
)


@dataclass(frozen=True, kw_only=True)
class Sample(WithNumbers):
    """[sweep.sample]: how many points, and the distributions of numbers."""

    def read(self, value: Any, path: str, problems: list[str]) -> dict[str, Any]:
        before = len(problems)
        read = super().read(value, path, problems)
        if not any(map(is_model_key, read)) and len(problems) == before:
            problems.append(f'{path}: no number is drawn; write "friction.dynamic" = "0.29 +- 5 %"')
        num = read.get("num", 1)
        if read.get("kind") == SOBOL and num & (num - 1):
            problems.append(
                f"{path}.num: {num} is no power of 2, as sobol needs; write {1 << num.bit_length()}"
            )
        if len(problems) == before:
            problems += self._out_of_range(read, path)
        return read

    def _out_of_range(self, read: Mapping[str, Any], path: str) -> Iterator[str]:
        for key, values in drawn(read).items():
            number = self.numbers[key]
            for end in (float(values.min()), float(values.max())):
                if isinstance(number, Number) and (fault := number.quantity.fault(end)):
                    yield f'{path}."{key}": {end:.6g} is drawn, which is out of range; it {fault}'

    def read_number(
        self, number: Varied, value: Any, path: str, problems: list[str], read: Mapping[str, Any]
    ) -> Any:
        if isinstance(number, Whole | Choice):
            problems.append(f"{path}: has no distribution; list its values in [sweep.axes]")
            return None
        return _read(value, path, problems)

    def number_shape(self, number: Varied) -> dict[str, Any]:
        return {"anyOf": [{"type": "string"}, *(each.shape() for each in DISTRIBUTIONS.values())]}


def _read(value: Any, path: str, problems: list[str]) -> dict[str, Any] | None:
    """A distribution; a tolerance such as "0.29 +- 5 %" is a uniform one."""
    if isinstance(value, str) and (parts := TOLERANCE.fullmatch(value)):
        try:
            middle, width = float(parts[1]), float(parts[2])
        except ValueError:
            middle, width = nan, nan
        width *= abs(middle) / 100.0 if parts[3] else 1.0
        low, high = (float(f"{end:.15g}") for end in (middle - width, middle + width))
        value = {DISTRIBUTION: "uniform", "low": low, "high": high}
    if not isinstance(value, dict) or value.get(DISTRIBUTION) not in list(DISTRIBUTIONS):
        problems.append(
            f'{path}: {show(value)} is no distribution; write "0.29 +- 5 %", or {{ distribution = "normal", '
            f"mean = 0.29, std = 0.01 }}; valid here: {', '.join(DISTRIBUTIONS)}"
        )
        return None
    before = len(problems)
    read = DISTRIBUTIONS[value[DISTRIBUTION]].read(value, path, problems)
    if len(problems) == before and read.get("low", 0.0) >= read.get("high", 1.0):
        problems.append(f"{path}: {read['low']:g} is not below {read['high']:g}; write low < high")
    return read


def drawn(given: Mapping[str, Any]) -> dict[str, np.ndarray]:
    """The points of a checked [sweep.sample]: values by dotted key, shape (n,)."""
    distributions = {key: each for key, each in given.items() if is_model_key(key)}
    points = _points(given, len(distributions))
    return {
        key: _quantiles(own, column)
        for (key, own), column in zip(distributions.items(), points.T, strict=True)
    }


def _points(given: Mapping[str, Any], count: int) -> np.ndarray:
    """Points of the unit cube, shape (n, count)."""
    # It takes half a second to load.
    from scipy.stats import qmc

    kind = qmc.Sobol if given["kind"] == SOBOL else qmc.LatinHypercube
    sets = 2 if given["indices"] else 1
    points = kind(sets * count, seed=np.random.default_rng(given["seed"])).random(given["num"])
    if sets == 1:
        return points
    one, other = np.split(points, 2, axis=1)
    mixed = [np.where(np.arange(count) == column, other, one) for column in range(count)]
    return np.concatenate([one, other, *mixed])


def _quantiles(distribution: Mapping[str, Any], shares: np.ndarray) -> np.ndarray:
    """Numbers below which these shares of a distribution lie."""
    if distribution[DISTRIBUTION] == "uniform":
        low, high = distribution["low"], distribution["high"]
        return low + shares * (high - low)
    from scipy.special import ndtri

    normal = ndtri(np.maximum(shares, LEAST))
    if distribution[DISTRIBUTION] == "normal":
        return distribution["mean"] + distribution["std"] * normal
    return distribution["median"] * np.exp(distribution["sigma"] * normal)
