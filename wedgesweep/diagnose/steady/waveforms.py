"""One period of measured and simulated signals, and what an engineer reads from it."""

from math import pi

import numpy as np
from scipy.optimize import root_scalar

from wedgesweep.diagnose.steady.accelerations import accelerations
from wedgesweep.diagnose.steady.fit_data import FitData
from wedgesweep.diagnose.steady.model import Fit
from wedgesweep.diagnose.steady.simulation import records
from wedgesweep.effects import EFFECTS, acting
from wedgesweep.systems.suspension.parameters import compact, driven_mass, has_own_mechanics, moving_mass

PHASES = 256
# A harmonic counts as far as its square is above this many times its noise.
ABOVE_NOISE = 4.0
# First guess at the mean of a motion, over its peak-to-peak.
FIRST_PLACE = 0.01
# Effects after the mechanics.
SENSOR = tuple(name for name, effect in EFFECTS.items() if effect.family == "sensor")
# A plateau is where the velocity stays below this share of its peak.
DWELL = 0.05


def waveform(harmonics: np.ndarray) -> np.ndarray:
    """Signals (..., PHASES) over one period of harmonics (..., H), from phase 0, their mean taken out."""
    phase = 2.0 * pi * np.arange(PHASES) / PHASES
    turn = np.exp(1j * np.outer(np.arange(1, harmonics.shape[-1] + 1), phase))
    return (harmonics @ turn).real


def measured_from_phase_zero(fit: Fit) -> np.ndarray:
    """Measured harmonics (T, C, H), a tone and images left out, turned to phase 0 of the input of a fit."""
    data, evaluation = fit.model.data, fit.evaluation
    return data.rotated(data.measured - evaluation.aliases, -evaluation.phase)[..., : data.shape[1]]


def velocity(data: FitData, harmonics: np.ndarray) -> np.ndarray:
    """Velocity harmonics (T, H), from the displacement where there is no velocity channel."""
    derived = 1j * data.omega[:, None] * data.orders * harmonics[:, 0]
    return np.where(_has_velocity(data), harmonics[:, -1], derived)


def _has_velocity(data: FitData) -> np.ndarray:
    """Whether (T, 1) tests have a velocity channel."""
    return np.array([[s.mean.shape[0] == 2] for s in data.spectra])


def peak_to_peak(displacement: np.ndarray) -> np.ndarray:
    """Of waveforms (T, PHASES), shape (T,)."""
    return np.ptp(displacement, axis=-1)


def dwell(rate: np.ndarray) -> np.ndarray:
    """Share of the period (T,) in which waveforms (T, PHASES) of velocity are nearly zero."""
    return (np.abs(rate) < DWELL * np.abs(rate).max(axis=-1, keepdims=True)).mean(axis=-1)


def input_energy(fit: Fit, fundamental: np.ndarray) -> np.ndarray:
    """Energy (J, shape (T,)) that the base puts in per period, from the displacement's fundamental (T,).

    Amplitudes and the mass that moves are the fit's. So must be the phase of a fundamental that was measured:
    no record tells the input's. It is the work of the inertia forces that PHYSICS.md balances with friction,
    pi m a omega^2 Re D_1. NaN where the base is not what the data are relative to.
    """
    one = _rows(fit)
    fundamental = fundamental / one["displacement_gain"]["scale"]
    fundamental = np.where(one["fixture_resonance"]["frequency"] > 0.0, np.nan, fundamental)
    given = one["input"]
    return pi * driven_mass(one) * given["amplitude"] * given["omega"] ** 2 * fundamental.real


def residual_force(fit: Fit, harmonics: np.ndarray) -> np.ndarray:
    """Force on the bolster (N, shape (T, PHASES)) that the measured motion has and the model lacks.

    The measured acceleration less that of the model in the same state, times the mass that moves. Both in
    the harmonics that stand above the noise: the others, times omega^2 h^2, would hide the force. The
    bolster's mean place, which no test tells, is where the model has no mean acceleration. NaN for a model
    with effects that need the extended mechanics, or on the sensors: what those do depends on more than the
    motion, or the channels are not the motion.
    """
    data, rows = fit.model.data, _rows(fit)
    if has_own_mechanics(rows).any() or set(acting(data.model.effects)) & set(SENSOR):
        return np.full((data.tests, PHASES), np.nan)
    heard = _wiener_weight(data)
    rate = velocity(data, harmonics)
    x, v = -waveform(heard * harmonics[:, 0]), -waveform(heard * rate)
    model = np.array([_in_place(rows[t : t + 1], x[t], v[t]) for t in range(data.tests)])
    simulated = 2.0 / PHASES * np.fft.rfft(model)[:, 1 : data.shape[1] + 1]
    measured = -1j * data.omega[:, None] * data.orders * rate
    return moving_mass(rows)[:, None] * waveform(heard * (measured - simulated))


def _in_place(one: np.ndarray, x: np.ndarray, v: np.ndarray) -> np.ndarray:
    """The model's acceleration about the mean place at which it averages to zero."""
    acceleration, small = np.zeros_like(x), compact(one)
    if not x.any():  # nothing was heard of the motion: no force is left either
        return acceleration

    def mean(place: float) -> float:
        accelerations(small, x + place, v, acceleration)
        return float(acceleration.mean())

    place = root_scalar(mean, x0=0.0, x1=FIRST_PLACE * np.ptp(x), method="secant", maxiter=20).root
    mean(place)
    return acceleration


def _wiener_weight(data: FitData) -> np.ndarray:
    """Share (T, H) of the harmonics of the velocity that is no noise, by Wiener's rule."""
    above = 0.5 * (np.abs(data.measured) * data.weight)[..., : data.shape[1]] ** 2
    share = 1.0 - ABOVE_NOISE / np.maximum(above, ABOVE_NOISE)
    return np.where(_has_velocity(data), share[:, -1], share[:, 0])


def _rows(fit: Fit) -> np.ndarray:
    data = fit.model.data
    values = fit.model.values(fit.x)
    return records(data.model, data.law, values, data.omega, fit.amplitudes())
