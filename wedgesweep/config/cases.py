"""The cases of a sweep: all combinations of its axes, which may be many and are never made as a whole.

An axis is a dimension of the dataset, and holds the values of one key or of several that go together. A grid
has an axis for each key; a list of cases is one axis "case" of all keys, and samples are one axis "sample".
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from math import pi, prod, sqrt
from typing import Any, NamedTuple

import numpy as np

from wedgesweep import rotation
from wedgesweep.config import sample
from wedgesweep.config.axes import INPUT, ZIP, coded, dimension, given_number, is_model_key, model_keys, named

LAW, BETA, FREQUENCY, AMPLITUDE, SCALE = "friction_law", "beta", "frequency", "amplitude", "scale"
SAMPLE = "sample"
# What beta refers to where there is no spring: 1 Hz, in rad/s.
UNIT_FREQUENCY = 2.0 * pi
# Keys whose square root of the ratio is omega_n, by system.
NATURAL = {
    "suspension": ("suspension.bolster_spring_N_per_mm", "suspension.bolster_mass_kg"),
    "oscillator": ("oscillator.spring_N_per_mm", "oscillator.mass_kg"),
}


class Case(NamedTuple):
    """One case of a sweep; amplitude in m, under a force in N.

    ``numbers``: dotted key and value, in the key's unit, of each number of the model that the sweep varies.
    """

    law: str
    beta: float
    amplitude: float
    numbers: tuple[tuple[str, float | str], ...] = ()


@dataclass(frozen=True, eq=False)
class Axis:
    """A dimension of the cases; ``columns`` hold the values of one or several keys along it, shape (n,)."""

    dim: str
    columns: dict[str, np.ndarray]

    @property
    def size(self) -> int:
        return len(next(iter(self.columns.values())))


@dataclass(frozen=True, eq=False)
class Cases:
    """All combinations of the axes; the last one varies fastest.

    Columns have the names of config keys. Those of the input are LAW, BETA or FREQUENCY (Hz) or both, and
    AMPLITUDE (m; under a force N), or under an [input] its SCALE. ``omega_n`` (rad/s) is that of the nominal
    model, and ``natural`` holds keys and nominal numbers of spring (N/mm) and mass (kg) where it follows
    from them.
    """

    axes: tuple[Axis, ...]
    omega_n: float
    natural: tuple[tuple[str, float], ...] = ()

    @property
    def shape(self) -> tuple[int, ...]:
        """Sizes of the axes."""
        return tuple(axis.size for axis in self.axes)

    @property
    def dims(self) -> tuple[str, ...]:
        """Names of the axes."""
        return tuple(axis.dim for axis in self.axes)

    @property
    def count(self) -> int:
        """Number of cases."""
        return prod(self.shape)

    @cached_property
    def places(self) -> dict[str, int]:
        """Number of the axis that holds each column."""
        return {name: place for place, axis in enumerate(self.axes) for name in axis.columns}

    @cached_property
    def keys(self) -> tuple[str, ...]:
        """Dotted keys of the numbers of the model that vary."""
        return tuple(filter(is_model_key, self.places))

    @cached_property
    def keys_of_input(self) -> tuple[str, ...]:
        """Those of them that are numbers of the table [input]."""
        return tuple(key for key in self.keys if key.startswith(f"{INPUT}."))

    def column(self, name: str) -> np.ndarray:
        """Values of a key along its axis; empty where no axis has it."""
        return self.axes[self.places[name]].columns[name] if name in self.places else np.empty(0)

    @property
    def beta(self) -> np.ndarray:
        return self.column(BETA)

    @property
    def amplitude(self) -> np.ndarray:
        return self.column(AMPLITUDE)

    @property
    def friction_law(self) -> tuple[str, ...]:
        return tuple(self.column(LAW).tolist())

    @cached_property
    def laws(self) -> tuple[str, ...]:
        """The laws of the cases, each once."""
        return tuple(dict.fromkeys(self.friction_law))

    @cached_property
    def _law_places(self) -> np.ndarray:
        return np.array([self.laws.index(law) for law in self.friction_law])

    def along(self, names: Iterable[str]) -> tuple[tuple[str, ...], np.ndarray]:
        """Dimensions of the axes that hold some keys, and indices of the first cases along them."""
        held = sorted({self.places[name] for name in names if name in self.places})
        grid = np.indices([self.shape[place] for place in held])
        places = [grid[held.index(place)] if place in held else 0 for place in range(len(self.axes))]
        return tuple(self.dims[place] for place in held), np.ravel_multi_index(places, self.shape)

    def values(self, name: str, indices: np.ndarray) -> np.ndarray:
        """Values of a key in some cases, of the shape of ``indices``."""
        return self.column(name)[np.unravel_index(indices, self.shape)[self.places[name]]]

    def at(self, indices: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Place in ``laws``, angular frequency (rad/s) and amplitude of some cases; no other case is made."""
        law = self._law_places[np.unravel_index(indices, self.shape)[self.places[LAW]]]
        size = self.values(AMPLITUDE if AMPLITUDE in self.places else SCALE, indices)
        return law, self.betas(indices) * self.omega_ns(indices), size

    def betas(self, indices: np.ndarray) -> np.ndarray:
        """Frequency ratio of some cases, 1 under an [input]."""
        if BETA in self.places:
            return self.values(BETA, indices)
        if FREQUENCY in self.places:
            return 2.0 * pi * self.values(FREQUENCY, indices) / self.omega_ns(indices)
        return np.ones(np.shape(indices))

    @property
    def omega_n_varies(self) -> bool:
        """Whether omega_n differs between cases."""
        return any(key in self.places for key, _ in self.natural)

    def omega_ns(self, indices: np.ndarray) -> np.ndarray | float:
        """What beta refers to in some cases (rad/s)."""
        if not self.omega_n_varies:
            return self.omega_n
        spring, mass = (
            self.values(key, indices) if key in self.places else nominal for key, nominal in self.natural
        )
        found = np.sqrt(spring * 1e3 / mass)
        return np.where(found > 0.0, found, UNIT_FREQUENCY)

    def varying(self, indices: np.ndarray) -> np.ndarray:
        """Numbers of some cases, shape (n, keys), in the units of ``keys`` (see ``axes.coded``)."""
        columns = [self.values(key, indices) for key in self.keys]
        return np.stack(columns, axis=-1) if columns else np.empty((*np.shape(indices), 0))

    def case(self, index: int) -> Case:
        """One of the cases."""
        here = np.array([index])
        law, _, size = self.at(here)
        return Case(
            self.laws[int(law[0])],
            float(self.betas(here)[0]),
            float(size[0]),
            self.named(self.varying(here)[0].tolist()),
        )

    def named(self, numbers: Iterable[float]) -> tuple[tuple[str, float | str], ...]:
        """Numbers of a case, in the order of ``keys``, with their keys."""
        return tuple((key, named(key, number)) for key, number in zip(self.keys, numbers, strict=True))


class AmplitudeUnit(NamedTuple):
    """How input amplitudes are written: unit, and what turns a number into SI."""

    unit: str
    factor: float

    @property
    def key(self) -> str:
        return f"amplitude_{self.unit}"


def of_document(document: Mapping[str, Any]) -> Cases:
    """The cases of a checked config."""
    sweep = document["sweep"]
    if "omega_n_rad_per_s" in sweep:
        omega_n = sweep["omega_n_rad_per_s"]
        return Cases(tuple(_axes(document, omega_n)), omega_n)
    omega_n = natural_frequency(document)
    return Cases(tuple(_axes(document, omega_n)), omega_n, _natural(document))


def natural_frequency(document: Mapping[str, Any]) -> float:
    """sqrt(k/m) (rad/s) of a config; 1 Hz where there is no spring."""
    (_, spring), (_, mass) = _natural(document)
    return sqrt(spring * 1e3 / mass) or UNIT_FREQUENCY


def _natural(document: Mapping[str, Any]) -> tuple[tuple[str, float], ...]:
    keys = NATURAL["oscillator" if "oscillator" in document else "suspension"]
    return tuple((key, given_number(document, key)) for key in keys)


def _axes(document: Mapping[str, Any], omega_n: float) -> Iterator[Axis]:
    sweep = document["sweep"]
    if "case" in sweep:
        yield Axis("case", _listed(document, omega_n))
        return
    yield Axis(LAW, {LAW: np.array(sweep["friction_law"])})
    given = dict(sweep.get("axes", {}))
    groups = given.pop(ZIP, [])
    numbers = {key: np.array([coded(key, each) for each in values]) for key, values in given.items()}
    leaders = {key: group[0] for group in groups for key in group}
    for key in numbers:
        if key == leaders.get(key, key):
            together = {each: numbers[each] for each in numbers if leaders.get(each, each) == key}
            yield Axis(dimension(_written(document, key)), together)
    if "sample" in sweep:
        yield Axis(SAMPLE, sample.drawn(sweep["sample"]))
    yield from _of_input(sweep, omega_n)


def _written(document: Mapping[str, Any], key: str) -> str:
    """A dotted key as the file has it."""
    return rotation.text(key) if rotation.turns(document) else key


def _of_input(sweep: Mapping[str, Any], omega_n: float) -> Iterator[Axis]:
    """Axes of frequency and amplitude, or of the scale of an [input]."""
    if SCALE in sweep:
        yield Axis(SCALE, {SCALE: np.array(sweep[SCALE])})
        return
    hertz = {FREQUENCY: np.array(sweep["frequency_hz"])} if "frequency_hz" in sweep else {}
    # Where omega_n may vary a common frequency is a dimension of its own.
    if hertz and ("axes" in sweep or "sample" in sweep):
        yield Axis(FREQUENCY, hertz)
    else:
        yield Axis(BETA, {BETA: np.array(_betas(sweep, omega_n)), **hertz})
    yield Axis(AMPLITUDE, {AMPLITUDE: np.array(_amplitudes(sweep))})


def _listed(document: Mapping[str, Any], omega_n: float) -> dict[str, np.ndarray]:
    """Columns of a list of cases; where a case does not give a number of the model it is the nominal one."""
    cases = document["sweep"]["case"]
    keys = model_keys(cases)
    numbers = {
        key: np.array(
            [coded(key, case[key]) if key in case else given_number(document, key) for case in cases], float
        )
        for key in keys
    }
    columns = {LAW: np.array([case["friction_law"] for case in cases]), **numbers}
    if keys and all("frequency_hz" in case for case in cases):
        columns[FREQUENCY] = np.array([case["frequency_hz"] for case in cases])
    else:
        columns[BETA] = np.array([_betas(case, omega_n)[0] for case in cases])
    return columns | {AMPLITUDE: np.array([_amplitudes(case)[0] for case in cases])}


def _betas(given: Mapping[str, Any], omega_n: float) -> list[float]:
    if "frequency_hz" in given:
        return [2.0 * pi * f / omega_n for f in _as_list(given["frequency_hz"])]
    return _as_list(given["beta"])


def _amplitudes(given: Mapping[str, Any]) -> list[float]:
    """Amplitudes of the input in m, or of a force in N."""
    if "amplitude_N" in given:
        return _as_list(given["amplitude_N"])
    # Rounded so that 0.3 mm is the float 0.0003, by which users select.
    return [float(f"{amplitude * 1e-3:.15g}") for amplitude in _as_list(given["amplitude_mm"])]


def _as_list(value: Any) -> list[float]:
    return value if isinstance(value, list) else [value]
