"""Thresholds from the user's own tests by a parametric bootstrap.

Data are drawn from the fitted base model: how much does the best of all candidates gain where nothing is
missing? And from the best explanation: how often does the search find it again?
"""

from dataclasses import dataclass

import numpy as np

from wedgesweep.diagnose import verdict
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.search import Search
from wedgesweep.diagnose.stages import explain

SAMPLES = 20
# Share of samples in which the search must find the truth again for a cause to be named.
SAFE = 0.95


@dataclass(frozen=True)
class Calibration:
    """Result of a calibration.

    ``gains``: penalised gain of the best candidate in each clean sample. ``found``: share of samples of the
    best explanation in which it was found again, None if there was none.
    """

    gains: np.ndarray
    found: float | None

    @property
    def least_gain(self) -> float:
        """Penalised gain that clean data of these tests practically never reach.

        Samples on which the base model has no response do not count.
        """
        return float(self.gains[np.isfinite(self.gains)].max(initial=0.0))

    @property
    def thresholds(self) -> verdict.Thresholds:
        """A cause may be named if it is found again, however small the excess; otherwise never."""
        safe = self.found is not None and self.found >= SAFE
        return verdict.Thresholds(strong=0.0 if safe else np.inf, least_gain=self.least_gain)

    def as_dict(self) -> dict[str, float | None]:
        """What is reported of the calibration in diagnosis.json."""
        return {"draws": SAMPLES, "least_gain": self.least_gain, "found_again": self.found}


def calibrate(search: Search, base: Fit, best: Fit | None) -> Calibration:
    """Repeat a search on samples from the base model, and from the best explanation if there is one."""
    rng, candidates = np.random.default_rng(0), (*search.effects, *search.undetected)

    def outcomes(truth: Fit, label: str) -> list[tuple[Fit, list[Fit]]]:
        results = []
        for number in range(SAMPLES):
            sample = truth.model.data.bootstrap_sample(truth.evaluation, rng)
            known = explain(Search.of(sample, candidates, search.threads))
            results.append((known.base, verdict.ranked(known.explanations)))
            search.progress(f"calibration, {label}: {number + 1} of {SAMPLES}")
        return results

    clean = outcomes(base, "nothing missing")
    gains = np.array([start.penalised - order[0].penalised if order else -np.inf for start, order in clean])
    found = None
    if best is not None:
        again = outcomes(best, "+".join(best.effects))
        hits = [bool(order) and set(order[0].effects) == set(best.effects) for _, order in again]
        found = float(np.mean(hits))
    return Calibration(gains, found)
