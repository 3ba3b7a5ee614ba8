"""Draws what a data set hides, and how strong it must be to have the excess that is wanted."""

from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import count
from typing import Any

import blind_bench as bench
import blind_effects as effects
import blind_outside_files as outside
import blind_strength as strength
import numpy as np
from blind_bench import Test
from blind_sets import BlindSet

from wedgesweep import config
from wedgesweep.effects import EFFECTS
from wedgesweep.friction import LAW_NAMES
from wedgesweep.synthesize.names import NOISES

LEVEL = 0.04
# Relative std of stated amplitudes; share of sets with an uncertain friction level, with the other lean.
SPREAD = (0.001, 0.02)
UNCERTAIN_SHARE, OTHER_LEAN_SHARE = 0.3, 0.2
UNCERTAIN = (0.05, 0.10)
LEAN = 4.0
# Attempts with other laws, tests and numbers; after some, another kind of noise, and another effect if free.
ATTEMPTS, STUBBORN = 60, 12
# ... and after so many an effect that cannot be as weak or strong as that gives way to the next one.
PERSISTENT = 48
# Each effect of a pair must leave so much when only the other is in the model.
LEAST_EACH = 900.0


@dataclass
class Draft:
    """Everything that a data set is made from; numbers of effects in key units."""

    law: str
    lean: float
    noise: str
    tests: list[Test]
    spread: float | None
    uncertain: dict[str, float]
    hidden: dict[str, dict[str, float]] = field(default_factory=dict)
    foreign: dict[str, float] | None = None
    candidates: tuple[str, ...] = tuple(EFFECTS)
    expected: float = 0.0

    def model(self, hidden: dict[str, dict[str, float]] | None = None) -> config.Config:
        return config.parse(bench.model(self.law, self.lean, hidden))

    def excess(
        self, mean: np.ndarray | None, tone: float | None, known: dict[str, dict[str, float]]
    ) -> float:
        """Excess that a model with the effects ``known`` leaves of true responses."""
        model = self.model(known)
        return strength.excess(
            mean, tone, model, self.law, self.tests, self.spread, self.uncertain, self.noise, LEVEL
        )

    def excess_of(self, hidden: dict[str, Any], known: dict[str, Any] | None = None) -> float:
        """Excess of a system with the effects ``hidden`` under a model with those ``known``."""
        mean, tone = strength.harmonics(self.model(hidden), self.law, self.tests)
        return self.excess(mean, tone, known or {})

    def suits(self) -> bool:
        return bench.suits(self.model(self.hidden), self.law, self.tests)


def draw(one: BlindSet) -> Draft:
    """What a set is made from; the same for the same set."""
    for attempt in count():
        if attempt >= ATTEMPTS:
            message = f"{one.name}: no system of this kind reaches the excess wanted in {ATTEMPTS} attempts"
            raise RuntimeError(message)
        random = one.random(attempt)
        draft = _stage(one, random, attempt)
        if draft and HIDE[one.kind](one, draft, random, attempt):
            return draft
    raise AssertionError


def _stage(one: BlindSet, random: np.random.Generator, attempt: int) -> Draft | None:
    """Law, tests and noise; nothing hidden yet."""
    law = LAW_NAMES[int(random.integers(len(LAW_NAMES)))]
    lean = -LEAN if random.random() < OTHER_LEAN_SHARE else LEAN
    poor = one.kind == "poor"
    tests = bench.draw(law, lean, bench.PAPER if poor else bench.TWELVE, random)
    low, high = np.log(SPREAD)
    spread = None if poor else float(f"{np.exp(random.uniform(low, high)):.3g}")
    uncertain = {}
    if random.random() < UNCERTAIN_SHARE:
        uncertain["friction_level"] = round(float(random.uniform(*UNCERTAIN)), 3)
    # Every effect meets every kind of noise in which it can show.
    noise = NOISES[(one.index + one.index // len(EFFECTS) + attempt // STUBBORN) % len(NOISES)]
    return None if tests is None else Draft(law, lean, noise, tests, spread, uncertain)


def _nothing(one: BlindSet, draft: Draft, random: np.random.Generator, attempt: int) -> bool:
    return True


def _hide(draft: Draft, effect: str, target: float, random: np.random.Generator) -> bool:
    """Hide one effect beside those that are hidden, so strong that it leaves the target when left out."""
    others, path = dict(draft.hidden), effects.path(effect, random)
    if effect in draft.uncertain:
        draft.uncertain = {}
    s = strength.reach(target, lambda s: draft.excess_of({**others, effect: path(s)}, others))
    if s is None:
        return False
    draft.hidden[effect] = {key: float(f"{value:.6g}") for key, value in path(s).items()}
    return draft.suits()


def _one(one: BlindSet, draft: Draft, random: np.random.Generator, attempt: int) -> bool:
    """One effect; the effects take turns over the sets of a kind."""
    effect = effects.EFFECTS[(one.index + attempt // PERSISTENT) % len(effects.EFFECTS)]
    return _measured(draft, effect, one.target(random), random)


def _measured(draft: Draft, effect: str, target: float, random: np.random.Generator) -> bool:
    if not _hide(draft, effect, target, random):
        return False
    draft.expected = draft.excess_of(draft.hidden)
    return True


def _poor(one: BlindSet, draft: Draft, random: np.random.Generator, attempt: int) -> bool:
    """Any effect that shows at all in the paper's two tests; another one where it will not."""
    order = np.random.default_rng([one.seed, 99]).permutation(len(effects.EFFECTS))
    place = one.index + attempt // STUBBORN
    return _measured(draft, effects.EFFECTS[order[place % order.size]], one.target(random), random)


def _pair(one: BlindSet, draft: Draft, random: np.random.Generator, attempt: int) -> bool:
    """Two effects of different families, each strong beside the other and alone."""
    # The same two names for some attempts, so that rare pairs are not left out.
    names = np.random.default_rng([one.seed, 7, one.index, attempt // STUBBORN])
    first, second = names.choice(effects.EFFECTS, 2, replace=False)
    while EFFECTS[first].family == EFFECTS[second].family:
        first, second = names.choice(effects.EFFECTS, 2, replace=False)
    for name in (str(first), str(second)):
        if not _hide(draft, name, one.target(random), random):
            return False
    draft.expected = draft.excess_of(draft.hidden)
    alone = [draft.excess_of({name: draft.hidden[name]}) for name in draft.hidden]
    beside = draft.excess_of(draft.hidden, {second: draft.hidden[str(second)]})
    return min(*alone, beside, draft.expected) >= LEAST_EACH


def _unknown(one: BlindSet, draft: Draft, random: np.random.Generator, attempt: int) -> bool:
    """By turns an effect that is taken out of the library and one that was never in it."""
    if one.index % 2:
        return outside.hide(one.index // 2, draft, one.target(random), random)
    order = np.random.default_rng([one.seed, 98]).permutation(len(effects.EFFECTS))
    effect = effects.EFFECTS[order[one.index // 2 % order.size]]
    draft.candidates = tuple(name for name in EFFECTS if name != effect)
    return _measured(draft, effect, one.target(random), random)


HIDE: dict[str, Callable[[BlindSet, Draft, np.random.Generator, int], bool]] = {
    "clean": _nothing,
    "strong": _one,
    "weak": _one,
    "pair": _pair,
    "unknown": _unknown,
    "poor": _poor,
}
