"""Data whose truth is known: harmonics of the model itself with noise drawn on top.

For tests of the machinery only; data from another solver are in tests/validation.
"""

from functools import cache
from math import pi

import numpy as np

from tests.scaling import BENCH_SIZE
from wedgesweep import config
from wedgesweep.diagnose.next_test.recommend import recommended
from wedgesweep.diagnose.next_test.steady import sines
from wedgesweep.diagnose.search import Search, base_fit, single_fit
from wedgesweep.diagnose.steady import simulation
from wedgesweep.diagnose.steady.harmonic_data import HarmonicData
from wedgesweep.diagnose.steady.noise_psd import SmoothPSD
from wedgesweep.diagnose.steady.spectra import Spectrum
from wedgesweep.measured.measurement import Measurement, TestRecord
from wedgesweep.solvers.periodic import at_rest

FREQUENCIES = np.array([5.0, 8.0, 11.0, 20.0, 24.0, 32.0])
AMPLITUDES = 1e-3 * np.array([1.5, 0.6, 0.16, 0.11, 0.09, 0.06])
HARMONICS, SAMPLES, INTERVAL = 16, 1600, 5e-4
MODEL = """
[sweep]
friction_law = ["static-dynamic"]
beta = [1.0]
amplitude_mm = [0.1]
"""
# One effect that shows in all of them.
LAG = {"velocity_lag": {"time": 3e-4}}
# With columns leaning this way friction that is much higher one way locks the wedge.
LEANING = MODEL + "[suspension]\ncolumn_angle_deg = -2.5\n"


def drawn(
    effects=None,
    seed=0,
    level=0.04,
    std=0.02,
    uncertain=None,
    known=True,
    off=0.0,
    tests=slice(None),
    bench=(FREQUENCIES, AMPLITUDES),
    law="static-dynamic",
    model=MODEL,
    size=BENCH_SIZE,
) -> HarmonicData:
    """Data of six tests under ``effects`` (SI), true amplitudes ``off`` (relative) from the stated.

    ``bench``: frequencies (Hz) and stated amplitudes (m) of all the tests that may be chosen. ``size``: of
    the rig that is measured in place of the bench; everything is given as for the bench.
    """
    rng = np.random.default_rng(seed)
    model, effects = size.config(config.parse(model)), size.effects(effects or {})
    frequencies, stated = bench[0][tests] / size.time, bench[1][tests] * size.length
    omega, interval = 2.0 * pi * frequencies, INTERVAL * size.time
    rows = simulation.records(model, law, effects, omega, stated * (1.0 + off))
    exact = simulation.respond(rows, at_rest(omega.size), HARMONICS).harmonics
    spectra = []
    for frequency, harmonics in zip(frequencies, exact, strict=True):
        turn = np.exp(1j * np.arange(1, HARMONICS + 1) * rng.uniform(0.0, 2.0 * pi))
        rms = np.sqrt(0.5 * (np.abs(harmonics) ** 2).sum(axis=1))
        variance = np.repeat(4.0 / SAMPLES * (level * rms[:, None]) ** 2, HARMONICS, axis=1)
        noise = rng.normal(size=(2, 2, HARMONICS)) * np.sqrt(variance / 2.0)
        mean = harmonics * turn + noise[0] + 1j * noise[1]
        flat = tuple(SmoothPSD(np.array([2.0 * np.log(level * each), 0.0, 0.0]), 1.0) for each in rms)
        silent = np.zeros((2, SAMPLES))
        spectra.append(Spectrum(frequency, 8.4, SAMPLES, interval, mean, variance, 0.0j, silent, flat))
    return HarmonicData(
        model,
        law,
        tuple(f"{f:g} Hz" for f in frequencies),
        tuple(spectra),
        stated if known else np.full(stated.size, np.nan),
        np.full(stated.size, std if known else np.inf),
        uncertain or {},
    )


def record(name, frequency, time, **more) -> TestRecord:
    """A steady test of a made-up file: its frequency (Hz), times (s) and channels."""
    absent = {"amplitude": None, "amplitude_std": 0.0, "displacement": None, "velocity": None}
    return TestRecord(name, f"{name}.csv", frequency, time=time, **absent | more)


def measurement(model, law, tests, columns, **more) -> Measurement:
    """Records of tests beside a model (Config), as if read from files."""
    return Measurement(None, "bench", model, law, {}, tuple(tests), False, columns, **more)


def next_to_breakaway() -> HarmonicData:
    """Stribeck friction and a damper, with a test (8.155 Hz) that sticks if friction is a bit more."""
    return drawn(
        {"stribeck": {"peak": 1.21402e-3, "velocity": 0.379124e-3}, "viscous_damping": {"coefficient": 2.4}},
        bench=(
            np.array([4.879, 4.879, 8.155, 20.899, 23.426, 23.426]),
            1e-3 * np.array([1.16747, 3.61623, 0.39398, 0.08038, 0.06212, 0.16268]),
        ),
        std=0.001,
        law="exponential",
        model=MODEL + "[suspension]\ncolumn_angle_deg = -4.0\n",
    )


def searched(data, *effects):
    """Search, base model and the best single fit of each effect."""
    search, base, *_ = base_fit(Search.of(data, effects))
    return search, base, [single_fit(search, effect, base).fit for effect in effects]


@cache
def lagging():
    """Search, base model and the fit of the lag in data with one; nobody changes them."""
    search, base, (lag,) = searched(drawn(LAG), "velocity_lag")
    return search, base, lag


def base_of(data):
    """The fitted base model."""
    return base_fit(Search.of(data, ())).base


def steady_tests(fits):
    """Steady tests to choose from for fits to steady tests."""
    data = fits[0].model.data
    return sines(fits[0], data.sensors(), data)


def steady_test(fits):
    """The steady test that separates most fits to steady tests; None if there is none."""
    return recommended(steady_tests(fits), fits)
