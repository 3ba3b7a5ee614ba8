"""A step of phase in a steady record: samples were lost, or stored twice, while the time stamps went on."""

from dataclasses import dataclass

import numpy as np

from wedgesweep.measured.cycles import FIRST_HARMONICS

# Numbers of lost samples that are tried; -1 is one that was stored twice.
LOST = (1, 2, 3, -1)
# Places that are tried in a record, and around the best of them in each of ROUNDS; samples that are fitted.
PLACES, ROUNDS, FITTED = 48, 3, 4000


@dataclass(frozen=True)
class PhaseStep:
    """Samples lost after a time (s), and the std of what a periodic signal with that step leaves."""

    lost: int
    time: float
    left: float


def find_step(time: np.ndarray, signal: np.ndarray, frequency: float) -> PhaseStep:
    """The step that makes a signal (n,) over even times (n,) in s most periodic at a frequency (Hz)."""
    step = (time[-1] - time[0]) / (time.size - 1)
    every = -(-time.size // FITTED)
    time, signal = time[::every], signal[::every]
    orders = FIRST_HARMONICS[FIRST_HARMONICS * frequency * step < 0.25]
    best = PhaseStep(0, float(time[0]), _left(time, signal, frequency, orders))
    for lost in LOST:
        places = np.linspace(0, time.size - 1, PLACES + 2).astype(int)[1:-1]
        for _ in range(ROUNDS):
            moved = (time + lost * step * (np.arange(time.size) > place) for place in places)
            left = [_left(times, signal, frequency, orders) for times in moved]
            place = int(places[int(np.argmin(left))])
            best = min(best, PhaseStep(lost, float(time[place]), min(left)), key=lambda found: found.left)
            reach = int(places[1] - places[0]) if places.size > 1 else 1
            around = np.arange(place - reach, place + reach + 1, max(reach // 8, 1))
            places = np.unique(np.clip(around, 0, time.size - 2))
    return best


def _left(time: np.ndarray, signal: np.ndarray, frequency: float, orders: np.ndarray) -> float:
    """Std of a signal without its harmonics."""
    waves = np.exp(2j * np.pi * frequency * np.outer(time, orders))
    design = np.hstack([np.ones((time.size, 1)), waves.real, waves.imag])
    fitted = design @ np.linalg.solve(design.T @ design, design.T @ signal)
    freedom = max(time.size - design.shape[1], 1)
    return float(np.linalg.norm(signal - fitted) / np.sqrt(freedom))
