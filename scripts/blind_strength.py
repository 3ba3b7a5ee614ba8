"""Excess chi-squared that a hidden effect will have, estimated without noise and before any data are made."""

from collections.abc import Callable
from math import pi

import numpy as np
from blind_bench import Test, records

from wedgesweep.config import Config
from wedgesweep.diagnose.search import Search
from wedgesweep.diagnose.steady import simulation
from wedgesweep.diagnose.steady.fit_data import FitData
from wedgesweep.diagnose.steady.spectra import COMPARED, Spectrum, tone_position, within_band
from wedgesweep.solvers.periodic import at_rest
from wedgesweep.synthesize.noise import AR1_CORRELATION

PERIODS, SAMPLING_HZ = 8.4, 2000.0
TONE = "stray_vibration"
STANDS_STILL = 1e-3  # of the input amplitude
# Shares of a path that are looked at first, and how close the excess must come (in its logarithm).
FIRST, CLOSE = 13, 0.05


def harmonics(system: Config, law: str, tests: list[Test]) -> tuple[np.ndarray | None, float | None]:
    """Steady responses (T, 2, H) of the true system, a foreign tone as one more column, and its frequency.

    None in their place where one does not exist or does not move.
    """
    rows, cold = records(system, law, tests), at_rest(len(tests))
    if TONE in system.effects:
        tone = system.effects[TONE]["frequency"]
        # How tone and input meet is drawn later, with the data.
        anyhow = (simulation.ToneTiming(PERIODS, 0.0, np.nan),) * len(tests)
        unknown = np.full(len(tests), np.nan)
        done = simulation.respond_with_tone(rows, cold, COMPARED, tone, anyhow, unknown)
    else:
        tone, done = None, simulation.respond(rows, cold, COMPARED)
    moves = np.abs(done.harmonics[:, 0, 0]) > STANDS_STILL * rows["amplitude"]
    return (done.harmonics if (done.found & moves).all() else None), tone


def _variance(at: np.ndarray, rms: float, samples: int, noise: str, level: float) -> np.ndarray:
    """Of one complex harmonic at some frequencies (Hz)."""
    sampled = level * rms * (0.5 if noise == "adc" else 1.0)
    shape = np.ones(at.size)
    if noise == "ar1":
        r, turn = AR1_CORRELATION, 2.0 * pi * at / SAMPLING_HZ
        shape = (1.0 - r * r) / (1.0 - 2.0 * r * np.cos(turn) + r * r)
    return 4.0 / samples * sampled**2 * shape


def _spectrum(mean: np.ndarray, frequency: float, tone: float | None, noise: str, level: float) -> Spectrum:
    """A record as it would be without noise, but knowing its noise."""
    samples = round(PERIODS / frequency * SAMPLING_HZ)
    count = within_band(COMPARED, frequency, 1.0 / SAMPLING_HZ)
    told, covered = (
        (False, None) if tone is None else tone_position(tone, frequency, PERIODS / frequency, count)
    )
    columns = [*range(count), *([mean.shape[1] - 1] if told else [])]
    channels = 1 if noise == "differentiated" else 2
    mean = mean[:channels, columns]
    at = np.r_[frequency * np.arange(1, count + 1), [tone] if told else []]
    rms = np.sqrt(0.5 * (np.abs(mean) ** 2).sum(axis=1))
    variance = np.array([_variance(at, one, samples, noise, level) for one in rms])
    nothing = np.zeros((channels, 0))
    return Spectrum(
        frequency,
        PERIODS,
        samples,
        1.0 / SAMPLING_HZ,
        mean,
        variance,
        0j,
        nothing,
        (),
        tone if told else None,
        covered,
    )


def excess(
    mean: np.ndarray | None,
    tone: float | None,
    model: Config,
    law: str,
    tests: list[Test],
    spread: float | None,
    uncertain: dict[str, float],
    noise: str,
    level: float,
) -> float:
    """Squared misfit over noise that ``model`` leaves of true responses; ``spread`` None: unknown amplitudes.

    Infinite where a response does not exist.
    """
    if mean is None:
        return np.inf
    spectra = tuple(
        _spectrum(each, test.frequency_hz, tone, noise, level) for each, test in zip(mean, tests, strict=True)
    )
    told = 1e-3 * np.array([test.amplitude_mm for test in tests])
    data = FitData(
        model,
        law,
        tuple(f"test {i}" for i in range(len(tests))),
        spectra,
        told if spread is not None else np.full(len(tests), np.nan),
        np.full(len(tests), np.inf if spread is None else spread),
        uncertain,
        tone,
    )
    return Search(data, ()).base().fit.chi2


def reach(target: float, excess_at: Callable[[float], float]) -> float | None:
    """Share s of a path at which the excess is the target, None where it never is.

    The excess need not grow all along the path: the first crossing from below counts.
    """
    last, low = 0.0, 0.0
    for s in np.linspace(0.0, 1.0, FIRST):
        found = excess_at(s)
        if found > target:
            return None if s == 0.0 else _bisect(target, excess_at, low, float(s))
        last, low = found, float(s)
    return low if last > np.exp(-CLOSE) * target else None


def _bisect(target: float, excess_at: Callable[[float], float], low: float, high: float) -> float | None:
    for _ in range(14):
        middle = 0.5 * (low + high)
        found = excess_at(middle)
        if abs(np.log(max(found, 1e-300) / target)) < CLOSE:
            return middle
        low, high = (middle, high) if found < target else (low, middle)
    # A jump of the response: only weaker or far stronger ones exist.
    return None
