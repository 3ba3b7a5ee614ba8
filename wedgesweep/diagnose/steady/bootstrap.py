"""New noise on simulated harmonics, as the measured ones have it."""

from dataclasses import replace

import numpy as np

from wedgesweep.diagnose.steady.spectra import Spectrum


def resampled(
    spectrum: Spectrum, exact: np.ndarray, model_error: float, rng: np.random.Generator
) -> Spectrum:
    """The spectrum with exact harmonics (C, H), a tone last, and new noise in place of what was measured.

    A relative model error, if there is one, is drawn as well.
    """
    channels = spectrum.mean.shape[0]
    mean = exact[:channels, : spectrum.harmonics]
    if spectrum.tone is not None:
        mean = np.concatenate([mean, exact[:channels, -1:]], axis=1)
    parts = rng.normal(size=(2, *mean.shape)) * np.sqrt(spectrum.variance / 2.0)
    noise = parts[0] + 1j * parts[1]
    if channels == 2 and spectrum.coherence:
        share, scale = spectrum.coherence, np.sqrt(spectrum.variance)
        noise[1] = np.sqrt(1.0 - abs(share) ** 2) * noise[1] + share * noise[0] / scale[0] * scale[1]
    if model_error:
        rms = model_error * np.sqrt((np.abs(mean) ** 2).mean(axis=1, keepdims=True) / 2.0)
        drawn = rng.normal(size=(2, *mean.shape)) * rms
        noise = noise + drawn[0] + 1j * drawn[1]
    return replace(spectrum, mean=mean + noise)
