"""What stands on disk: CF conventions, units, and everything needed to know where it came from."""

import json
import tomllib
from dataclasses import replace

import netCDF4
import numpy as np
import pytest
import xarray as xr

from tests import small_sweep
from wedgesweep import config
from wedgesweep.config.physics import BREAKAWAY
from wedgesweep.errors import SweepError
from wedgesweep.sweep import dataset, labels, provenance, variables
from wedgesweep.sweep.variables import STATUSES, VARIABLES

FEW = small_sweep.CONFIG.replace("1.1, ", "")


@pytest.fixture(scope="module")
def sweep(tmp_path_factory):
    sweep = small_sweep.sweep(tmp_path_factory.mktemp("stored"), FEW)
    sweep = replace(sweep, command="wedgesweep run 'my config.toml'")
    sweep.run(n_jobs=1)
    return sweep


@pytest.fixture(scope="module")
def ds(sweep):
    with xr.open_dataset(sweep.out) as opened:
        yield opened.load()


def test_variables_have_the_declared_dimensions_units_and_names(ds):
    assert set(ds.data_vars) == {variable.name for variable in VARIABLES} | set(BREAKAWAY)
    for variable in VARIABLES:
        found = ds[variable.name]
        assert found.dims == (*variables.GRID, *variable.dims)
        assert found.attrs["long_name"] == variable.long_name.format(**labels.SUSPENSION)
        assert found.attrs.get("units", "") == variable.units
        assert variable.dtype == "str" or found.dtype == np.dtype(variable.dtype)
    # The status is a flag of CF.
    flag = ds["status"].attrs
    assert ds["status"].dtype == flag["flag_values"].dtype == np.int8
    assert flag["flag_values"].tolist() == list(range(len(STATUSES)))
    assert flag["flag_meanings"].split() == list(STATUSES)


def test_coordinates(ds, sweep):
    assert ds["friction_law"].values.tolist() == ["coulomb", "exponential"]
    assert ds.sel(amplitude=0.0006, beta=2.5)["status"].shape == (2,)
    assert ds["amplitude"].attrs["units"] == "m"
    assert ds["frequency"].attrs["units"] == "Hz"
    omega = 2.0 * np.pi * ds["frequency"].values
    assert ds["beta"].values * ds.attrs["omega_n"] == pytest.approx(omega)
    assert sweep.config.records()["input"]["omega"] == pytest.approx(np.tile(np.repeat(omega, 4), 2))
    phase = ds["phase"].values
    assert (phase[0], phase[32]) == (0.0, pytest.approx(2.0 * np.pi))
    assert phase.size == 64
    assert ds["harmonic"].values.tolist() == list(range(1, 10))


def test_cf_conventions_in_the_file_itself(sweep):
    with netCDF4.Dataset(sweep.out) as raw:
        assert raw.Conventions.startswith("CF-1.")
        for name in ("title", "source", "references", "history"):
            assert isinstance(getattr(raw, name), str)
        for name in raw.variables:
            coordinate = name in (*raw.dimensions, "frequency")
            assert not (coordinate and "_FillValue" in raw[name].ncattrs()), name
        for variable in VARIABLES:
            # Doubles hardly shrink; waveforms, flags and counts do.
            compressed = variable.dtype not in ("str", "f8")
            assert (raw[variable.name].filters() or {}).get("zlib", False) == compressed


def test_provenance(ds, sweep):
    resolved = ds.attrs["config"]
    assert config.parse(resolved).to_toml() == resolved == sweep.config.to_toml()
    assert tomllib.loads(resolved)["friction"]["static"] == 0.32  # a default, written out
    assert ds.attrs["config_sha256"] == sweep.config.sha256
    assert ds.attrs["history"].endswith(": wedgesweep run 'my config.toml'")
    assert ds.attrs["history"].startswith(ds.attrs["start_time"])
    np.datetime64(ds.attrs["start_time"].removesuffix("Z"))
    assert json.loads(ds.attrs["package_versions"])["numpy"] == np.__version__
    assert json.loads(ds.attrs["fingerprint"]) == sweep.fingerprint
    assert ds.attrs["title"] == "small"


def test_no_commit_is_claimed_outside_a_checkout(tmp_path):
    assert provenance.git_commit(tmp_path) is None
    untracked = small_sweep.ROOT / ".venv"
    assert not untracked.exists() or provenance.git_commit(untracked) is None


def test_a_failed_write_leaves_the_old_dataset(tmp_path, ds, monkeypatch):
    path = tmp_path / "x.nc"
    path.write_text("old")

    def breaks(self, target, **options):
        target.write_text("half")
        raise OSError

    monkeypatch.setattr(xr.Dataset, "to_netcdf", breaks)
    with pytest.raises(SweepError, match=r"x\.nc: cannot be written"):
        dataset.write(ds, path)
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_read_says_what_it_cannot_read(tmp_path, sweep):
    with pytest.raises(SweepError, match=r"absent\.nc: no such file"):
        dataset.read(tmp_path / "absent.nc")
    with pytest.raises(SweepError, match="is a directory"):
        dataset.read(tmp_path)
    content = sweep.out.read_bytes()
    damaged = r"x\.nc: not a netCDF dataset, or damaged"
    for broken, words in ((b"", "empty file"), (b"text", damaged), (content[: len(content) // 2], damaged)):
        (tmp_path / "x.nc").write_bytes(broken)
        with pytest.raises(SweepError, match=words):
            dataset.read_sweep(tmp_path / "x.nc")


def test_blank_records_have_no_numbers():
    dtype = variables.record_dtype({"phase": 4, "harmonic": 9, "part": 2})
    blank = variables.blank(dtype, np.array([3, 5]))
    assert blank["index"].tolist() == [3, 5]
    assert {STATUSES[value] for value in blank["status"]} == {"not_run"}
    assert all(np.isnan(blank[v.name]).all() for v in VARIABLES if v.dtype[0] == "f")
