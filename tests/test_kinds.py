"""Whatever is given where something else is wanted is told as what it is."""

from pathlib import Path

import pytest

from tests import fixture_dataset, fixture_diagnosis
from tests.command import invoke

ROOT = Path(__file__).parents[1]
MEASURED, CONFIG = ROOT / "examples/bench/measured.toml", ROOT / "configs/quick.toml"


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    directory = tmp_path_factory.mktemp("kinds")
    fixture_dataset.build().to_netcdf(directory / "sweep.nc")
    (directory / "sweep.data").write_bytes((directory / "sweep.nc").read_bytes())
    fixture_diagnosis.write(directory / "found", "tied", tests=2)
    return directory


@pytest.mark.parametrize("command", ["run", "check", "case"])
@pytest.mark.parametrize(
    ("given", "words"),
    [
        ("sweep.nc", "the dataset of a run, where a config (TOML) is wanted; 'wedgesweep status'"),
        ("sweep.data", "the dataset of a run, where a config (TOML) is wanted"),
        ("found", "the result of a diagnosis, where a config (TOML) is wanted"),
        (MEASURED, "measured data, where a config (TOML) is wanted; 'wedgesweep check' and"),
    ],
)
def test_in_place_of_a_config(place, command, given, words):
    if command == "check" and given == MEASURED:
        return  # check reads both
    more = ("--beta", 1, "--amplitude", 1) if command == "case" else ()
    if command == "check":
        words = words.replace("(TOML) is", "(TOML) or a measurement is")
    assert f"{place / given}: {words}" in invoke(command, place / given, *more, code=2)


def test_in_place_of_measured_data(place):
    words = "where a measurement is wanted"
    assert f"sweep.nc: the dataset of a run, {words}" in invoke("diagnose", place / "sweep.nc", code=2)
    assert f"quick.toml: a config, {words}; 'wedgesweep run' runs it" in invoke("diagnose", CONFIG, code=2)


@pytest.mark.parametrize("command", [("status",), ("plot", "response"), ("export",)])
def test_in_place_of_a_dataset(command):
    for given, words in ((CONFIG, "a config"), (MEASURED, "measured data")):
        told = f"{words}, where the dataset of a run is wanted"
        if command[0] == "plot" and given == MEASURED:
            told = "no figure 'response' of these data; there are backbone"
        assert told in invoke(*command, given, code=2)
