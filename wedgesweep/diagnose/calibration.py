"""Thresholds from the user's own tests: a parametric bootstrap.

Data are drawn from the fitted base model: how much does the best of all candidates gain where nothing is
missing? And from the best explanation: how often does the search find it again?
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from wedgesweep.diagnose import verdict
from wedgesweep.diagnose.search import Explanation, Search
from wedgesweep.diagnose.steady.fit_data import FitData
from wedgesweep.diagnose.steady.model import Fit

DRAWS = 20
# Share of draws in which the search must find the truth again for its name to be given.
SAFE = 0.95


@dataclass(frozen=True)
class Calibration:
    """Penalised gains of the best candidate on clean draws, and the share of draws that find the truth."""

    gains: np.ndarray
    found: float | None

    @property
    def least_gain(self) -> float:
        """Penalised gain that clean data of these tests practically never reach.

        A base model that has no response to its own data says nothing of it.
        """
        return float(self.gains[np.isfinite(self.gains)].max(initial=0.0))

    @property
    def thresholds(self) -> verdict.Thresholds:
        """A strong name wherever the truth is found again, however small the excess; else a weak one."""
        safe = self.found is not None and self.found >= SAFE
        return verdict.Thresholds(strong=0.0 if safe else np.inf, least_gain=self.least_gain)

    def as_dict(self) -> dict[str, float | None]:
        return {"draws": DRAWS, "least_gain": self.least_gain, "found_again": self.found}


def calibrate(
    base: Explanation,
    best: Explanation | None,
    explain: Callable[[Search], tuple[Explanation, Sequence[Explanation]]],
    effects: Sequence[str],
    threads: int,
    progress: Callable[[str], None],
    seed: int = 0,
) -> Calibration:
    """Run the search on draws from the base model, and from the best explanation where there is one."""
    rng = np.random.default_rng(seed)

    def outcomes(truth: Fit, label: str) -> list[tuple[Explanation, list[Explanation]]]:
        results = []
        for number in range(DRAWS):
            start, found = explain(Search(bootstrap_sample(truth, rng), effects, threads))
            results.append((start, verdict.ranked(found)))
            progress(f"calibration, {label}: {number + 1} of {DRAWS}")
        return results

    clean = outcomes(base.fit, "nothing missing")
    gains = np.array([start.penalised - order[0].penalised if order else -np.inf for start, order in clean])
    found = None
    if best is not None:
        again = outcomes(best.fit, "+".join(best.effects))
        hits = [bool(order) and set(order[0].effects) == set(best.effects) for _, order in again]
        found = float(np.mean(hits))
    return Calibration(gains, found)


def bootstrap_sample(truth: Fit, rng: np.random.Generator) -> FitData:
    """The problem with the fitted harmonics and new noise in place of what was measured."""
    data = truth.model.data
    exact = data.rotated(truth.evaluation.harmonics, truth.evaluation.phase) + truth.evaluation.aliases
    spectra = []
    for spectrum, mean in zip(data.spectra, exact, strict=True):
        channels = spectrum.mean.shape[0]
        kept = mean[:channels, : spectrum.harmonics]
        if spectrum.tone is not None:
            kept = np.concatenate([kept, mean[:channels, -1:]], axis=1)
        noise = rng.normal(size=(2, *kept.shape)) * np.sqrt(spectrum.variance / 2.0)
        noise = noise[0] + 1j * noise[1]
        if channels == 2 and spectrum.coherence:
            share = spectrum.coherence
            scale = np.sqrt(spectrum.variance)
            noise[1] = np.sqrt(1.0 - abs(share) ** 2) * noise[1] + share * noise[0] / scale[0] * scale[1]
        spectra.append(replace(spectrum, mean=kept + noise))
    return replace(data, spectra=tuple(spectra))
