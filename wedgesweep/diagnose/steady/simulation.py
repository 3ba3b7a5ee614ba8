"""Steady responses of the base model to the measured tests, each started from a neighbour's."""

from collections.abc import Sequence
from functools import lru_cache
from math import ceil, pi
from typing import NamedTuple

import numpy as np

from wedgesweep import effects
from wedgesweep.config import Config
from wedgesweep.diagnose.steady.spectra import REMOVED, SIMULATED, regressors
from wedgesweep.solvers import periodic
from wedgesweep.solvers.periodic import Warm
from wedgesweep.systems.suspension import parameters

# Errors (shares of the input amplitude, and of a step) that add nothing to the noise of 4 % data, those that
# add nothing to derivatives either; rough ones do where it is only asked from where a fit should begin.
TOLERANCE, TIGHT, ROUGH = 1e-6, 1e-8, 1e-5
MOST_PERIODS = 40
SAMPLES_PER_PERIOD = 2 * (SIMULATED + 1)
# Periods run before a response with a foreign tone is evaluated, and more from rest; over which it is where
# no record says, and of a record that is longer than need be: by then tone and input have met in all ways.
TONE_SETTLING, FROM_REST, LONG, LONGEST_SIMULATED = 10, 30, 12.0, 60.0


class Responses(NamedTuple):
    """Harmonics (n, 2, H) of displacement x - y (m) and its rate, complex, and where to go on from.

    ``found`` (n,): whether there is such a response; it has none where the wedge locks, and then NaN.
    """

    harmonics: np.ndarray
    found: np.ndarray
    warm: Warm


def records(model: Config, law: str, values: dict, omega: np.ndarray, amplitude: np.ndarray) -> np.ndarray:
    """Parameter records of some tests, shape (n,): ``omega`` (rad/s) and ``amplitude`` (m) of shape (n,)."""
    numbers = effects.merge(model.effects, values)
    one = parameters.record(law, 1.0, 1.0, model.suspension, model.friction, numbers)
    rows = np.repeat(one, omega.size)
    rows["input"]["omega"], rows["input"]["amplitude"] = omega, amplitude
    return rows


def respond(rows: np.ndarray, warm: Warm, harmonics: int, tolerance: float = TOLERANCE) -> Responses:
    """Steady responses of parameter records, shape (n,)."""
    found = periodic.respond(rows, warm, tolerance, MOST_PERIODS, SAMPLES_PER_PERIOD, harmonics, tolerance)
    return Responses(found.spectra, found.outcome == periodic.OK, found.warm)


class ToneTiming(NamedTuple):
    """How input and foreign tone met in a record, ``periods`` of the input long.

    At its first sample the input was at the phase ``start`` (rad), the tone in the displacement at ``tone``
    (rad; NaN where it does not show).
    """

    periods: float
    start: float
    tone: float


def respond_with_tone(
    rows: np.ndarray,
    warm: Warm,
    harmonics: int,
    tone: float,
    timings: Sequence[ToneTiming],
    tone_phase: np.ndarray,
    tolerance: float = TOLERANCE,
) -> Responses:
    """Responses under a foreign tone (Hz), which do not repeat: harmonics, and the tone in the last column.

    Each row as in its record, with the vibration behind the tone ``tone_phase`` (n,) of the parameters' phase
    (rad). Where that is not known (NaN), first with any phase, which tells how the response lags behind, then
    with that at which both met; if no tone shows either, a span of ``LONG`` periods stands for all ways.
    """
    rows = rows.copy()
    rows["stray_vibration"]["phase"] += np.nan_to_num(tone_phase)
    shown = np.array([timing.tone for timing in timings])
    anyhow = np.isnan(tone_phase) & np.isnan(shown)
    timings = tuple(
        each._replace(periods=LONG) if one else each for each, one in zip(timings, anyhow, strict=True)
    )
    state = warm.state
    if not np.isfinite(state).all():
        state = periodic.samples(rows, state, FROM_REST, 1, SAMPLES_PER_PERIOD, tolerance)[2]
    spectra, state = _recorded(rows, state, harmonics, tone, timings, tolerance)
    late = np.where(np.isnan(tone_phase), shown, np.nan) - np.angle(spectra[:, 0, -1])
    again = np.flatnonzero(np.isfinite(late))
    if again.size:
        rows["stray_vibration"]["phase"][again] += late[again]
        chosen = tuple(timings[i] for i in again)
        spectra[again], state[again] = _recorded(
            rows[again], state[again], harmonics, tone, chosen, tolerance
        )
    found = np.isfinite(spectra).all(axis=(1, 2))
    return Responses(spectra, found, warm._replace(state=state))


def _recorded(
    rows: np.ndarray,
    states: np.ndarray,
    harmonics: int,
    tone: float,
    timings: Sequence[ToneTiming],
    tolerance: float,
) -> tuple[np.ndarray, np.ndarray]:
    """Harmonics and tone (n, 2, H + 1) over the span of each record, from phase 0 of the input, and states.

    The tone's phase is that at the first sample of the record.
    """
    spectra = np.full((len(rows), 2, harmonics + 1), np.nan, complex)
    longest = ceil(max(timing.periods for timing in timings)) + 1
    x, velocity, state = periodic.samples(rows, states, TONE_SETTLING, longest, SAMPLES_PER_PERIOD, tolerance)
    turn = 2.0 * pi / SAMPLES_PER_PERIOD
    for i, timing in enumerate(timings):
        start = timing.start % (2.0 * pi)
        first = round(start / turn)
        count = round(timing.periods * SAMPLES_PER_PERIOD)
        ratio = 2.0 * pi * tone / float(rows["input"]["omega"][i])
        signals = -np.stack([x[i], velocity[i]])[:, first : first + count]
        found = signals @ _projection(ratio, harmonics, count).T
        found[:, :-1] *= np.exp(-1j * np.arange(1, harmonics + 1) * first * turn)
        # The grid's first sample lies a little beside that of the record.
        found[:, -1] *= np.exp(1j * ratio * (start - first * turn))
        spectra[i] = found
    return spectra, state


@lru_cache(maxsize=256)
def _projection(ratio: float, harmonics: int, samples: int) -> np.ndarray:
    """Least-squares fit of drift, harmonics and tone as a matrix (harmonics + 1, samples), complex.

    ``ratio``: the tone's frequency over the input's.
    """
    time = np.arange(samples) / SAMPLES_PER_PERIOD
    turn = np.exp(2j * pi * ratio * time)[:, None]
    matrix = np.concatenate([regressors(time, 1.0, REMOVED), turn.real, turn.imag], axis=1)
    inverse = np.linalg.pinv(matrix.T @ matrix, hermitian=True) @ matrix.T
    cosines, sines = np.r_[2 : 2 + harmonics, -2], np.r_[2 + REMOVED : 2 + REMOVED + harmonics, -1]
    return inverse[cosines] - 1j * inverse[sines]
