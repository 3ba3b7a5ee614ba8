"""What the channels show of a motion: a gain on displacement, a first-order lag on velocity.

Both act after the mechanics (effects ``displacement_gain`` and ``velocity_lag``).
"""

from math import exp

import numpy as np

from wedgesweep.compiled import allocating, inner

# Below this step over time constant the weights of ``_weights`` are summed as a series.
SERIES_BELOW, SERIES_TERMS = 1.0, 20


@inner
def apply_to_spectra(spectra, p):
    """Turn spectra (2, n, 2) of a motion into those of its channels, in place."""
    for i in range(spectra.shape[1]):
        spectra[0, i, 0] *= p.displacement_gain.scale
        spectra[0, i, 1] *= p.displacement_gain.scale
    if p.velocity_lag.time == 0.0:
        return
    for i in range(spectra.shape[1]):
        # Over 1 + i h omega time; complex numbers take numba longer to compile.
        real, imaginary, lag = (
            spectra[1, i, 0],
            spectra[1, i, 1],
            (i + 1) * p.input.omega * p.velocity_lag.time,
        )
        spectra[1, i, 0] = (real + lag * imaginary) / (1.0 + lag * lag)
        spectra[1, i, 1] = (imaginary - lag * real) / (1.0 + lag * lag)


@allocating
def _weights(ratio):
    """Weights of the samples at -1, 0, 1, 2 for one step of the lag, exact for cubics.

    ``ratio`` is the step over the time constant; the moments are ratio times the integrals of
    s^m exp(-ratio (1 - s)) over 0 < s < 1.
    """
    moments = np.empty(4)
    if ratio < SERIES_BELOW:
        for m in range(4):
            term = ratio / (m + 1.0)
            moments[m] = term
            for j in range(1, SERIES_TERMS):
                term *= -ratio / (m + j + 1.0)
                moments[m] += term
    else:
        moments[0] = 1.0 - exp(-ratio)
        for m in range(1, 4):
            moments[m] = 1.0 - m / ratio * moments[m - 1]
    one, first, second, third = moments
    return (
        (-third + 3.0 * second - 2.0 * first) / 6.0,
        (third - 2.0 * second - first + 2.0 * one) / 2.0,
        (-third + second + 2.0 * first) / 2.0,
        (third - first) / 6.0,
    )


@allocating
def lagged(velocity, step, periodic, p):
    """Velocity channel of samples ``step`` (s) apart; without ``periodic`` it begins in balance."""
    if p.velocity_lag.time == 0.0:
        return velocity.copy()
    ratio, n = step / p.velocity_lag.time, velocity.size
    a, b, c, d = _weights(ratio)
    keeps = exp(-ratio)
    out = np.empty(n)
    # A periodic channel begins where it ends: its first turn finds that place.
    now = 0.0 if periodic else velocity[0]
    for turn in range(2 if periodic else 1):
        for i in range(n):
            out[i] = now
            before, after, later = i - 1, i + 1, i + 2
            if periodic:
                before, after, later = before % n, after % n, later % n
            else:
                before, after, later = max(before, 0), min(after, n - 1), min(later, n - 1)
            pulled = a * velocity[before] + b * velocity[i] + c * velocity[after] + d * velocity[later]
            now = keeps * now + pulled
        if periodic and turn == 0:
            now /= 1.0 - exp(-ratio * n)
    return out
