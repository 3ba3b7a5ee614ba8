"""A sine whose frequency moves from one end of a band to the other.

    q(t) = amplitude w(t) sin(phi(t)),   phi' = 2 pi f(t)
    linear:       f = f_0 + (f_1 - f_0) t/T          phi = 2 pi (f_0 t + (f_1 - f_0) t^2 / 2T)
    logarithmic:  f = f_0 (f_1/f_0)^(t/T)            phi = 2 pi T (f - f_0) / ln(f_1/f_0)

w fades the input in and out.
"""

from collections.abc import Mapping
from math import log, pi
from typing import Any

import numpy as np

from wedgesweep.inputs.sampled import Input, faded, times
from wedgesweep.inputs.units import sized


def frequency(given: Mapping[str, Any], t: np.ndarray) -> np.ndarray:
    """Frequency (Hz) at some times (s) of a table [input]."""
    first, last, share = given["start_hz"], given["stop_hz"], t / given["duration_s"]
    if given["rate"] == "linear":
        return first + (last - first) * share
    return first * (last / first) ** share


def phase(given: Mapping[str, Any], t: np.ndarray) -> np.ndarray:
    """Phase (rad) at some times (s)."""
    first, last, duration = given["start_hz"], given["stop_hz"], given["duration_s"]
    if given["rate"] == "linear" or first == last:
        return 2.0 * pi * (first * t + 0.5 * (last - first) * t**2 / duration)
    return 2.0 * pi * duration * (frequency(given, t) - first) / log(last / first)


def made(given: Mapping[str, Any], natural: float) -> Input:
    """The input of a table [input]."""
    unit, amplitude = sized(given, "amplitude")
    highest = max(given["start_hz"], given["stop_hz"])
    t = times(given["duration_s"], highest)
    wave = amplitude * faded(t, given["fade_s"]) * np.sin(phase(given, t))
    return Input(unit.quantity, wave, t[1], highest)
