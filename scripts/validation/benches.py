"""The rigs of validation sets: law, tests, noise and recorded input; nothing is hidden yet."""

from collections.abc import Callable

import numpy as np

from validation import imperfect, plan, ranges, rigs
from validation.draft import Draft
from validation.imperfect import MODEL_ERROR
from validation.rigs import Rig
from validation.sets import DataSet
from wedgesweep.friction import LAW_NAMES
from wedgesweep.synthesize.options import NOISES

# Range of the relative std of stated amplitudes, and of that of an uncertain friction level.
SPREAD, UNCERTAIN = (0.001, 0.02), (0.05, 0.10)
# Shares of the sets with an uncertain friction level and with the opposite column angle.
UNCERTAIN_SHARE, MIRRORED_SHARE = 0.3, 0.2
COLUMN_ANGLE_DEG = 4.0
# After so many attempts the kind of noise changes, too.
SAME_NOISE = 12
# How well a recorded input is known.
RECORDED_SPREAD = 0.001
# How well an amplitude is known beside a recorded load.
LOADED_SPREAD = 0.001


def draw_bench(one: DataSet, random: np.random.Generator, attempt: int) -> Draft | None:
    """Draw a rig of the kind of a set; None where its tests do not suit it."""
    return BENCHES.get(one.kind, _draw_bench)(one, random, attempt)


def _draw_bench(one: DataSet, random: np.random.Generator, attempt: int) -> Draft | None:
    """Draw law, tests and noise of the bench of Table 1."""
    law = LAW_NAMES[int(random.integers(len(LAW_NAMES)))]
    angle = -COLUMN_ANGLE_DEG if random.random() < MIRRORED_SHARE else COLUMN_ANGLE_DEG
    poor = one.kind == "poor"
    rig = rigs.bench(angle)
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
    return NOISES[(one.index + one.index // len(ranges.EFFECTS) + attempt // SAME_NOISE) % len(NOISES)]


def _draw_loaded(one: DataSet, random: np.random.Generator, attempt: int) -> Draft | None:
    """Draw four tests without sticking, in which the normal force is determined; laws take turns."""
    law = LAW_NAMES[one.index // 2 % len(LAW_NAMES)]
    rig = rigs.bench(COLUMN_ANGLE_DEG)
    tests = plan.draw(law, rig, plan.FOUR, random)
    return None if tests is None else Draft(law, rig, _noise(one, attempt), tests, LOADED_SPREAD, {})


def _draw_imperfect(one: DataSet, random: np.random.Generator, attempt: int) -> Draft | None:
    """Draw the bench with errors: of each size in turn, with the input stated or recorded in turn."""
    draft = _draw_bench(one, random, attempt)
    if draft is None or draft.column_angle_deg is None:
        return None
    size = imperfect.SIZES[one.index % len(imperfect.SIZES)]
    recorded = one.index // len(imperfect.SIZES) % 2 == 1
    draft.size, draft.model_error = size, MODEL_ERROR
    draft.errors = imperfect.draw(size, recorded, draft.column_angle_deg, random)
    draft.spread, draft.uncertain = draft.errors.spread, dict(draft.errors.uncertain)
    if recorded:
        _record_input(draft, random)
    return draft if draft.presses() else None


def _draw_any_rig(one: DataSet, random: np.random.Generator, attempt: int) -> Draft | None:
    return _draw_new_rig(rigs.any_size(random), one, random, attempt)


def _draw_constant(one: DataSet, random: np.random.Generator, attempt: int) -> Draft | None:
    return _draw_new_rig(rigs.constant_damping(random), one, random, attempt)


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


# How other rigs than the bench are drawn.
BENCHES: dict[str, Callable[[DataSet, np.random.Generator, int], Draft | None]] = {
    "imperfect": _draw_imperfect,
    "errors-only": _draw_imperfect,
    "random-rig": _draw_any_rig,
    "oscillator": _draw_oscillator,
    "constant": _draw_constant,
    "load": _draw_loaded,
}
