"""What a validation set is made from, and how much it misfits a model."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from validation import plan, rigs, strength, unmodelled
from validation.imperfect import Errors
from validation.response import Effects, System, Test
from validation.rigs import Rig
from validation.strength import SAMPLING_HZ, Bench
from wedgesweep.effects import candidates


@dataclass
class Draft:
    """Everything that a data set is made from; parameters of effects in the units of their keys.

    ``record_input``: what is recorded of the input, None if its amplitude is stated. ``errors``: how the
    true rig differs from that of the model; their ``size`` is relative to those of a good laboratory.
    ``load_zero_std`` (N): of the load cell of the column, None if there is none.
    """

    law: str
    rig: Rig
    noise: str
    tests: list[Test]
    spread: float | None
    uncertain: dict[str, float]
    hidden: dict[str, dict[str, float]] = field(default_factory=dict)
    unmodelled: dict[str, float] = field(default_factory=dict)
    candidates: tuple[str, ...] = candidates()
    expected: float = 0.0
    record_input: str | None = None
    model_error: float = 0.0
    size: float = 0.0
    errors: Errors | None = None
    load_zero_std: float | None = None

    @property
    def column_angle_deg(self) -> float | None:
        """Angle of the column (deg) in the model; None without one."""
        return self.rig.sections.get("suspension", {}).get("column_angle_deg")

    @property
    def true_system(self) -> System:
        """The system behind the data."""
        if self.errors is None:
            return self.system(self.hidden)
        return System(self.law, self.errors.rig, {**self.errors.effects, **self.hidden})

    @property
    def truth(self) -> list[str]:
        """Names of the hidden effects."""
        return [unmodelled.name_of(self.unmodelled)] if self.unmodelled else sorted(self.hidden)

    def system(self, effects: Effects) -> System:
        return System(self.law, self.rig, effects)

    def excess_of(self, hidden: Effects, known: Effects) -> float:
        """Excess of a system with the effects ``hidden`` under a model with the effects ``known``."""
        return self.excesses(hidden, known)[0]

    def excesses(self, hidden: Effects, *models: Effects) -> list[float]:
        """Excess of a system with the effects ``hidden`` under each of some models."""
        true = strength.true_spectra(self.system(hidden), self.tests)
        return self._excesses(true, strength.tone_of(hidden), *models)

    def unmodelled_excess(self, effect: Mapping[str, float]) -> float:
        """Excess of a system of the independent simulator under the base model."""
        return self._excesses(self._unmodelled(effect)[0], 0.0, {})[0]

    def true_excesses(self, *models: Effects) -> list[float]:
        """Excess of the system behind the data under each of some models."""
        if self.unmodelled:
            return self._excesses(self._unmodelled(self.unmodelled)[0], 0.0, *models)
        true = strength.true_spectra(self.true_system, self.tests)
        return self._excesses(true, strength.tone_of(self.hidden), *models)

    def presses(self) -> bool:
        """Whether the bolster moves, and the wedges stay pressed unless they may lift off, in every test."""
        if self.unmodelled:
            return self._unmodelled(self.unmodelled)[1] > unmodelled.LEAST_FORCE
        return plan.suits(self.true_system, self.tests)

    def _unmodelled(self, effect: Mapping[str, float]) -> tuple[np.ndarray, float]:
        assert self.column_angle_deg is not None
        return unmodelled.spectra(self.law, self.column_angle_deg, self.tests, effect)

    def _excesses(self, true: np.ndarray | None, tone_hz: float, *models: Effects) -> list[float]:
        sampling = SAMPLING_HZ * rigs.frequency_ratio(self.rig)
        bench = Bench(self.tests, self.noise, self.spread, self.uncertain, sampling, self.model_error)
        return [strength.excess(true, tone_hz, self.system(known), bench) for known in models]
