"""Draws a validation set, and hides effects in it, as strong as its excess chi-squared asks for."""

from collections.abc import Callable, Sequence

import numpy as np

from validation import plan, ranges, rigs, strength, unmodelled
from validation.benches import SAME_NOISE, draw_bench
from validation.draft import Draft
from validation.sets import DataSet
from wedgesweep.effects import EFFECTS, candidates, go_together, lift_off, parts

# Attempts with other laws, tests and numbers.
ATTEMPTS = 60
# After so many attempts even an effect that is due gives way to the next one.
SAME_EFFECT = 48
# Excess that each effect of a pair must cause while only the other is in the model.
LEAST_OF_PAIR = 900.0
# How many times louder tests may be in which wedges are to lift off.
LOUDEST = 20.0
# What a recorded input tells by itself, and what only sensors of the relative motion show.
OF_INPUT, OF_SENSORS = ("input_distortion", "stray_vibration"), ("velocity_lag", "displacement_gain")


def _hide_nothing(one: DataSet, draft: Draft, random: np.random.Generator, attempt: int) -> bool:
    return True


def _hide(draft: Draft, effect: str, target: float, random: np.random.Generator) -> bool:
    """Add an effect that, missing from the model, causes the target excess beside the effects there are."""
    others, path = dict(draft.hidden), ranges.path(effect, random, draft.rig.units)
    if effect == lift_off.NAME:
        return _lift_off(draft, path(random.random()), target)
    draft.uncertain.pop(effect, None)
    found = strength.reach(target, lambda s: draft.excess_of({**others, effect: path(s)}, others))
    if found is None:
        return False
    draft.hidden[effect] = rigs.rounded(path(found))
    return draft.presses()


def _lift_off(draft: Draft, numbers: dict[str, float], target: float) -> bool:
    """Let joints open in tests so much louder that this causes the target excess."""
    tests, others = draft.tests, dict(draft.hidden)
    hidden = {**others, lift_off.NAME: {key: float(f"{value:.3g}") for key, value in numbers.items()}}

    def louder(strength: float) -> float:
        gain = LOUDEST**strength
        draft.tests = [each._replace(amplitude=float(f"{gain * each.amplitude:.4g}")) for each in tests]
        return draft.excess_of(hidden, others)

    found = strength.reach(target, louder)
    if found is None:
        draft.tests = tests
        return False
    louder(found)
    draft.hidden = hidden
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


def _hide_load_or_friction(one: DataSet, draft: Draft, random: np.random.Generator, attempt: int) -> bool:
    """More or less preload and friction in turn; the mass must not stick, or no load is determined."""
    effect = ("preload", "friction_level")[one.index % 2]
    shown = _hide_single(draft, effect, one.draw_target(random), random)
    return shown and (draft.law != "coulomb" or plan.slips(draft.true_system, draft.tests))


def _hide_possible(one: DataSet, draft: Draft, random: np.random.Generator, attempt: int) -> bool:
    """One effect that the measurement can show; those of a seed take turns in an order of their own."""
    possible = _possible(draft)
    order = np.random.default_rng([one.seed, 97]).permutation(tuple(ranges.LEADING)).tolist()
    turns = [effect for effect in order if effect in possible]
    effect = turns[(one.index + one.index // len(turns) + attempt // SAME_NOISE) % len(turns)]
    return _hide_single(draft, effect, one.draw_target(random), random)


def _possible(draft: Draft) -> Sequence[str]:
    """Effects that the measurement can show."""
    hidden = OF_INPUT if draft.record_input else ()
    sensors = () if draft.rig.relative else OF_SENSORS
    return [name for name in draft.rig.possible_effects if name not in (*hidden, *sensors)]


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
    while EFFECTS[first].family == EFFECTS[second].family or not go_together((first, second)):
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
    draft.candidates = candidates_without(effect)
    return _hide_single(draft, effect, target, random)


def candidates_without(effect: str | None) -> tuple[str, ...]:
    """All candidates but one, and but those that contain it: to name one of these would be right."""
    return tuple(name for name in candidates() if effect not in parts((name,)))


def _hide_unmodelled(turn: int, draft: Draft, target: float, random: np.random.Generator) -> bool:
    name = tuple(unmodelled.RANGES)[turn % len(unmodelled.RANGES)]
    if name == "drift":  # it must not look like a dependence on frequency
        draft.tests = [draft.tests[i] for i in random.permutation(len(draft.tests))]
    found = strength.reach(target, lambda s: draft.unmodelled_excess(unmodelled.numbers(name, s)))
    if found is None:
        return False
    draft.unmodelled = unmodelled.numbers(name, found)
    draft.candidates = candidates_without(unmodelled.CANDIDATES.get(name))
    draft.expected = draft.unmodelled_excess(draft.unmodelled)
    return draft.presses()


HIDE: dict[str, Callable[[DataSet, Draft, np.random.Generator, int], bool]] = {
    "clean": _hide_nothing,
    "strong": _hide_next,
    "weak": _hide_next,
    "pair": _hide_pair,
    "unknown": _hide_unknown,
    "poor": _hide_any,
    "imperfect": _hide_possible,
    "errors-only": _hide_nothing,
    "random-rig": _hide_possible,
    "oscillator": _hide_possible,
    "constant": _hide_possible,
    "load": _hide_load_or_friction,
}


def draw(one: DataSet) -> Draft:
    """Draw what a set is made from; the same set gives the same draft.

    Raises RuntimeError if no system reaches the excess wanted.
    """
    for attempt in range(ATTEMPTS):
        random = one.random(attempt)
        draft = draw_bench(one, random, attempt)
        if draft and HIDE[one.kind](one, draft, random, attempt):
            return draft
    raise RuntimeError(f"{one.name}: no system of this kind reaches the excess wanted in {ATTEMPTS} attempts")
