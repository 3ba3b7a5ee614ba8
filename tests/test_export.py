"""export: every case is a row, of every kind of dataset, with the numbers of the dataset."""

import csv
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from tests import fixture_dataset, small_sweep
from tests.command import invoke
from wedgesweep.sweep.variables import STATUSES

CASES = ["friction_law", "beta", "frequency [Hz]", "amplitude [m]"]


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    fixture_dataset.build().to_netcdf("study.nc")
    return tmp_path


def exported(*options):
    """Rows as dicts."""
    invoke("export", *options, "-o", "out.csv")
    return read("out.csv")


def read(name):
    with Path(name).open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_a_row_for_each_case_with_units_in_the_header(here):
    ds, rows = xr.load_dataset("study.nc"), exported("study.nc")
    assert list(rows[0])[:4] == CASES
    assert len(rows) == ds["status"].size
    assert {"peak_to_peak [m]", "amplitude_ratio", "status"} < set(rows[0])
    assert not any("displacement_harmonics" in name or name.startswith("displacement") for name in rows[0])
    for row in rows[:: len(rows) // 7]:
        at = {"friction_law": row["friction_law"], "beta": float(row["beta"])}
        case = ds.sel(at | {"amplitude": float(row["amplitude [m]"])})
        assert row["status"] == STATUSES[case["status"].item()]
        assert float(row["frequency [Hz]"]) == case["frequency"].item()
        expected = case["peak_to_peak"].item()
        assert row["peak_to_peak [m]"] == ("" if np.isnan(expected) else repr(expected))


def test_chosen_variables_and_the_parts_of_spectra(here):
    ds = xr.load_dataset("study.nc")
    rows = exported("study.nc", "--variables", "amplitude_ratio, displacement_harmonics,beta")
    assert list(rows[0])[:7] == [
        *CASES,
        "amplitude_ratio",
        "displacement_harmonics_1_real [m]",
        "displacement_harmonics_1_imaginary [m]",
    ]
    last = ds["displacement_harmonics"].values.reshape(-1, ds.sizes["harmonic"], 2)[-1]
    assert [float(each) for each in list(rows[-1].values())[5:]] == last.ravel().tolist()


def test_a_list_of_cases_and_those_that_failed(here):
    ds = fixture_dataset.build()
    count = ds["status"].size
    fixture_dataset.as_cases(ds, count).to_netcdf("cases.nc")
    listed = exported("cases.nc")
    assert listed == exported("study.nc")
    failed = [row for row in listed if row["status"] not in ("ok", "not_run")]
    assert len(failed) == ((ds["status"] > 0) & (ds["status"] < STATUSES.index("not_run"))).sum() > 0
    assert {row["amplitude_ratio"] for row in failed} == {""}


def test_an_unfinished_run(here):
    (here / "locked.toml").write_text(small_sweep.LOCKED)
    invoke("run", "locked.toml", "--fail-fast", "--n-jobs", 1, code=1)
    assert "locked.nc: unfinished; 1 of 2 cases are there" in invoke("export", "locked.nc")
    assert [row["status"] for row in read("locked.csv")] == ["locked", "not_run"]


def test_it_can_be_printed_and_faults_are_told(here):
    told = invoke("export", "study.nc", "-o", "-", "--variables", "status")
    assert told.splitlines()[0] == ",".join([*CASES, "status"])
    assert "nothing: no such variable; valid here: amplitude_ratio," in invoke(
        "export", "study.nc", "--variables", "nothing", code=2
    )
    assert "velocity: a waveform of " in invoke("export", "study.nc", "--variables", "velocity", code=2)
    assert "absent.nc: no such file" in invoke("export", "absent.nc", code=2)
