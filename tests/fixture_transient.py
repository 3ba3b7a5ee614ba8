"""The result of a diagnosis of transients, made without solving anything: a swept sine and a ring-down.

The measured motion has a third harmonic that the base model lacks and the extended one has.
"""

import numpy as np
import xarray as xr

from tests import fixture_diagnosis
from wedgesweep.diagnosis_result import DiagnosisResult

RATE, SAMPLES, NOISE = 400.0, 4000, 2e-6
FIRST, LAST = 2.0, 30.0  # Hz, of the sweep


def _motion(time, third):
    phase = 2.0 * np.pi * (FIRST * time + 0.5 * (LAST - FIRST) / time[-1] * time**2)
    sweep = 1e-3 * (np.sin(phase) + third * np.sin(3.0 * phase))
    turns = 2.0 * np.pi * 5.0 * time
    ringing = 2e-3 * np.exp(-0.5 * time) * (np.cos(turns) + third * np.cos(3.0 * turns))
    return np.array([sweep, ringing])[:, None]


def build(parts=1):
    """A DiagnosisResult; each record is cut into so many tests."""
    time = np.arange(SAMPLES) / RATE
    measured = _motion(time, 0.2) + NOISE * np.random.default_rng(0).standard_normal((2, 1, SAMPLES))
    simulated = np.array([_motion(time, 0.0), _motion(time, 0.2)])

    def cut(values):
        """Values (..., 2, 1, n) as (..., 2 parts, 1, n / parts)."""
        split = values.reshape(*values.shape[:-1], parts, -1)
        return np.moveaxis(split, -2, -3).reshape(*values.shape[:-3], 2 * parts, 1, -1)

    names = [f"{name}{part}" for name in ("sweep", "drop") for part in range(parts)]
    q = np.array([[500.0, 300.0], [1.0, 1.0]]).repeat(parts, axis=1) * SAMPLES / parts
    data = xr.Dataset(
        {
            "time": (("test", "sample"), cut(np.array([time, time])[:, None])[:, 0]),
            "measured": (("test", "channel", "sample"), cut(measured)),
            "simulated": (("model", "test", "channel", "sample"), cut(simulated)),
            "sample_noise": (("test", "channel"), np.full((2 * parts, 1), NOISE)),
            "q": (("model", "test"), q),
            "dof": (("test",), np.full(2 * parts, SAMPLES // parts)),
        },
        {"test": names, "model": ["base", "extended"], "channel": ["displacement"]},
    )
    document, _ = fixture_diagnosis.build("consistent-with")
    rows = [
        {
            **{"name": name, "samples": SAMPLES // parts, "dof": SAMPLES // parts},
            **{"duration_s": 10.0 / parts, "start_mm": 1.0, "start_mm_per_s": 0.0},
            **{"noise_displacement_mm": 1e3 * NOISE, "noise_velocity_mm_per_s": None},
            **{"error_base": 0.2, "error_extended": 0.002},
            **{f"q_{model}": float(q[place, t]) for place, model in enumerate(("base", "extended"))},
        }
        for t, name in enumerate(names)
    ]
    misfit = document["misfit"] | {"tests": rows}
    return DiagnosisResult(document | {"kind": "transient", "misfit": misfit, "gain": {"held_out": []}}, data)
