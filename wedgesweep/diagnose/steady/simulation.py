"""Simulated steady responses of the measured tests, each started from that of a neighbour."""

from collections.abc import Sequence
from functools import lru_cache
from math import ceil, pi
from typing import NamedTuple

import numpy as np

from wedgesweep import effects, systems
from wedgesweep.config import Config
from wedgesweep.diagnose import work
from wedgesweep.diagnose.fit_parameters import Values
from wedgesweep.diagnose.model import TOLERANCE
from wedgesweep.diagnose.steady import column_load
from wedgesweep.diagnose.steady.harmonic_fit import REMOVED, regressors
from wedgesweep.diagnose.steady.spectra import SIMULATED
from wedgesweep.excitation import has_series
from wedgesweep.solvers import periodic
from wedgesweep.solvers.periodic import Warm

# Periods after which a response that has not repeated counts as not periodic: of 4,000 random cases 15 in a
# thousand settle later (on a compliant column they creep for thousands of them), of 600 with impacts 4 in a
# hundred, if they settle at all.
MOST_PERIODS, MOST_WITH_IMPACTS = 60, 120
SAMPLES_PER_PERIOD = 2 * (SIMULATED + 1)
# Periods run before a response under a spurious tone is evaluated, and further ones if it starts at rest.
TONE_SETTLING, FROM_REST = 10, 30
# Periods over which such a response is evaluated if the relative timing of tone and input is unknown, and at
# most: by then all relative phases have occurred.
UNTIMED, LONGEST_SIMULATED = 12.0, 60.0
# Work (see work.py) of a case beside its periods; factors of the work of a period, with mechanics of an
# effect's own and under a recorded input.
WORK_OF_CASE, WORK_OF_OWN_MECHANICS, WORK_UNDER_SERIES = 3.0, 3.0, 1.7


class Responses(NamedTuple):
    """Complex harmonics (n, 2, H) of displacement x - y (m) and its rate, and where to start neighbours from.

    With the column's load (n, 3, H + 1): it is the third channel, and its mean (N) the last column.
    ``found`` (n,): whether a response exists; it does not where the wedge locks, and harmonics are NaN then.
    """

    harmonics: np.ndarray
    found: np.ndarray
    warm: Warm


def records(model: Config, law: str, values: Values, omega: np.ndarray, amplitude: np.ndarray) -> np.ndarray:
    """Parameter records (n,) of tests with given angular frequencies (rad/s) and input amplitudes (m)."""
    numbers = effects.merge(model.effects, values)
    rows = np.repeat(model.record_with(numbers, law), omega.size)
    rows["input"]["omega"], rows["input"]["amplitude"] = omega, amplitude
    return rows


def respond(
    rows: np.ndarray, warm: Warm, harmonics: int, tolerance: float = TOLERANCE, load: bool = False
) -> Responses:
    """Steady responses to parameter records (n,), if wanted with the load of the column."""
    opens = systems.opens(rows).any()
    accuracy = periodic.Accuracy(tolerance, MOST_WITH_IMPACTS if opens else MOST_PERIODS, rtol=tolerance)
    samples = column_load.SAMPLES_PER_PERIOD if load else SAMPLES_PER_PERIOD
    found = periodic.respond(rows, warm, accuracy, samples, harmonics, load=load)
    _count(rows, found.periods)
    spectra = column_load.joined(rows, found.spectra, found.load) if load else found.spectra
    return Responses(spectra, found.outcome == periodic.OK, found.warm)


def sticks(rows: np.ndarray) -> np.ndarray:
    """Whether (n,) set-valued friction holds the mass for a part of the steady responses to records (n,)."""
    accuracy = periodic.Accuracy(TOLERANCE, MOST_PERIODS, rtol=TOLERANCE)
    found = periodic.respond(rows, periodic.at_rest(len(rows)), accuracy, SAMPLES_PER_PERIOD, 1)
    _count(rows, found.periods)
    return (found.stuck > 0.0) & (rows["friction"]["set_valued"] != 0)


def _count(rows: np.ndarray, periods: np.ndarray | int) -> None:
    """Count the work of simulated cases (n,) over a number of periods (n,)."""
    weight = np.where(systems.has_own_mechanics(rows), WORK_OF_OWN_MECHANICS, 1.0)
    weight *= np.where(has_series(rows), WORK_UNDER_SERIES, 1.0)
    work.add(float((WORK_OF_CASE + weight * periods).sum()))


class ToneTiming(NamedTuple):
    """Relative timing of input and spurious tone in a record.

    ``periods``: its length in periods of the input. The phases (rad) are those at its first sample, of the
    input and of the tone in the displacement (NaN if it does not show).
    """

    periods: float
    input_phase: float
    tone_phase: float


def respond_with_tone(
    rows: np.ndarray,
    warm: Warm,
    harmonics: int,
    tone: float,
    timings: Sequence[ToneTiming],
    tolerance: float = TOLERANCE,
) -> Responses:
    """Responses under a spurious tone, which do not repeat; the tone is the last column of the harmonics.

    A response is simulated twice: with any phase of the vibration, which shows its lag, and then with the
    phase that gives the measured one. If the record does not show the tone, the response is averaged over
    UNTIMED periods.

    Parameters
    ----------
    rows : ndarray, shape (n,)
        Parameter records.
    warm : Warm, n rows
        Where to start from.
    harmonics : int
        Number of harmonics H.
    tone : float
        Frequency of the tone in Hz.
    timings : sequence of ToneTiming, n of them
        Timing of each record.
    tolerance : float
        Relative tolerance.
    """
    rows = rows.copy()
    measured = np.array([timing.tone_phase for timing in timings])
    untimed = np.isnan(measured)
    timings = tuple(
        each._replace(periods=UNTIMED) if one else each for each, one in zip(timings, untimed, strict=True)
    )
    state = warm.state
    if not np.isfinite(state).all():
        state = periodic.sampled(rows, state, FROM_REST, 1, SAMPLES_PER_PERIOD, tolerance).state
        _count(rows, FROM_REST + 1)
    spectra, state = _recorded(rows, state, harmonics, tone, timings, tolerance)
    lag = measured - np.angle(spectra[:, 0, -1])
    again = np.flatnonzero(np.isfinite(lag))
    if again.size:
        rows["stray_vibration"]["phase"][again] += lag[again]
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
    """Harmonics and tone (n, 2, H + 1) over the span of each record, and final states.

    Harmonics are from phase 0 of the input; the tone's phase is that at the first sample of the record.
    """
    spectra = np.full((len(rows), 2, harmonics + 1), np.nan, complex)
    longest = ceil(max(timing.periods for timing in timings)) + 1
    run = periodic.sampled(rows, states, TONE_SETTLING, longest, SAMPLES_PER_PERIOD, tolerance)
    _count(rows, TONE_SETTLING + longest)
    turn = 2.0 * pi / SAMPLES_PER_PERIOD
    for i, timing in enumerate(timings):
        start = timing.input_phase % (2.0 * pi)
        first = round(start / turn)
        count = round(timing.periods * SAMPLES_PER_PERIOD)
        ratio = 2.0 * pi * tone / float(rows["input"]["omega"][i])
        signals = -np.stack([run.x[i], run.velocity[i]])[:, first : first + count]
        found = signals @ _projection(ratio, harmonics, count).T
        found[:, :-1] *= np.exp(-1j * np.arange(1, harmonics + 1) * first * turn)
        # The first sample of the grid lies a little beside that of the record.
        found[:, -1] *= np.exp(1j * ratio * (start - first * turn))
        spectra[i] = found
    return spectra, run.state


@lru_cache(maxsize=256)
def _projection(ratio: float, harmonics: int, samples: int) -> np.ndarray:
    """Least-squares fit of drift, harmonics and tone as a complex matrix (harmonics + 1, samples).

    ``ratio``: frequency of the tone over that of the input.
    """
    time = np.arange(samples) / SAMPLES_PER_PERIOD
    turn = np.exp(2j * pi * ratio * time)[:, None]
    matrix = np.concatenate([regressors(time, 1.0, REMOVED), turn.real, turn.imag], axis=1)
    inverse = np.linalg.pinv(matrix.T @ matrix, hermitian=True) @ matrix.T
    cosines, sines = np.r_[2 : 2 + harmonics, -2], np.r_[2 + REMOVED : 2 + REMOVED + harmonics, -1]
    return inverse[cosines] - 1j * inverse[sines]
