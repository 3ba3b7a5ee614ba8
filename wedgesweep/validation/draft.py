"""Draws what a data set hides, as strong as is needed for the excess chi-squared that is wanted."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from wedgesweep.effects import EFFECTS, go_together, lift_off
from wedgesweep.friction import LAW_NAMES
from wedgesweep.synthesize.names import NOISES
from wedgesweep.validation import imperfect, plan, ranges, rigs, strength, unmodelled
from wedgesweep.validation.imperfect import MODEL_ERROR, Errors
from wedgesweep.validation.response import Effects, System, Test
from wedgesweep.validation.rigs import Rig
from wedgesweep.validation.sets import DataSet
from wedgesweep.validation.strength import SAMPLING_HZ, Bench

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
# How many times louder tests may be in which wedges are to lift off.
LOUDEST = 20.0
# How well a recorded input is known.
RECORDED_SPREAD = 0.001
# What a recorded input tells by itself, and what only sensors of the relative motion show.
OF_INPUT, OF_SENSORS = ("input_distortion", "stray_vibration"), ("velocity_lag", "displacement_gain")


@dataclass
class Draft:
    """Everything that a data set is made from; parameters of effects in the units of their keys.

    ``record_input``: what is recorded of the input, None if its amplitude is stated. ``errors``: how the
    true rig differs from that of the model; their ``size`` is relative to those of a good laboratory.
    """

    law: str
    rig: Rig
    noise: str
    tests: list[Test]
    spread: float | None
    uncertain: dict[str, float]
    hidden: dict[str, dict[str, float]] = field(default_factory=dict)
    unmodelled: dict[str, float] = field(default_factory=dict)
    candidates: tuple[str, ...] = tuple(EFFECTS)
    expected: float = 0.0
    record_input: str | None = None
    model_error: float = 0.0
    size: float = 0.0
    errors: Errors | None = None

    @property
    def lean(self) -> float | None:
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
        assert self.lean is not None
        return unmodelled.spectra(self.law, self.lean, self.tests, effect)

    def _excesses(self, true: np.ndarray | None, tone_hz: float, *models: Effects) -> list[float]:
        sampling = SAMPLING_HZ * rigs.frequency_ratio(self.rig)
        bench = Bench(self.tests, self.noise, self.spread, self.uncertain, sampling, self.model_error)
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
        draft = BENCHES.get(one.kind, _draw_bench)(one, random, attempt)
        if draft and HIDE[one.kind](one, draft, random, attempt):
            return draft
    message = f"{one.name}: no system of this kind reaches the excess wanted in {ATTEMPTS} attempts"
    raise RuntimeError(message)


def _draw_bench(one: DataSet, random: np.random.Generator, attempt: int) -> Draft | None:
    """Draw law, tests and noise; nothing is hidden yet."""
    law = LAW_NAMES[int(random.integers(len(LAW_NAMES)))]
    lean = -LEAN_DEG if random.random() < OTHER_LEAN_SHARE else LEAN_DEG
    poor = one.kind == "poor"
    rig = rigs.bench(lean)
    tests = plan.draw(law, rig, plan.PAPER if poor else plan.TWELVE, random)
    low, high = np.log(SPREAD)
    spread = None if poor else float(f"{np.exp(random.uniform(low, high)):.3g}")
    uncertain = {}
    if random.random() < UNCERTAIN_SHARE:
        uncertain["friction_level"] = round(float(random.uniform(*UNCERTAIN)), 3)
    noise = _noise(one, attempt)
    return None if tests is None else Draft(law, rig, noise, tests, spread, uncertain)


def _noise(one: DataSet, attempt: int) -> str:
    """Every effect comes with every kind of noise in which it can show."""
    return NOISES[(one.index + one.index // len(EFFECTS) + attempt // SAME_NOISE) % len(NOISES)]


def _draw_imperfect(one: DataSet, random: np.random.Generator, attempt: int) -> Draft | None:
    """Draw the bench with errors: of each size in turn, with the input stated or recorded in turn."""
    draft = _draw_bench(one, random, attempt)
    if draft is None or draft.lean is None:
        return None
    size = imperfect.SIZES[one.index % len(imperfect.SIZES)]
    recorded = one.index // len(imperfect.SIZES) % 2 == 1
    draft.size, draft.model_error = size, MODEL_ERROR
    draft.errors = imperfect.draw(size, recorded, draft.lean, random)
    draft.spread, draft.uncertain = draft.errors.spread, dict(draft.errors.uncertain)
    if recorded:
        _record_input(draft, random)
    return draft if draft.presses() else None


def _draw_any_rig(one: DataSet, random: np.random.Generator, attempt: int) -> Draft | None:
    return _draw_new_rig(rigs.any_size(random), one, random, attempt)


def _draw_oscillator(one: DataSet, random: np.random.Generator, attempt: int) -> Draft | None:
    draft = _draw_new_rig(rigs.oscillator(one.index, random), one, random, attempt)
    if draft is not None:
        _record_input(draft, random)
    return draft


def _draw_new_rig(rig: Rig, one: DataSet, random: np.random.Generator, attempt: int) -> Draft | None:
    law = LAW_NAMES[int(random.integers(len(LAW_NAMES)))]
    tests = plan.draw(law, rig, plan.TWELVE, random)
    spread = float(f"{rigs.logarithmic(SPREAD, random):.3g}")
    return None if tests is None else Draft(law, rig, _noise(one, attempt), tests, spread, {})


def _record_input(draft: Draft, random: np.random.Generator) -> None:
    quantities = draft.rig.recorded_quantities
    draft.record_input = quantities[int(random.integers(len(quantities)))]
    draft.spread = RECORDED_SPREAD


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
    draft.hidden[effect] = {key: float(f"{value:.6g}") for key, value in path(found).items()}
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


def _hide_possible(one: DataSet, draft: Draft, random: np.random.Generator, attempt: int) -> bool:
    """One effect that the measurement can show; those of a seed take turns in an order of their own."""
    possible = _possible(draft)
    order = np.random.default_rng([one.seed, 97]).permutation(len(ranges.EFFECTS))
    turns = [ranges.EFFECTS[i] for i in order if ranges.EFFECTS[i] in possible]
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
    "imperfect": _hide_possible,
    "errors-only": _hide_nothing,
    "random-rig": _hide_possible,
    "oscillator": _hide_possible,
}
# How other rigs than the bench are drawn.
BENCHES: dict[str, Callable[[DataSet, np.random.Generator, int], Draft | None]] = {
    "imperfect": _draw_imperfect,
    "errors-only": _draw_imperfect,
    "random-rig": _draw_any_rig,
    "oscillator": _draw_oscillator,
}
