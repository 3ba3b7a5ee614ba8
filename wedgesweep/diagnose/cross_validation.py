"""What an extended model gains on tests that it was not fitted to."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import ndtr, stdtrit

from wedgesweep.diagnose.least_squares import refine, subset_fit
from wedgesweep.diagnose.normal_equations import normal_equations
from wedgesweep.diagnose.steady.model import Evaluation, Fit, Model, Point

# Iterations that adapt a fit to fewer tests, and the phase and amplitude to a held-out one.
ADAPT, LOCAL = 6, 4
# Amplitudes (or frequencies) closer than this belong together.
ALIKE = 0.02
RESAMPLED = 2000
# With fewer tests an interval would be a pretence.
FEWEST = 8
# Tests drawn with less than this share of the excess hold nothing that could be removed.
SHOWS = 0.1


@dataclass(frozen=True)
class HeldOut:
    """Whitened squared misfit of one test under models that were fitted to others, and its points.

    ``local``: how many numbers the test itself has determined, a number with a prior in part.
    """

    test: int
    scheme: str
    base: float
    extended: float
    observations: int
    local: float

    @property
    def noise(self) -> float:
        """Squared misfit that noise leaves after phase and amplitude are fitted."""
        return self.observations - self.local

    def rmse(self, squared: float) -> float:
        return float(np.sqrt(squared / self.observations))


@dataclass(frozen=True)
class Gain:
    """Gain over all held-out tests; ``interval`` of ``excess_removed``, None for too few tests."""

    held_out: tuple[HeldOut, ...]

    def _total(self, part: Callable[[HeldOut], float], chosen: Sequence[HeldOut]) -> float:
        return sum(map(part, chosen)) / sum(each.observations for each in chosen)

    def totals(self, chosen: Sequence[HeldOut] | None = None) -> tuple[float, float, float]:
        """Mean squares of base, extended and noise."""
        chosen = self.held_out if chosen is None else chosen
        parts = (lambda h: h.base, lambda h: h.extended, lambda h: h.noise)
        return tuple(self._total(part, chosen) for part in parts)  # type: ignore[return-value]

    @staticmethod
    def removed(base: float, extended: float, noise: float) -> float:
        """Share of the excess that is gone."""
        return (base - extended) / (base - noise) if base > noise else 0.0

    @property
    def excess_removed(self) -> float:
        return self.removed(*self.totals())

    @property
    def interval(self) -> list[float] | None:
        """95 % interval of ``excess_removed`` from tests drawn again, both schemes of a test together.

        Where few tests show the effect many draws have none of them: what little there is to explain is
        noise then, and its share that is removed says nothing. They do not count.
        Few tests scatter less when drawn again than they did when they were made, which the quantiles make
        up for (Hesterberg, 2015, "What teachers should know about the bootstrap", sec. 5.3).
        """
        tests = sorted({each.test for each in self.held_out})
        if len(tests) < FEWEST:
            return None
        by_test = [[each for each in self.held_out if each.test == test] for test in tests]
        sums = np.array(
            [
                [sum(getattr(h, name) for h in rows) for name in ("base", "extended", "noise")]
                for rows in by_test
            ]
        )
        drawn = np.random.default_rng(0).integers(0, len(tests), (RESAMPLED, len(tests)))
        base, extended, noise = sums[drawn].sum(axis=1).T
        excess = base - noise
        shows = excess > max(SHOWS * (sums[:, 0] - sums[:, 2]).sum(), 0.0)
        removed = (base - extended)[shows] / excess[shows] if shows.any() else np.zeros(1)
        tail = ndtr(np.sqrt(len(tests) / (len(tests) - 1.0)) * stdtrit(len(tests) - 1, 0.025))
        low, high = np.quantile(removed, [tail, 1.0 - tail])
        return [float(low), float(high)]


def cross_validate(base: Fit, extended: Fit, each: Callable[[Callable, list], list]) -> Gain:
    """Leave out one frequency, then one amplitude, and predict that; ``each`` maps a function."""
    data = base.model.data
    jobs = [("frequency", rows) for rows in groups(data.omega)]
    if not np.isinf(data.amplitude_std).any():
        jobs += [("amplitude", rows) for rows in groups(data.amplitude)]
    jobs = [job for job in jobs if len(job[1]) < data.tests]
    local = _local_numbers(extended)
    rows = each(lambda job: _held_out(base, extended, local, *job), jobs)
    return Gain(tuple(one for group in rows for one in group))


def groups(values: np.ndarray) -> list[np.ndarray]:
    """Indices of values that are alike, group by group."""
    order = np.argsort(values)
    found = [[order[0]]]
    for place in order[1:]:
        # Compared with the first: in a fine sweep each is close to its neighbour.
        if np.log(values[place] / values[found[-1][0]]) > ALIKE:
            found.append([])
        found[-1].append(place)
    return [np.array(group) for group in found]


def _local_numbers(fit: Fit) -> np.ndarray:
    """Numbers (T,) that each test determines: phase, and amplitude as far as it is not known before."""
    model = fit.model
    inner = normal_equations(model, fit.evaluation).local_block
    known = model.amplitude_weight**2
    both = inner[:, 1, 1] - inner[:, 0, 1] ** 2 / inner[:, 0, 0]
    return 1.0 + np.clip(1.0 - known / both, 0.0, 1.0) + model.tone_tests


def _held_out(base: Fit, extended: Fit, local: np.ndarray, scheme: str, rows: np.ndarray) -> list[HeldOut]:
    rest = np.setdiff1d(np.arange(base.model.data.tests), rows)
    misfits = [_predict(fit, rest, rows) for fit in (base, extended)]
    data = base.model.data
    return [
        HeldOut(int(test), scheme, float(b), float(e), int(data.observations[test]), float(local[test]))
        for test, b, e in zip(rows, *misfits, strict=True)
    ]


def _predict(fit: Fit, rest: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Squared misfits (rows,) after a fit to the rest of the tests."""
    trained = subset_fit(fit, rest)
    if len(fit.x):
        trained = refine(trained.model, trained.evaluation, ADAPT)
    return predict(fit, trained.x, rows)


def predict(fit: Fit, x: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Squared misfits (rows,) with given numbers; each test keeps its own phase and amplitude.

    A known amplitude may move within its prior; an unknown one comes from the fundamental of the displacement
    alone, so that the rest of the test is a prediction.
    """
    part = subset_fit(fit, rows)
    unknown = np.isinf(part.model.data.amplitude_std)
    evaluation = part.model.evaluate(replace(part.evaluation.point, x=x))
    for _ in range(LOCAL):
        if not evaluation.found:
            break
        evaluation = part.model.evaluate(_moved(part.model, evaluation, unknown))
    misfit = (evaluation.residual**2).sum(-1)
    return np.where(evaluation.found_tests, misfit, part.model.data.power)


def _moved(model: Model, evaluation: Evaluation, unknown: np.ndarray) -> Point:
    """Point with each amplitude moved: by its prior and data, or to match the fundamental."""
    point = evaluation.point
    equations = normal_equations(model, evaluation)
    still = np.zeros(len(point.x))
    local = equations.local_step(still, 0.0)[:, 1:]
    measured = np.abs(model.data.measured[:, 0, 0])
    simulated = np.abs(evaluation.harmonics[:, 0, 0])
    match = np.log(measured / np.where(simulated > 0.0, simulated, measured))
    local[:, 0] = np.where(unknown, match, local[:, 0])
    return point.moved(still, np.clip(local, -0.3, 0.3))
