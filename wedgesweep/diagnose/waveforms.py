"""One period of measured and simulated signals, and what an engineer reads from it."""

from math import pi

import numpy as np

from wedgesweep import contact as contacts
from wedgesweep.compiled import compiled
from wedgesweep.damper import Contact
from wedgesweep.diagnose.fit import Fit
from wedgesweep.diagnose.problem import Problem
from wedgesweep.diagnose.simulation import records

PHASES = 256
# A plateau is where the velocity stays below this share of its peak.
PLATEAU = 0.05


def waveform(harmonics: np.ndarray) -> np.ndarray:
    """Signals (..., PHASES) over one period of harmonics (..., H), from phase 0, their mean taken out."""
    phase = 2.0 * pi * np.arange(PHASES) / PHASES
    turn = np.exp(1j * np.outer(np.arange(1, harmonics.shape[-1] + 1), phase))
    return (harmonics @ turn).real


def measured_from_phase_zero(fit: Fit) -> np.ndarray:
    """Measured harmonics (T, C, H), a tone left out, turned to phase 0 of the input as a fit found it."""
    problem = fit.model.problem
    return problem.turned(problem.measured, -fit.trial.phase)[..., : problem.shape[1]]


def velocity(problem: Problem, harmonics: np.ndarray) -> np.ndarray:
    """Velocity harmonics (T, H), from the displacement where there is no velocity channel."""
    derived = 1j * problem.omega[:, None] * problem.orders * harmonics[:, 0]
    if problem.shape[0] == 1:
        return derived
    has = np.array([s.mean.shape[0] == 2 for s in problem.spectra])
    return np.where(has[:, None], harmonics[:, -1], derived)


def peak_to_peak(displacement: np.ndarray) -> np.ndarray:
    """Of waveforms (T, PHASES), shape (T,)."""
    return np.ptp(displacement, axis=-1)


def plateau(rate: np.ndarray) -> np.ndarray:
    """Share of the period (T,) in which waveforms (T, PHASES) of velocity are nearly zero."""
    return (np.abs(rate) < PLATEAU * np.abs(rate).max(axis=-1, keepdims=True)).mean(axis=-1)


def supplied(fit: Fit, fundamental: np.ndarray) -> np.ndarray:
    """Energy (J, shape (T,)) that the base puts in per period, from the displacement's fundamental (T,).

    The work of the inertia forces that PHYSICS.md balances with friction: pi m a omega^2 Re D_1.
    """
    one = _rows(fit)
    moved = one["bolster_mass"] + 2.0 * one["wedge_mass"] * one["column_ratio"] * one["cos_column"]
    return pi * moved * one["amplitude"] * one["omega"] ** 2 * fundamental.real


def leftover_force(fit: Fit, harmonics: np.ndarray) -> np.ndarray:
    """Force on the bolster (N, shape (T, PHASES)) that the measured motion has and the model lacks.

    The measured acceleration less that of the model in the same state, times the mass that moves.
    """
    problem, rows = fit.model.problem, _rows(fit)
    rate = velocity(problem, harmonics)
    x, v = -waveform(harmonics[:, 0]), -waveform(rate)
    a = -waveform(1j * problem.omega[:, None] * problem.orders * rate)
    return np.array([_leftover(rows[t : t + 1], x[t], v[t], a[t]) for t in range(problem.tests)])


def _rows(fit: Fit) -> np.ndarray:
    problem = fit.model.problem
    values = fit.model.values(fit.x)
    return records(problem.model, problem.law, values, problem.omega, fit.amplitudes())


@compiled
def _accelerations(parameters, x, v, out):
    """Write the model's z'' in states on an even grid over one period."""
    p = parameters[0]
    for i in range(x.size):
        t = 2.0 * pi / p.omega * i / x.size
        contact, _ = contacts.initial(t, x[i], v[i], p)
        base = -p.amplitude * p.omega**2 * np.sin(p.omega * t)
        if contacts.stuck(contact, p):
            out[i] = 0.0
        else:
            out[i] = contacts.acting(x[i], v[i], base, Contact(*contact), p).acceleration


def _leftover(one: np.ndarray, x: np.ndarray, v: np.ndarray, a: np.ndarray) -> np.ndarray:
    model = np.empty(x.size)
    _accelerations(one, x, v, model)
    moved = one["bolster_mass"] + 2.0 * one["wedge_mass"] * one["column_ratio"] ** 2
    return moved * (a - model)
