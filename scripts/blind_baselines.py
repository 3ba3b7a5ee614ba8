"""What simpler methods name on the same files."""

import json
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import xarray as xr

from wedgesweep import measured
from wedgesweep.diagnose import diagnosis
from wedgesweep.diagnose.search import Explanation, Search, best_of
from wedgesweep.diagnose.steady.amplitude_grid import best_amplitudes
from wedgesweep.diagnose.steady.model import Fit
from wedgesweep.diagnose.steady.spectra import Spectrum

# A score is chi-squared with one degree of freedom: 5 % among 21 candidates.
SCORED = 9.2
# Terms whose share of the force of inertia (rms) is less are dropped, as STLSQ does, until none is.
SHARE, ROUNDS = 0.01, 10
# What a term of the library stands for; |v|v is none of the candidates.
TERMS = {
    "1": "preload",
    "z": "bolster_stiffness",
    "z^3": "cubic_stiffness",
    "v": "viscous_damping",
    "sign v": "guide_friction",
    "|v|v": "drag",
    "a": "bolster_mass",
}


def aic(data: Path, result: Path, candidates: Sequence[str]) -> list[str]:
    """Forward selection by AIC on samples taken as independent; at most two effects.

    The same simulations and the same fits as the diagnosis, but for the noise: white, from the samples.
    """
    measurement = replace(measured.read(data), derived_velocity=False)
    data = diagnosis.fit_data_of(measurement)
    data = replace(data, spectra=tuple(map(_independent, data.spectra)))
    search = Search(data, candidates)
    best = search.base()
    for size in (1, 2):
        if size == 1:
            fits = search.singles(best.fit)
        else:
            others = [name for name in search.effects if name not in best.effects]
            fits = [search.explanation(_beside(search, best.fit, name)) for name in others]
        better = min(fits, key=_criterion, default=best)
        if _criterion(better) >= _criterion(best):
            break
        best = better
    return sorted(best.effects)


def _criterion(each: Explanation) -> float:
    return each.fit.chi2 + 2.0 * each.fit.model.size


def _independent(spectrum: Spectrum) -> Spectrum:
    """The same harmonics with the noise that independent samples would have."""
    sampled = (spectrum.residual**2).mean(axis=1)
    flat = 4.0 / spectrum.samples * np.repeat(sampled[:, None], spectrum.mean.shape[1], axis=1)
    return replace(spectrum, variance=flat, coherence=0.0j)


def _beside(search: Search, first: Fit, other: str) -> Fit:
    model = search.model(*first.effects, other)
    known = first.x[: first.model.size]
    starts = [model.start(first, np.r_[known, x]) for x in search.model(other).hypothesis.starts()]
    return best_of(model, best_amplitudes(model, starts))


def sparse_regression(data: Path, result: Path, candidates: Sequence[str]) -> list[str]:
    """Sequentially thresholded least squares of the force that the model lacks on a library of terms.

    As SINDy does (Brunton, Proctor and Kutz, 2016); the measured motion is the mean over the periods.
    """
    with xr.open_dataset(result / "diagnosis.nc") as found:
        force = found["leftover_force"].values
        z = -found["measured_waveform"].sel(channel="displacement").values
        omega = 2.0 * np.pi * found["frequency"].values[:, None]
    steps = 1j * np.fft.fftfreq(z.shape[1], 1.0 / z.shape[1])
    v = np.fft.ifft(steps * np.fft.fft(z)).real * omega
    a = np.fft.ifft(steps * np.fft.fft(v)).real * omega
    library = np.array([np.ones_like(z), z, z**3, v, np.sign(v), np.abs(v) * v, a]).reshape(len(TERMS), -1).T
    good = np.isfinite(force.ravel())
    library, target = library[good], force.ravel()[good]
    size = np.sqrt((library**2).mean(axis=0))
    least, kept = SHARE * 0.70 * size[-1], np.ones(len(TERMS), bool)  # of the bolster's inertia
    for _ in range(ROUNDS):
        share = np.zeros(len(TERMS))
        share[kept] = np.linalg.lstsq(library[:, kept] / size[kept], target, rcond=None)[0]
        if (np.abs(share[kept]) >= least).all():
            break
        kept = np.abs(share) >= least
    return sorted(name for name, stays in zip(TERMS.values(), kept, strict=True) if stays)


def largest_score(data: Path, result: Path, candidates: Sequence[str]) -> list[str]:
    """The effect with the largest score, if that is more than chance."""
    rows = json.loads((result / "diagnosis.json").read_text())["candidates"]
    scores = {row["effects"][0]: row["score"] for row in rows if len(row["effects"]) == 1 and row["score"]}
    best = max(scores, key=lambda name: scores[name], default=None)
    return [best] if best is not None and scores[best] > SCORED else []


# Takes longer than the diagnosis.
SLOW = "forward AIC"
BASELINES: dict[str, Callable[[Path, Path, Sequence[str]], list[str]]] = {
    SLOW: aic,
    "sparse regression": sparse_regression,
    "largest score": largest_score,
}
