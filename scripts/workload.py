"""What the benchmarks run: the cases, the sampled window and the amplitude ratio from its samples."""

from itertools import product
from types import MappingProxyType

import numpy as np

from wedgesweep.simulate import Settings
from wedgesweep.systems.suspension import parameters

OMEGA_N = (5100 / 0.70) ** 0.5
PERIODS_KEPT = 3
SAMPLES_PER_PERIOD = 128
SMOOTHING = 0.02e-3  # m/s, of Coulomb for solvers that need a continuous law: tanh(v / SMOOTHING)
# 44 cases of 1.5 s from rest: the workload that PHYSICS.md's figures are for.
BETAS, AMPLITUDES = np.linspace(0.3, 3.0, 11), (0.03e-3, 0.05e-3, 0.1e-3, 0.2e-3)


# Effects (SI) whose cost is measured.
EFFECTS = {
    "viscous damper": {"viscous_damping": {"coefficient": 2.0}},
    "Stribeck friction": {"stribeck": {"peak": 0.05, "velocity": 5e-3}},
    "guide friction": {"guide_friction": {"force": 1.0}},
    "compliant column": {"column_compliance": {"stiffness": 2e5}},
}


def records(law, cases=None, effects=MappingProxyType({})):
    """Parameter records of (beta, amplitude in m) pairs, each of shape (1,)."""
    cases = product(BETAS, AMPLITUDES) if cases is None else cases
    return [parameters.record(law, amplitude, beta * OMEGA_N, effects=effects) for beta, amplitude in cases]


def numbers(record):
    """All that a record, shape (1,), says of suspension, friction and input, as one dict of numbers."""
    parts = ("suspension", "friction", "input", "geometry")
    return {name: float(record[part][name][0]) for part in parts for name in record.dtype[part].names}


def sample_times(omega):
    """Times (s) of the kept window, both ends included."""
    window = Settings(kept_periods=PERIODS_KEPT).window(omega)
    return np.linspace(window.keep, window.end, PERIODS_KEPT * SAMPLES_PER_PERIOD + 1)


def turning_point_ratio(t, z, velocity, amplitude):
    """Amplitude ratio from samples of position and velocity.

    Between two samples of opposite velocity the extreme is that of the cubic through both: samples alone
    would miss it by up to (pi / SAMPLES_PER_PERIOD)^2 / 2.
    """
    turns = np.flatnonzero(velocity[:-1] * velocity[1:] < 0.0)
    h = (t[1:] - t[:-1])[turns]
    before, after = velocity[turns] * h, velocity[turns + 1] * h
    rise = z[turns + 1] - z[turns]
    # z(s) = z0 + before s + c s^2 + d s^3 on 0 <= s <= 1; z'(s) = 0.
    c, d = 3.0 * rise - 2.0 * before - after, before + after - 2.0 * rise
    root = np.sqrt(c * c - 3.0 * d * before)
    s = -before / (c + np.where(c > 0.0, root, -root))
    s = np.where((s > 0.0) & (s < 1.0), s, (-c - np.where(c > 0.0, root, -root)) / (3.0 * d))
    extremes = z[turns] + s * (before + s * (c + s * d))
    inside = np.concatenate([z, extremes])
    return (inside.max() - inside.min()) / 2.0 / amplitude
