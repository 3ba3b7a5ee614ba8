"""Samples of numbers of the model: points, Sobol indices and percentiles."""

from contextlib import contextmanager
from math import pi

import numpy as np
import pytest
import xarray as xr

from tests.small_sweep import faults
from wedgesweep import config, figures
from wedgesweep.figures.samples.sensitivity import sobol_indices
from wedgesweep.sweep import variables
from wedgesweep.sweep.backend import Pool
from wedgesweep.sweep.run import Sweep

SWEEP = """
[sweep]
friction_law = "coulomb"
frequency_hz = [10.0, 12.0]
amplitude_mm = 0.3
[sweep.sample]
num = 16
indices = true
friction.dynamic = "0.29 +- 5 %"
suspension.bolster_mass_kg = { distribution = "normal", mean = 0.7, std = 0.01 }
"suspension.wedge_angle_deg" = { distribution = "lognormal", median = 37.5, sigma = 0.02 }
[solver]
method = "event-driven"
settle_periods = 3
kept_periods = 2
samples_per_period = 32
keep_waveforms = false
"""
# Three numbers in place of the arguments.
ISHIGAMI = """
[sweep]
friction_law = "coulomb"
frequency_hz = 10.0
amplitude_mm = 0.3
[sweep.sample]
num = 4096
indices = true
suspension.wedge_preload_N = "0 +- 3.141592653589793"
suspension.column_angle_deg = "0.001 +- 3.141592653589793"
suspension.gravity_m_per_s2 = "10 +- 3.141592653589793"
[friction]
dynamic = 0.0
[solver]
method = "event-driven"
keep_waveforms = false
"""


def ishigami(cases: np.ndarray) -> np.ndarray:
    s = cases["suspension"]
    one, third = s["wedge_preload"], s["gravity"] - 10.0
    other = s["column_angle"] * 180.0 / pi - 0.001
    return np.sin(one) + 7.0 * np.sin(other) ** 2 + 0.1 * third**4 * np.sin(one)


@contextmanager
def toy(n_jobs, fingerprint):
    """A backend whose cases are a toy: their amplitude ratio is the Ishigami function of three numbers."""

    def solve(task, chunks):
        for chunk in chunks:
            records = variables.blank(chunk.dtype, chunk.indices)
            records["status"], records["amplitude_ratio"] = 0, ishigami(chunk.cases)
            yield records

    yield Pool(solve, 1)


@pytest.mark.acceptance
def test_indices_of_the_ishigami_function_lie_in_their_intervals(tmp_path):
    ds = Sweep(config.parse(ISHIGAMI), tmp_path / "toy.nc").run(backend=toy)
    found = sobol_indices(ds["amplitude_ratio"].values.ravel(), 4096)
    # Saltelli et al. (2008): a = 7, b = 0.1.
    total = 0.125 * 49.0 + 0.1 * pi**4 / 5.0 + 0.01 * pi**8 / 18.0 + 0.5
    alone = np.array([0.5 * (1.0 + 0.1 * pi**4 / 5.0) ** 2, 49.0 / 8.0, 0.0]) / total
    interaction = 8.0 * 0.01 * pi**8 / 225.0 / total
    expected = np.array([alone, alone + np.array([interaction, 0.0, interaction])])
    assert ((found.low <= expected) & (expected <= found.high)).all()
    assert found.values == pytest.approx(expected, abs=0.02)
    assert figures.draw(ds, "sensitivity").get_suptitle()


def test_points_are_seeded_distributed_and_grow(tmp_path):
    read = config.parse(SWEEP)
    assert read.sweep.dims == ("friction_law", "sample", "frequency", "amplitude")
    assert config.parse(read.to_toml()) == read
    points = {key: read.sweep.column(key) for key in read.sweep.keys}
    assert all(each.shape == (16 * 5,) for each in points.values())
    dynamic = points["friction.dynamic"]
    assert 0.2755 <= dynamic.min() < dynamic.max() <= 0.3045
    more = config.parse(SWEEP.replace("num = 16", "num = 32"))
    assert more.sweep.column("friction.dynamic")[:16].tolist() == dynamic[:16].tolist()
    other = config.parse(SWEEP.replace("num = 16", "num = 16\nseed = 1"))
    assert other.sweep.column("friction.dynamic").tolist() != dynamic.tolist()
    many = config.parse(SWEEP.replace("num = 16", "num = 1024").replace("indices = true", "indices = false"))
    mass, angle = (many.sweep.column(f"suspension.{key}") for key in ("bolster_mass_kg", "wedge_angle_deg"))
    assert (mass.mean(), mass.std()) == pytest.approx((0.7, 0.01), rel=1e-2)
    assert (np.median(angle), np.log(angle).std()) == pytest.approx((37.5, 0.02), rel=1e-2)


def test_a_sample_runs_grows_and_is_drawn(tmp_path):
    Sweep(config.parse(SWEEP), tmp_path / "sample.nc").run(n_jobs=1)
    more = Sweep(config.parse(SWEEP.replace("num = 16", "num = 32")), tmp_path / "sample.nc")
    counts = []
    ds = more.run(n_jobs=1, progress=lambda records, total: counts.append(len(records)))
    assert (counts[0], sum(counts)) == (160, 320)
    assert ds["wedge_angle_deg"].dims == ("sample",)
    assert ds["beta"].dims == ("sample", "frequency")
    stored = xr.load_dataset(tmp_path / "sample.nc")
    for kind in figures.of(stored):
        figure = figures.draw(stored, kind)
        figure.draw_without_rendering()
        assert ("160 samples" if kind == "tolerance" else "32 points") in figure.get_suptitle()
        assert all("[" in ax.get_xlabel() for ax in figure.axes)
    # The band of a single frequency is wide enough to be seen.
    (ax,) = figures.draw(stored.isel(frequency=[0]), "tolerance").axes
    assert ax.lines[0].get_xdata().tolist() == pytest.approx([9.9, 10.1])
    assert np.ptp(ax.collections[0].get_paths()[0].vertices, axis=0).min() > 0.0


@pytest.mark.parametrize(
    ("right", "wrong", "words"),
    [
        ('"0.29 +- 5 %"', '"0.29 5"', "is no distribution"),
        ("num = 16", "num = 17", "write 32"),
        ("mean = 0.7, std = 0.01", "mean = 0.7, std = 0.7", "is drawn, which is out of range"),
        ('"normal"', '"cauchy"', "uniform, normal, lognormal"),
        ("suspension.bolster_mass_kg", "suspension.bolster_mass", "bolster_mass_kg"),
    ],
)
def test_wrong_samples_are_named(right, wrong, words):
    (fault,) = faults(SWEEP.replace(right, wrong))
    assert "sweep" in fault
    assert words in fault
