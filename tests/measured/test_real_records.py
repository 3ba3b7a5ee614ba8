"""Recordings as other people have them are read as they are; they are no part of the project."""

from pathlib import Path

import pytest

from tests.command import invoke

REAL = Path(__file__).parents[3] / "shared" / "real"
pytestmark = pytest.mark.skipif(not REAL.is_dir(), reason="the recordings are not here")
# What is said of each small set that was made worse in one way: refused with these words, or read with them.
SMALL = {
    "delay-loop": (True, "force seems to be late by 0.9"),
    "delay-steady": (True, "delay_ms = -4.0"),
    "excel-days": (False, 'looks like days of Excel; write unit = "excel"'),
    "force-negated-one-loop": (True, "test-01.csv: force gives out energy"),
    "input-negated": (True, "write sign = -1 at input in [measurement.columns]"),
    "iso-time": (True, "time stamps are dates"),
    "jitter": (True, "time stamps scatter by 2.7 % of a step"),
    "lost-sample": (False, "a step of phase of 6.3 degrees near 0.49"),
    "nan-outside-selection": (True, "0.7925 s of 1.19"),
    "stated-amplitude-sign": (
        True,
        "test-01.csv, test-03.csv, test-05.csv: the second harmonic has the other",
    ),
    "two-rates": (True, "of input (recorded at 2000 Hz)"),
    "units-row-unknown": (False, 'displacement: the file says "in", its unit is stated as "mm"'),
}


@pytest.mark.few(4)
@pytest.mark.parametrize("name", SMALL)
def test_what_is_wrong_with_a_set_is_told(name):
    valid, words = SMALL[name]
    told = invoke("check", REAL / "small" / name / "measured.toml", code=0 if valid else 2)
    assert words in told
    assert ("valid" in told) == valid


def copied(directory, name, *changes):
    """A small set with changes of its measured.toml."""
    for file in (REAL / "small" / name).iterdir():
        (directory / file.name).write_bytes(file.read_bytes())
    path = directory / "measured.toml"
    text = path.read_text()
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    path.write_text(text)
    return path


@pytest.mark.few(2)
@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("delay-steady", ('column = "u"', 'column = "u"\ndelay_ms = -4.0')),
        ("delay-loop", ('column = "F"', 'column = "F"\ndelay_ms = 1.0')),
        ("input-negated", ('column = "u"', 'column = "u"\nsign = -1')),
        ("force-negated-one-loop", ('file = "test-01.csv"', 'file = "test-01.csv"\ncolumns.force.sign = -1')),
    ],
)
def test_the_line_that_is_named_mends_it(tmp_path, name, change):
    assert "warning" not in invoke("check", copied(tmp_path, name, change))


@pytest.mark.acceptance
def test_rests_of_an_exact_displacement_do_not_count(tmp_path):
    path = copied(tmp_path, "loop-exact-rests")
    effects = "viscous_damping,stribeck"
    told = invoke("diagnose", path, "-o", tmp_path / "out", "--no-report", "--effects", effects)
    assert "Nothing is missing" in told
