"""The cases of a sweep: a grid, which may be huge and is never made as a whole, or a list."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from math import pi, prod
from typing import Any, NamedTuple

import numpy as np


class Case(NamedTuple):
    """One case of a sweep; amplitude in m, under a force in N."""

    law: str
    beta: float
    amplitude: float


@dataclass(frozen=True)
class Cases:
    """The cases: a grid, or a list in ``cases`` (the grid is then empty).

    ``beta`` and ``amplitude`` (m; under a force N) have shapes (n,) and (m,); beta refers to ``omega_n``
    (rad/s). Under an [input] beta is 1, and ``amplitude`` is the scale.
    """

    friction_law: tuple[str, ...]
    beta: np.ndarray
    amplitude: np.ndarray
    omega_n: float
    cases: tuple[Case, ...] | None

    @property
    def shape(self) -> tuple[int, ...]:
        """Sizes of the case dimensions: of laws, frequencies and amplitudes, or of the list."""
        if self.cases is not None:
            return (len(self.cases),)
        return len(self.friction_law), self.beta.size, self.amplitude.size

    @property
    def count(self) -> int:
        """Number of cases."""
        return prod(self.shape)

    @cached_property
    def laws(self) -> tuple[str, ...]:
        """The laws of the cases, each once."""
        if self.cases is None:
            return self.friction_law
        return tuple(dict.fromkeys(case.law for case in self.cases))

    def at(self, indices: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Place in ``laws``, beta and amplitude of some cases, each of the shape of ``indices``.

        A grid counts law, beta, amplitude (the last varies fastest). No other case is made.
        """
        if self.cases is None:
            law, beta, amplitude = np.unravel_index(indices, self.shape)
            return law, self.beta[beta], self.amplitude[amplitude]
        laws, betas, amplitudes = self._columns
        return laws[indices], betas[indices], amplitudes[indices]

    @cached_property
    def _columns(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """All cases of a list, as ``at`` returns some."""
        place = {law: number for number, law in enumerate(self.laws)}
        laws, betas, amplitudes = zip(*self.cases or (), strict=True)
        return np.array([place[law] for law in laws]), np.array(betas), np.array(amplitudes)

    def case(self, index: int) -> Case:
        """One of the cases."""
        law, beta, amplitude = self.at(np.array(index))
        return Case(self.laws[int(law)], float(beta), float(amplitude))


class AmplitudeUnit(NamedTuple):
    """How input amplitudes are written: unit, and what turns a number into SI."""

    unit: str
    factor: float

    @property
    def key(self) -> str:
        return f"amplitude_{self.unit}"


def of_sweep(given: Mapping[str, Any], under_input: bool) -> Cases:
    """The cases of a checked [sweep], under a sine or under an [input]."""
    omega_n = given["omega_n_rad_per_s"]
    if under_input:
        return Cases(tuple(given["friction_law"]), np.ones(1), np.array(given["scale"]), omega_n, None)
    cases = tuple(
        Case(each["friction_law"], *_betas(each, omega_n), *_amplitudes(each))
        for each in given.get("case", ())
    )
    return Cases(
        tuple(given.get("friction_law", ())),
        np.array(_betas(given, omega_n)),
        np.array(_amplitudes(given)),
        omega_n,
        cases or None,
    )


def _betas(given: Mapping[str, Any], omega_n: float) -> list[float]:
    if "frequency_hz" in given:
        return [2.0 * pi * f / omega_n for f in _listed(given["frequency_hz"])]
    return _listed(given.get("beta", []))


def _amplitudes(given: Mapping[str, Any]) -> list[float]:
    """Amplitudes of the input in m, or of a force in N."""
    if "amplitude_N" in given:
        return _listed(given["amplitude_N"])
    return _metres(_listed(given.get("amplitude_mm", [])))


def _metres(amplitudes: list[float]) -> list[float]:
    """Convert from mm, rounded so that 0.3 mm is the float 0.0003, by which users select."""
    return [float(f"{amplitude * 1e-3:.15g}") for amplitude in amplitudes]


def _listed(value: Any) -> list[float]:
    return value if isinstance(value, list) else [value]
