"""What is read from the waveform of a self-excited stick-slip oscillation."""

from typing import NamedTuple

import numpy as np

# Last samples of slip from which its end is extrapolated; first and last of its first ones, and the degree of
# the polynomial through these.
FITTED = 6
SKIPPED, BEGINNING, DEGREE = 10, 300, 5


class Cycle(NamedTuple):
    """A stick-slip cycle: times in s, displacements in m."""

    period: float
    slip: float
    stick: float
    sticks_from: float
    highest: float
    lowest: float


def measured(t: np.ndarray, x: np.ndarray, velocity: np.ndarray, stuck: np.ndarray, belt: float) -> Cycle:
    """Take the first whole cycle from evenly sampled motion, shape (n,), on a belt (m/s).

    Slip ends between two samples: where its velocity, extrapolated, is the belt's. It begins from zero
    acceleration, as friction is continuous there, so that the root of the slip velocity is extrapolated.
    """
    stuck = stuck.astype(bool)
    onsets = np.flatnonzero(stuck[1:] & ~stuck[:-1]) + 1
    releases = np.flatnonzero(~stuck[1:] & stuck[:-1]) + 1
    first, second = onsets[0], onsets[1]
    release = releases[releases > first][0]
    begin, end = (_end_of_slip(t, velocity, place, belt) for place in (first, second))
    sticks_from = x[first] - belt * (t[first] - begin)
    slips = _start_of_slip(t, velocity, release, belt)
    # Extremes lie between samples, where the velocity is zero.
    inside = slice(first, second)
    return Cycle(
        end - begin,
        end - slips,
        slips - begin,
        float(sticks_from),
        _extreme(t[inside], x[inside], velocity[inside], 1.0),
        _extreme(t[inside], x[inside], velocity[inside], -1.0),
    )


def _end_of_slip(t: np.ndarray, velocity: np.ndarray, place: int, belt: float) -> float:
    """Time at which the velocity of slip, extrapolated past the last sample, reaches the belt's."""
    near = slice(place - FITTED, place)
    return _crossing(t[near] - t[place], velocity[near] - belt, 3) + t[place]


def _start_of_slip(t: np.ndarray, velocity: np.ndarray, place: int, belt: float) -> float:
    """Time at which slip began, from its first samples but those that are mostly rounding."""
    near = slice(place + SKIPPED, place + BEGINNING)
    return _crossing(t[near] - t[place], np.sqrt(np.abs(velocity[near] - belt)), DEGREE) + t[place]


def _crossing(t: np.ndarray, values: np.ndarray, degree: int) -> float:
    """Time at which a polynomial fitted to values is zero, the one nearest to t = 0."""
    scale = np.abs(t).max()
    roots = np.roots(np.polyfit(t / scale, values, degree))
    real = roots[np.abs(roots.imag) < 1e-6].real
    return float(real[np.abs(real).argmin()] * scale)


def _extreme(t: np.ndarray, x: np.ndarray, velocity: np.ndarray, sign: float) -> float:
    """Largest or smallest displacement of a motion, on the parabola through the samples around it."""
    place = int((sign * x).argmax())
    near = slice(max(place - 2, 0), place + 3)
    middle = t[place]
    fit = np.polyfit(t[near] - middle, x[near], 2)
    return float(fit[2] - fit[1] ** 2 / (4.0 * fit[0]))
