"""The measured motion of all kinds of test, as the displacement and velocity that forces depend on."""

from typing import Any, NamedTuple

import numpy as np

from wedgesweep.diagnose.loop.loop_data import LoopData
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.steady import waveforms
from wedgesweep.diagnose.steady.harmonic_data import HarmonicData


class Motion(NamedTuple):
    """Samples (n,) of displacement (m) and velocity (m/s) as the system holds them."""

    displacement: np.ndarray
    velocity: np.ndarray


def motion(fit: Fit) -> Motion:
    """Samples of all tests of a fit."""
    data = fit.model.data
    found = _joined([_of_part(each, each.model.data) for each in data.fits(fit)])
    # A suspension's sensors show minus its state.
    sign = 1.0 if data.model.system == "oscillator" else -1.0
    return Motion(sign * found.displacement, sign * found.velocity)


def _of_part(fit: Fit, data: Any) -> Motion:
    """Samples of tests of one kind, as sensors show them."""
    if isinstance(data, HarmonicData):
        harmonics = waveforms.measured_from_phase_zero(data, fit)
        rate = waveforms.waveform(waveforms.velocity(data, harmonics))
        return Motion(waveforms.waveform(harmonics[:, 0]).ravel(), rate.ravel())
    if isinstance(data, LoopData):
        numbers = sorted({number for number, _ in data.chosen})
        own = [data.recordings[number].motion for number in numbers]
        return _joined([Motion(each.displacement, each.velocity) for each in own])
    return _joined([_of_window(each) for each in data.windows])


def _of_window(window: Any) -> Motion:
    """The motion of a window by its lowest derivatives; what no sensor shows comes from the one beside it."""
    by_order = dict(zip(window.orders, window.channels, strict=True))
    step = window.step
    velocity = by_order.get(1)
    if velocity is None and 0 in by_order:
        velocity = np.gradient(by_order[0], step)
    if velocity is None:
        velocity = _integrated(by_order[2], step)
    return Motion(by_order.get(0, _integrated(velocity, step)), velocity)


def _integrated(rate: np.ndarray, step: float) -> np.ndarray:
    found = np.cumsum(rate - rate.mean()) * step
    return np.asarray(found - found.mean())


def _joined(parts: list[Motion]) -> Motion:
    return Motion(*(np.concatenate(each) for each in zip(*parts, strict=True)))


def largest_force(fit: Fit, moved: Motion) -> float:
    """The largest force (N) in the tests: as recorded, or of spring and inertia in their motion."""
    loops = [part for part in fit.model.data.parts if isinstance(part, LoopData)]
    recorded = [0.5 * float(np.ptp(own.force)) for part in loops for own in part.recordings]
    units = fit.model.data.units
    place, speed = (float(np.abs(each).max()) for each in moved)
    return max(units.mass * max(speed**2 / place, place / units.time**2), *recorded, 0.0)
