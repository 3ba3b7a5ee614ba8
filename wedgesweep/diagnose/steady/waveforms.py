"""One period of measured and simulated signals, and what an engineer reads from it."""

from math import pi
from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import newton

from wedgesweep.compiled import compiled
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.steady.column_load import CHANNEL
from wedgesweep.diagnose.steady.whitened import PHASES
from wedgesweep.effects import EFFECTS, acting
from wedgesweep.excitation import has_series
from wedgesweep.hybrid.interface import cycle, initial_mode, rate
from wedgesweep.systems import compact, driven_mass, has_own_mechanics, is_oscillator, moving_mass

if TYPE_CHECKING:
    from wedgesweep.diagnose.steady.harmonic_data import HarmonicData

# A harmonic counts by the share of its square that exceeds this many times its noise.
ABOVE_NOISE = 4.0
# Effects of sensors.
SENSOR = tuple(name for name, effect in EFFECTS.items() if effect.family == "sensor")
# A dwell is where the velocity stays below this share of its peak.
DWELL = 0.05


def waveform(harmonics: np.ndarray) -> np.ndarray:
    """Signals (..., PHASES) over one period of harmonics (..., H), from phase 0, without their mean."""
    phase = 2.0 * pi * np.arange(PHASES) / PHASES
    turn = np.exp(1j * np.outer(np.arange(1, harmonics.shape[-1] + 1), phase))
    return (harmonics @ turn).real


def measured_from_phase_zero(data: "HarmonicData", fit: Fit) -> np.ndarray:
    """Measured harmonics (T, C, H) of the motion without tone and aliases, from phase 0 of a fit's input."""
    response = fit.evaluation.response
    measured = data.rotated(data.measured - response.aliases, -response.phase)
    return measured[:, :CHANNEL, : data.shape[1]]


def velocity(data: "HarmonicData", harmonics: np.ndarray) -> np.ndarray:
    """Velocity harmonics (T, H), from the displacement if there is no velocity channel."""
    derived = 1j * data.omega[:, None] * data.orders * harmonics[:, 0]
    return np.where(_has_velocity(data), harmonics[:, -1], derived)


def _has_velocity(data: "HarmonicData") -> np.ndarray:
    """Whether (T, 1) tests have a velocity channel."""
    return np.array([[s.mean.shape[0] == 2] for s in data.spectra])


def peak_to_peak(displacement: np.ndarray) -> np.ndarray:
    """Peak-to-peak (..., T) of waveforms (..., T, PHASES)."""
    return np.ptp(displacement, axis=-1)


def dwell(velocities: np.ndarray) -> np.ndarray:
    """Share of the period (T,) in which waveforms (T, PHASES) of velocity are nearly zero."""
    speed = np.abs(velocities)
    return (speed < DWELL * speed.max(axis=-1, keepdims=True)).mean(axis=-1)


def input_energy(data: "HarmonicData", fit: Fit, fundamental: np.ndarray) -> np.ndarray:
    """Energy (J) that the input puts in per period, shape (T,).

    On a moving base it is the work of the force of inertia, which friction dissipates: pi m a omega^2 Re D_1,
    with the amplitude a and the moving mass m of the fit. A force on the mass takes the place of m a omega^2.
    NaN where the data are not relative to the base, and where the input is not a sine.

    Parameters
    ----------
    data : HarmonicData
        The measured tests.
    fit : Fit
        Any fit to them.
    fundamental : ndarray, shape (T,)
        Complex fundamental of the displacement; a measured one from phase 0 of the input of this fit.
    """
    rows = _rows(data, fit)
    fundamental = fundamental / rows["displacement_gain"]["scale"]
    if "fixture_resonance" in (rows.dtype.names or ()):
        fundamental = np.where(rows["fixture_resonance"]["frequency"] > 0.0, np.nan, fundamental)
    amplitude = rows["input_gain"]["scale"] * rows["input"]["amplitude"]
    force = driven_mass(rows) * amplitude * rows["input"]["omega"] ** 2
    if is_oscillator(rows):
        # Its displacement is that of the mass, and what rubs on the ground is not driven by inertia.
        forced = rows["oscillator"]["forced"] != 0
        driven = forced | (rows["oscillator"]["absolute"] == 0)
        fundamental = np.where(driven, -fundamental, np.nan)
        force = np.where(forced, amplitude, force)
    return np.where(has_series(rows), np.nan, pi * force * fundamental.real)


def residual_force(data: "HarmonicData", fit: Fit, harmonics: np.ndarray) -> np.ndarray:
    """Force on the bolster that the model lacks (restoring-force method), N, shape (T, PHASES).

    This is the measured acceleration less that of the model in the same state, times the moving mass. Both
    are weighted by harmonic (Wiener), as noise times omega^2 h^2 would hide the force. The mean position of
    the bolster, which no test shows, is where the model has no mean acceleration. NaN for a model with
    effects whose mechanics depend on more than the motion, or that act on the sensors and so hide it.

    Parameters
    ----------
    data : HarmonicData
        The measured tests.
    fit : Fit
        Fit of the model in question.
    harmonics : ndarray, shape (T, C, H)
        Measured harmonics from phase 0 of the input of this fit.
    """
    rows = _rows(data, fit)
    if has_own_mechanics(rows).any() or set(acting(data.model.effects)) & set(SENSOR):
        return np.full((data.tests, PHASES), np.nan)
    weight = _wiener_weight(data)
    # A suspension's displacement is that of the side frame against the bolster.
    sign = 1.0 if is_oscillator(rows) else -1.0
    rate = velocity(data, harmonics)
    x, v = sign * waveform(weight * harmonics[:, 0]), sign * waveform(weight * rate)
    model = np.array([_about_mean_position(rows[t : t + 1], x[t], v[t]) for t in range(data.tests)])
    simulated = 2.0 / PHASES * np.fft.rfft(model)[:, 1 : data.shape[1] + 1]
    measured = sign * 1j * data.omega[:, None] * data.orders * rate
    return moving_mass(rows)[:, None] * waveform(weight * (measured - simulated))


def _about_mean_position(row: np.ndarray, x: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Acceleration (PHASES,) of the model in the states of a motion x, v about a mean position.

    The mean position is that at which the acceleration averages to zero. ``row``: parameter record, (1,).
    """
    acceleration, small = np.zeros_like(x), compact(row)
    if not x.any():  # no motion above the noise, and so no force
        return acceleration

    def mean(position: float) -> float:
        accelerations(small, x + position, v, acceleration)
        return float(acceleration.mean())

    mean(newton(mean, 0.0, maxiter=20, disp=False))
    return acceleration


@compiled
def accelerations(parameters: np.ndarray, x: np.ndarray, v: np.ndarray, out: np.ndarray) -> None:
    """Write z'' (m/s^2) of the model in states x (m) and v (m/s), even over one period from phase 0.

    ``parameters``: a record of the base model, shape (1,); a bolster that friction holds has none.
    """
    p = parameters[0]
    for i in range(x.size):
        t = cycle(p) * i / x.size
        mode, _ = initial_mode(t, (x[i], v[i]), p)
        out[i] = rate(t, (x[i], v[i]), mode, p)[0][1]


def _wiener_weight(data: "HarmonicData") -> np.ndarray:
    """Share (T, H) of the harmonics of the velocity that is not noise, by Wiener's rule."""
    above = 0.5 * (np.abs(data.measured) * data.weight)[..., : data.shape[1]] ** 2
    share = 1.0 - ABOVE_NOISE / np.maximum(above, ABOVE_NOISE)
    return np.where(_has_velocity(data), share[:, :CHANNEL][:, -1], share[:, 0])


def _rows(data: "HarmonicData", fit: Fit) -> np.ndarray:
    """Parameter records (T,) of a fit."""
    return data.records(fit.model.scenario(fit.point))
