"""What simpler methods name on the same files."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

# A score is chi-squared with one degree of freedom: 5 % among 21 candidates.
LEAST_SCORE = 9.2
# STLSQ drops terms whose rms is below this share of the bolster's inertia, in at most so many rounds.
LEAST_TERM, ROUNDS, BOLSTER_MASS = 0.01, 10, 0.70
# The effect that each term of the library stands for; |v|v is the independent simulator's drag.
TERMS = {
    "1": "preload",
    "z": "bolster_stiffness",
    "z^3": "cubic_stiffness",
    "v": "viscous_damping",
    "sign v": "guide_friction",
    "|v|v": "drag",
    "a": "bolster_mass",
}


def smallest_aic(result: Path) -> list[str]:
    """The fit of the diagnosis with the smallest AIC, without its tests of adequacy and its rivals."""
    rows = [row for row in _candidates(result) if row["q"] is not None]
    return sorted(min(rows, key=lambda row: row["q"] + 2.0 * len(row["parameters"]))["effects"])


def sparse_regression(result: Path) -> list[str]:
    """Sequentially thresholded least squares of the force that the model lacks on a library of terms.

    As SINDy does (Brunton, Proctor and Kutz, 2016). The measured motion is the mean over the periods.
    """
    with xr.open_dataset(result / "diagnosis.nc") as found:
        force = found["leftover_force"].values
        z = -found["measured_waveform"].sel(channel="displacement").values
        omega = 2.0 * np.pi * found["frequency"].values[:, None]
    orders = 1j * np.fft.fftfreq(z.shape[1], 1.0 / z.shape[1])
    v = np.fft.ifft(orders * np.fft.fft(z)).real * omega
    a = np.fft.ifft(orders * np.fft.fft(v)).real * omega
    library = np.array([np.ones_like(z), z, z**3, v, np.sign(v), np.abs(v) * v, a]).reshape(len(TERMS), -1).T
    finite = np.isfinite(force.ravel())
    library, target = library[finite], force.ravel()[finite]
    rms = np.sqrt((library**2).mean(axis=0))
    least, kept = LEAST_TERM * BOLSTER_MASS * rms[-1], np.ones(len(TERMS), bool)
    for _ in range(ROUNDS):
        size = np.zeros(len(TERMS))
        size[kept] = np.abs(np.linalg.lstsq(library[:, kept] / rms[kept], target, rcond=None)[0])
        if (size[kept] >= least).all():
            break
        kept = size >= least
    return sorted(name for name, stays in zip(TERMS.values(), kept, strict=True) if stays)


def largest_score(result: Path) -> list[str]:
    """The effect with the largest score, if chance does not explain it."""
    rows = [row for row in _candidates(result) if len(row["effects"]) == 1 and row["score"]]
    best = max(rows, key=lambda row: row["score"], default=None)
    return best["effects"] if best is not None and best["score"] > LEAST_SCORE else []


def _candidates(result: Path) -> list[dict[str, Any]]:
    return json.loads((result / "diagnosis.json").read_text())["candidates"]


# Each method takes the directory of a diagnosis and returns the effects that it names.
BASELINES: dict[str, Callable[[Path], list[str]]] = {
    "smallest AIC": smallest_aic,
    "sparse regression": sparse_regression,
    "largest score": largest_score,
}
