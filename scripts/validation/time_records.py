"""Sets of tests that are not all steady: releases and sweeps, hysteresis loops, and several kinds together.

Oscillators and suspensions of any size take turns; those of kind ``damper`` and ``warm`` are dampers. Each
hides one effect, or none in every fifth set. It is as strong as is needed for a drawn change of the response;
sets whose excess is too small for a name all the same count as weak. A set of kind ``worse`` is a transient,
loop or mixed set whose files ``worse.py`` makes worse. One of kind ``force`` is such a set of an oscillator,
with four loops in place of two; it hides a force that is no candidate (``hidden_force.py``), and every fourth
one a known effect or none.
"""

from collections.abc import Callable
from math import nan, pi
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from validation import hidden_force, ranges, rigs, worse
from validation.rigs import Rig
from validation.sets import DataSet
from validation.strength import reach
from wedgesweep import plugins
from wedgesweep.config import from_document
from wedgesweep.effects import EFFECTS
from wedgesweep.effects.thermal_drift import at_temperature
from wedgesweep.natural_units import FREQUENCY, LENGTH
from wedgesweep.synthesize import plan
from wedgesweep.synthesize.motion import NoMotion
from wedgesweep.synthesize.options import NOISES
from wedgesweep.synthesize.plan import PlannedTest
from wedgesweep.synthesize.tables import loop
from wedgesweep.synthesize.transients import transient

TIME_KINDS = ("transient", "loop", "mixed", "worse", "damper", "warm", "force")
TRANSIENT, LOOP, MIXED, WORSE, DAMPER, WARM, FORCE = TIME_KINDS
MADE_WORSE = (TRANSIENT, LOOP, MIXED)
LAWS = ("coulomb", "static-dynamic")
# Effects of a sine as an input, and those that a loop cannot show.
OF_A_SINE = ("input_distortion", "stray_vibration", "fixture_resonance", "cross_slip")
NOT_IN_LOOPS = (*OF_A_SINE, "column_compliance", "displacement_gain", "velocity_lag")
HIDDEN_FORCE, PLUGIN = hidden_force.EFFECT.name, Path(hidden_force.__file__)
LOOPS_OF_FOUR = "loops of four"
# Frequency of the first loop over the natural one, and the least force that is tried over the spring's.
SLOWER, LEAST_FORCE = 0.4, 1e-4
# Of so many sets of kind ``force`` the last one hides a known effect, or none.
KNOWN_EACH = 4
# Of CLEAN_EACH sets the last one hides nothing.
CLEAN_EACH = 5
# Of a suspension of the bench's size: natural frequency (Hz), largest motion (mm) that it is released to, and
# that is imposed on it (a larger one lifts its wedges off), motion of the base in steady tests.
BENCH_HZ, BENCH_TRAVEL_MM, BENCH_IMPOSED_MM, BENCH_BASE_MM = 13.6, 1.0, 0.15, 0.6
# Of an oscillator: natural frequency (Hz), damping ratio, and friction over the spring's force at the largest
# motion.
FREQUENCY_HZ, DAMPING, FRICTION = (1.0, 8.0), (0.003, 0.02), (0.02, 0.08)
# Of a damper: damping ratio, and friction over the same force.
OF_DAMPER = (0.5, 2.0), (0.1, 0.5)
# Effects that those of dampers only are hidden beside.
NEIGHBOURS = (
    *("viscous_damping", "directional_damping", "quadratic_drag"),
    *("presliding", "damper_play", "friction_level"),
)
HIDDEN_IN = {
    DAMPER: (*ranges.OF_DAMPERS, *NEIGHBOURS),
    WARM: (*ranges.OF_TEMPERATURE, *NEIGHBOURS),
}
# Temperatures (deg C) of warm tests, which rise neither with frequency nor with amplitude.
TEMPERATURES = (65.0, 20.0, 35.0, 50.0)
# Its coefficients of friction.
STATIC, DYNAMIC = 0.36, 0.3
# Largest motion (mm) of a mass (kg), noise over the rms of a channel.
TRAVEL_MM, MASS_KG, LEVEL = (2.0, 30.0), (0.5, 20.0), (0.005, 0.02)
# Change of the response to the first release or loop over that response, and attempts to reach it.
CHANGE, ATTEMPTS = (0.05, 0.5), 60
# After SAME_EFFECT attempts the next effect takes the place of the one that is due.
SAME_EFFECT = 5
# Sampling rate, lengths of a release, a sweep and a loop in natural periods.
SAMPLED, RELEASE, SWEEP, LOOPS = 60.0, 8.0, 24.0, 20.0
# Frequencies of steady tests beside the others, over the natural one.
STEADY = (0.7, 0.9, 1.15, 1.4)


class Drawn(NamedTuple):
    """A rig, its natural frequency (Hz), and the sizes (mm) of its tests.

    ``travel``: largest motion after a release; ``imposed``: largest imposed one; ``base``: motion of the base
    in steady tests.
    """

    rig: Rig
    frequency: float
    travel: float
    imposed: float
    base: float


def draw(one: DataSet) -> dict[str, Any]:
    """Rig, tests, effect and noise of a set, as documents.

    Raises
    ------
    RuntimeError
        If no rig shows the effect as strongly as is wanted.
    """
    if one.kind == FORCE:
        plugins.load(PLUGIN)
    for attempt in range(ATTEMPTS):
        if found := _drawn(one, attempt):
            return found
    raise RuntimeError(f"{one.name}: no rig shows its effect as is wanted in {ATTEMPTS} attempts")


def _drawn(one: DataSet, attempt: int) -> dict[str, Any] | None:
    """Documents of a set; None if its effect cannot be as strong as is wanted."""
    random = one.random(attempt)
    law = LAWS[one.index % len(LAWS)]
    kind, turn = _kind_and_turn(one)
    if one.kind in HIDDEN_IN:
        drawn = _oscillator(random, *OF_DAMPER)
    elif one.kind == FORCE or not one.index // 2 % 2:
        drawn = _oscillator(random)
    else:
        drawn = _suspension(random)
    rig, tests = drawn.rig, TESTS[kind](drawn)
    planned = plan.from_document({"test": tests}).tests
    sampling_hz = round(SAMPLED * drawn.frequency, 3)
    hidden: dict[str, dict[str, float]] = {}
    effect = _effect(one, attempt, rig, kind)
    if effect:
        named = effect != HIDDEN_FORCE
        path = ranges.path(effect, random, rig.units) if named else _force(turn, kind, drawn)
        wanted = rigs.logarithmic(CHANGE, random)
        shown = next((each for each in planned if each.release_mm), planned[0])
        change = _change(rig, law, shown, sampling_hz)
        strength = reach(wanted, lambda s: change({effect: path(s)}))
        if strength is None:
            return None
        hidden[effect] = rigs.rounded(path(strength))
    others = [test for test in planned if test.kind in (TRANSIENT, LOOP)]
    if any(_response(rig, law, hidden, test, sampling_hz) is None for test in others):
        return None
    return {
        "law": law,
        "document": rig.document(law, hidden),
        "hidden": hidden,
        "tests": tests,
        "sampling_hz": sampling_hz,
        "level": round(rigs.logarithmic(LEVEL, random), 5),
        "noise": NOISES[turn % 3],
    }


def _kind_and_turn(one: DataSet) -> tuple[str, int]:
    """Kind of the tests of a set, and its place among those of its kind."""
    if one.kind == WORSE:  # each fault in all kinds of test, and then with all kinds of noise
        turn, place = divmod(worse.of(one.index).turn, len(MADE_WORSE))
        return MADE_WORSE[place], turn
    if one.kind == FORCE:  # each force in all kinds of test
        turn = one.index - one.index // KNOWN_EACH
        return (LOOPS_OF_FOUR, TRANSIENT, MIXED)[(turn + turn // len(hidden_force.NAMES)) % 3], turn
    return one.kind, one.index


def _effect(one: DataSet, attempt: int, rig: Rig, kind: str) -> str | None:
    """The effect that a set hides; None if it hides none."""
    index, each = one.index, CLEAN_EACH
    if one.kind == FORCE:
        if index % KNOWN_EACH < KNOWN_EACH - 1:
            return HIDDEN_FORCE
        index, each = index // KNOWN_EACH, 2
    if index % each == each - 1:
        return None
    left_out = NOT_IN_LOOPS if kind in (LOOP, LOOPS_OF_FOUR) else OF_A_SINE
    among = HIDDEN_IN.get(one.kind, ranges.LEADING)
    known = set(rig.possible_effects).intersection(among).difference(left_out)
    possible = [name for name in EFFECTS if name in known]
    order = np.random.default_rng([one.seed, 101]).permutation(len(possible))
    return possible[order[(index + attempt // SAME_EFFECT) % len(possible)]]


def _force(turn: int, kind: str, drawn: Drawn) -> Callable[[float], dict[str, float]]:
    """Numbers of a force that is no candidate, by its strength from 0 to 1."""
    fastest = drawn.travel * 2.0 * pi * drawn.frequency * (SLOWER if kind == LOOPS_OF_FOUR else 1.0)
    spring = drawn.rig.sections["oscillator"]["spring_N_per_mm"] * drawn.travel
    return lambda strength: {
        "force_N": spring * LEAST_FORCE ** (1.0 - strength),
        "shape": float(turn % len(hidden_force.NAMES)),
        "displacement_mm": drawn.travel,
        "velocity_mm_per_s": fastest,
    }


def _change(
    rig: Rig, law: str, test: PlannedTest, sampling_hz: float
) -> Callable[[dict[str, dict[str, float]]], float]:
    """Change of the response to a test by effects, over the response; of all channels together.

    NaN where there is no response.
    """
    base = _response(rig, law, {}, test, sampling_hz)

    def change(effects: dict[str, dict[str, float]]) -> float:
        found = _response(rig, law, effects, test, sampling_hz)
        if base is None or found is None:
            return nan
        return float(np.linalg.norm((found - base).std(axis=1) / base.std(axis=1)))

    return change


def _response(
    rig: Rig, law: str, effects: dict[str, dict[str, float]], test: PlannedTest, sampling_hz: float
) -> np.ndarray | None:
    """Channels of a transient or a loop; None where there is no response."""
    config = from_document(rig.document(law, effects))
    try:
        if test.kind == LOOP:
            acting = at_temperature(config.effects, test.temperature_C)
            return loop(config, law, acting, test, sampling_hz)[1][None]
        made = transient(config, law, config.effects, test, sampling_hz, np.random.default_rng(0))
    except NoMotion:
        return None
    return np.array([made.displacement, made.velocity])


def _suspension(random: np.random.Generator) -> Drawn:
    rig = rigs.any_size(random)
    length = rig.units.ratio(LENGTH)
    frequency = BENCH_HZ * rig.units.ratio(FREQUENCY)
    sizes = (size * length for size in (BENCH_TRAVEL_MM, BENCH_IMPOSED_MM, BENCH_BASE_MM))
    return Drawn(rig, frequency, *sizes)


def _oscillator(
    random: np.random.Generator,
    ratios: tuple[float, float] = DAMPING,
    frictions: tuple[float, float] = FRICTION,
) -> Drawn:
    frequency, travel = rigs.logarithmic(FREQUENCY_HZ, random), rigs.logarithmic(TRAVEL_MM, random)
    mass, omega = rigs.logarithmic(MASS_KG, random), 2.0 * pi * frequency
    damping, friction = rigs.logarithmic(ratios, random), rigs.logarithmic(frictions, random)
    normal_force = friction * 1e-3 * travel * mass * omega**2 / DYNAMIC
    coefficients = {"static": STATIC, "dynamic": DYNAMIC}
    threshold = {"threshold_velocity_mm_per_s": rigs.THRESHOLD * travel * omega}
    sections: rigs.Sections = {
        "oscillator": {**rigs.on_spring(mass, omega, damping, normal_force), "contact": "base"},
        "friction": {**coefficients, **rigs.rounded(threshold)},
    }
    return Drawn(Rig(sections), frequency, travel, travel, 0.25 * travel)


def _releases(drawn: Drawn) -> list[dict[str, Any]]:
    frequency, travel = drawn.frequency, drawn.travel
    length = {"kind": "transient", "duration_s": RELEASE / frequency}
    speed = 2.0 * pi * frequency * travel
    return [
        {**length, "release_mm": travel},
        {**length, "release_mm": -0.7 * travel, "release_mm_per_s": 0.2 * speed},
        {**length, "release_mm": 0.5 * travel, "release_mm_per_s": -0.3 * speed},
    ]


def _transients(drawn: Drawn) -> list[dict[str, Any]]:
    sweep = {
        "kind": "transient",
        "motion": "sweep",
        "frequency_hz": 0.5 * drawn.frequency,
        "to_hz": 2.0 * drawn.frequency,
        "amplitude_mm": 0.25 * drawn.travel,
        "duration_s": SWEEP / drawn.frequency,
    }
    return [*_releases(drawn), sweep]


def _loops(drawn: Drawn) -> list[dict[str, Any]]:
    length = {"kind": "loop", "duration_s": LOOPS / drawn.frequency}
    return [
        {**length, "frequency_hz": SLOWER * drawn.frequency, "amplitude_mm": drawn.imposed},
        {**length, "frequency_hz": 0.7 * drawn.frequency, "amplitude_mm": 0.5 * drawn.imposed},
    ]


def _four_loops(drawn: Drawn) -> list[dict[str, Any]]:
    return [
        *_loops(drawn),
        *({**each, "amplitude_mm": 0.7 * each["amplitude_mm"]} for each in _loops(drawn)),
    ]


def _warm(drawn: Drawn) -> list[dict[str, Any]]:
    return [{**each, "temperature_C": t} for each, t in zip(_four_loops(drawn), TEMPERATURES, strict=True)]


def _mixed(drawn: Drawn) -> list[dict[str, Any]]:
    steady = [
        {"frequency_hz": share * drawn.frequency, "amplitude_mm": drawn.base, "amplitude_std": 0.005}
        for share in STEADY
    ]
    return [*steady, *_releases(drawn), _loops(drawn)[0]]


TESTS = {
    **{TRANSIENT: _transients, LOOP: _loops, MIXED: _mixed, DAMPER: _loops, WARM: _warm},
    LOOPS_OF_FOUR: _four_loops,
}
