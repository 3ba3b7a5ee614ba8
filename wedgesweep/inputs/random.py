"""Random input: a sum of sines with the power spectral density that is asked for.

Their frequencies are multiples of 1/T, T the duration (``periodic``: phases are random, and the spectrum is
exact), or of 1/2T, of which the first half is taken (amplitudes are random too: Gaussian noise, which does
not repeat). The density is even within a band, or given as levels at some frequencies with straight lines
between them on logarithmic scales; the rms decides about its size.
"""

from collections.abc import Mapping
from math import pi
from typing import Any

import numpy as np

from wedgesweep.inputs.sampled import Input, faded, times
from wedgesweep.inputs.units import sized


def density(given: Mapping[str, Any], frequency: np.ndarray) -> np.ndarray:
    """One-sided density of a table [input] at some frequencies (Hz), in any unit."""
    inside = (frequency >= _band(given)[0]) & (frequency <= _band(given)[1])
    if "frequency_hz" not in given:
        return inside.astype(float)
    at = np.log(np.maximum(frequency, 1e-300))
    level = np.exp(np.interp(at, np.log(given["frequency_hz"]), np.log(given["level"])))
    return np.where(inside, level, 0.0)


def _band(given: Mapping[str, Any]) -> tuple[float, float]:
    """Lowest and highest frequency (Hz)."""
    if "frequency_hz" in given:
        return given["frequency_hz"][0], given["frequency_hz"][-1]
    return given["start_hz"], given["stop_hz"]


def made(given: Mapping[str, Any], natural: float) -> Input:
    """The input of a table [input]."""
    unit, rms = sized(given, "rms")
    highest, periodic = _band(given)[1], given["periodic"]
    t = times(given["duration_s"], highest)
    n = (t.size - 1) * (1 if periodic else 2)
    power = density(given, np.arange(n // 2 + 1) / (n * t[1]))
    generator = np.random.default_rng(given["seed"])
    turn = np.exp(2j * pi * generator.random(power.size))
    if not periodic:
        turn *= np.sqrt(generator.exponential(size=power.size))
    # A sine of amplitude a has the power a^2/2, and two lines of n a/2.
    lines = n * rms * np.sqrt(0.5 * power / power.sum()) * turn
    wave = np.fft.irfft(lines, n)[np.arange(t.size) % n]
    return Input(unit.quantity, wave * faded(t, given["fade_s"]), t[1], highest)
