"""Draws what a data set hides, as strong as is needed for the excess chi-squared that is wanted."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from wedgesweep.effects import EFFECTS
from wedgesweep.friction import LAW_NAMES
from wedgesweep.synthesize.names import NOISES
from wedgesweep.validation import plan, ranges, strength, unmodelled
from wedgesweep.validation.response import Effects, System, Test
from wedgesweep.validation.sets import DataSet
from wedgesweep.validation.strength import Bench

# Range of the relative std of stated amplitudes, and of that of an uncertain friction level.
SPREAD, UNCERTAIN = (0.001, 0.02), (0.05, 0.10)
# Shares of the sets with an uncertain friction level and with the column leaning the other way.
UNCERTAIN_SHARE, OTHER_LEAN_SHARE = 0.3, 0.2
LEAN_DEG = 4.0
# Attempts with other laws, tests and numbers. After some of them the kind of noise, and the effect where any
# will do, change too; after many, even an effect that is due gives way to the next one.
ATTEMPTS, SAME_NOISE, SAME_EFFECT = 60, 12, 48
# Excess that each effect of a pair must cause while only the other is in the model.
LEAST_OF_PAIR = 900.0


@dataclass
class Draft:
    """Everything that a data set is made from; parameters of effects in the units of their keys."""

    law: str
    lean: float
    noise: str
    tests: list[Test]
    spread: float | None
    uncertain: dict[str, float]
    hidden: dict[str, dict[str, float]] = field(default_factory=dict)
    unmodelled: dict[str, float] = field(default_factory=dict)
    candidates: tuple[str, ...] = tuple(EFFECTS)
    expected: float = 0.0

    @property
    def truth(self) -> list[str]:
        """Names of the hidden effects."""
        return [unmodelled.name_of(self.unmodelled)] if self.unmodelled else sorted(self.hidden)

    def system(self, effects: Effects) -> System:
        return System(self.law, self.lean, effects)

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
        return self.excesses(self.hidden, *models)

    def presses(self) -> bool:
        """Whether the wedges stay pressed, and the bolster moves, in every test."""
        if self.unmodelled:
            return self._unmodelled(self.unmodelled)[1] > unmodelled.LEAST_FORCE
        return plan.suits(self.system(self.hidden), self.tests)

    def _unmodelled(self, effect: Mapping[str, float]) -> tuple[np.ndarray, float]:
        return unmodelled.spectra(self.law, self.lean, self.tests, effect)

    def _excesses(self, true: np.ndarray | None, tone_hz: float, *models: Effects) -> list[float]:
        bench = Bench(self.tests, self.noise, self.spread, self.uncertain)
        return [strength.excess(true, tone_hz, self.system(known), bench) for known in models]


def draw(one: DataSet) -> Draft:
    """Draw what a set is made from; the same set gives the same draft.

    Raises
    ------
    RuntimeError
        If no system reaches the excess wanted.
    """
    for attempt in range(ATTEMPTS):
        random = one.random(attempt)
        draft = _draw_bench(one, random, attempt)
        if draft and HIDE[one.kind](one, draft, random, attempt):
            return draft
    message = f"{one.name}: no system of this kind reaches the excess wanted in {ATTEMPTS} attempts"
    raise RuntimeError(message)


def _draw_bench(one: DataSet, random: np.random.Generator, attempt: int) -> Draft | None:
    """Draw law, tests and noise; nothing is hidden yet."""
    law = LAW_NAMES[int(random.integers(len(LAW_NAMES)))]
    lean = -LEAN_DEG if random.random() < OTHER_LEAN_SHARE else LEAN_DEG
    poor = one.kind == "poor"
    tests = plan.draw(law, lean, plan.PAPER if poor else plan.TWELVE, random)
    low, high = np.log(SPREAD)
    spread = None if poor else float(f"{np.exp(random.uniform(low, high)):.3g}")
    uncertain = {}
    if random.random() < UNCERTAIN_SHARE:
        uncertain["friction_level"] = round(float(random.uniform(*UNCERTAIN)), 3)
    # Every effect comes with every kind of noise in which it can show.
    noise = NOISES[(one.index + one.index // len(EFFECTS) + attempt // SAME_NOISE) % len(NOISES)]
    return None if tests is None else Draft(law, lean, noise, tests, spread, uncertain)


def _hide_nothing(one: DataSet, draft: Draft, random: np.random.Generator, attempt: int) -> bool:
    return True


def _hide(draft: Draft, effect: str, target: float, random: np.random.Generator) -> bool:
    """Add an effect that, missing from the model, causes the target excess beside the effects there are."""
    others, path = dict(draft.hidden), ranges.path(effect, random)
    if effect in draft.uncertain:
        draft.uncertain = {}
    found = strength.reach(target, lambda s: draft.excess_of({**others, effect: path(s)}, others))
    if found is None:
        return False
    draft.hidden[effect] = {key: float(f"{value:.6g}") for key, value in path(found).items()}
    return draft.presses()


def _hide_single(draft: Draft, effect: str, target: float, random: np.random.Generator) -> bool:
    if not _hide(draft, effect, target, random):
        return False
    draft.expected = draft.excess_of(draft.hidden, {})
    return True


def _hide_next(one: DataSet, draft: Draft, random: np.random.Generator, attempt: int) -> bool:
    """One effect; the sets of a kind take turns through all effects."""
    effect = ranges.EFFECTS[(one.index + attempt // SAME_EFFECT) % len(ranges.EFFECTS)]
    return _hide_single(draft, effect, one.draw_target(random), random)


def _hide_any(one: DataSet, draft: Draft, random: np.random.Generator, attempt: int) -> bool:
    """Any effect that shows in the paper's two tests."""
    order = np.random.default_rng([one.seed, 99]).permutation(len(ranges.EFFECTS))
    effect = ranges.EFFECTS[order[(one.index + attempt // SAME_NOISE) % order.size]]
    return _hide_single(draft, effect, one.draw_target(random), random)


def _hide_pair(one: DataSet, draft: Draft, random: np.random.Generator, attempt: int) -> bool:
    """Two effects of different families, each strong alone and beside the other."""
    # The same names for several attempts, so that pairs that rarely work are not left out.
    names = np.random.default_rng([one.seed, 7, one.index, attempt // SAME_NOISE])
    first, second = names.choice(ranges.EFFECTS, 2, replace=False).tolist()
    while EFFECTS[first].family == EFFECTS[second].family:
        first, second = names.choice(ranges.EFFECTS, 2, replace=False).tolist()
    for name in (first, second):
        if not _hide(draft, name, one.draw_target(random), random):
            return False
    draft.expected, beside = draft.excesses(draft.hidden, {}, {second: draft.hidden[second]})
    alone = [draft.excess_of({name: draft.hidden[name]}, {}) for name in draft.hidden]
    return min(*alone, beside, draft.expected) >= LEAST_OF_PAIR


def _hide_unknown(one: DataSet, draft: Draft, random: np.random.Generator, attempt: int) -> bool:
    """Alternately an effect of wedgesweep and one of another simulator, without its candidate."""
    turn, target = one.index // 2, one.draw_target(random)
    if one.index % 2:
        return _hide_unmodelled(turn, draft, target, random)
    order = np.random.default_rng([one.seed, 98]).permutation(len(ranges.EFFECTS))
    effect = ranges.EFFECTS[order[turn % order.size]]
    draft.candidates = tuple(name for name in EFFECTS if name != effect)
    return _hide_single(draft, effect, target, random)


def _hide_unmodelled(turn: int, draft: Draft, target: float, random: np.random.Generator) -> bool:
    name = tuple(unmodelled.RANGES)[turn % len(unmodelled.RANGES)]
    if name == "drift":  # it must not look like a dependence on frequency
        draft.tests = [draft.tests[i] for i in random.permutation(len(draft.tests))]
    found = strength.reach(target, lambda s: draft.unmodelled_excess(unmodelled.numbers(name, s)))
    if found is None:
        return False
    draft.unmodelled = unmodelled.numbers(name, found)
    draft.candidates = tuple(each for each in EFFECTS if each != unmodelled.CANDIDATES.get(name))
    draft.expected = draft.unmodelled_excess(draft.unmodelled)
    return draft.presses()


HIDE: dict[str, Callable[[DataSet, Draft, np.random.Generator, int], bool]] = {
    "clean": _hide_nothing,
    "strong": _hide_next,
    "weak": _hide_next,
    "pair": _hide_pair,
    "unknown": _hide_unknown,
    "poor": _hide_any,
}
