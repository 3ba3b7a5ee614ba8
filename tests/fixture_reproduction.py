"""Runs for tests of the reproduction, made without solving anything."""

from math import pi

import xarray as xr
from reproduce import laws, sticking, suspension
from reproduce.runs import Run, Runs

from tests import fixture_dataset

BETAS = (0.1, 0.2, 0.4, 0.6, 0.8, 1.1, 1.472, 1.75, 2.2, 3.0)
AMPLITUDES = (5e-6, 1.5e-5, 3e-5, 5e-5, 1e-4, 3e-4, 1e-3, 4.75e-3)
HERTZ = (20.0, 30.0, 32.0, 35.0, 38.0, 40.0)
SMALL_AMPLITUDES = (1e-5, 1.5e-5, 3e-5, 4e-5, 5e-5, 1e-4)
ATTRIBUTES = {
    "rest_position": -1.0572017166e-3,
    "start_time": "2026-01-01T00:00:00Z",
    "config_sha256": "0" * 64,
    "wedgesweep_version": "0",
    "package_versions": '{"numpy": "0"}',
}


def run_of(betas, amplitudes, **attributes):
    """A run that was not solved: crests cut off below breakaway, a pure sine otherwise."""
    ds = fixture_dataset.build(betas=betas, amplitudes=amplitudes, failed=None)
    ds["displacement_harmonics"][..., 0, 0] = ds["peak_to_peak"].values / 2.0
    ds["periodicity"][:] = 0.0
    ds.attrs |= ATTRIBUTES | attributes
    return Run(ds)


def _unilateral(run):
    """Joints that lift off at the largest input, without solving anything."""
    ds = run.ds.copy(deep=True)
    numbers = {name: xr.zeros_like(ds["amplitude_ratio"]) for name in ("impacts", "impact_energy")}
    opens = 0.5 * (ds["amplitude_ratio"] * 0.0 + ds["amplitude"] > 1e-3)
    return Run(ds.assign(lift_off_fraction=opens, **numbers))


def build(monkeypatch):
    """The runs, and single cases that are not solved either."""

    def not_solved(*arguments):
        return {"amplitude_ratio": 1.0, "stick_fraction": 0.5}

    for module in (suspension, sticking, laws):
        monkeypatch.setattr(module, "single", not_solved)
    small = [2.0 * pi * hertz / fixture_dataset.OMEGA_N for hertz in HERTZ]
    paper = run_of(BETAS, AMPLITUDES)
    return Runs(paper, run_of(BETAS, AMPLITUDES), run_of(small, SMALL_AMPLITUDES), _unilateral(paper))
