"""Formatted numbers show what was computed, to the digits that are known."""

import pytest

from wedgesweep import formatting
from wedgesweep.report import phrases


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (5.1, "5.10"),
        (-0.0123, "-0.0123"),
        (61234.0, "61\N{NARROW NO-BREAK SPACE}234"),
        (3.14e8, "3.14 × 10⁸"),
        (-2.0e-5, "-2.00 × 10⁻⁵"),
        (float("nan"), "–"),
        (float("inf"), "–"),
        (None, "–"),
    ],
)
def test_number(value, text):
    assert formatting.number(value) == text


def test_short_numbers_have_no_zeros_at_their_end():
    assert [formatting.short(value) for value in (24.0, 0.1, 14.6667, 120.0, 1e-7)] == [
        *("24", "0.1", "14.67", "120", "1.000 × 10⁻⁷")
    ]


@pytest.mark.parametrize(
    ("share", "text"), [(0.5, "50"), (0.991, "99.1"), (0.9999999, "99.99"), (1.0, "100"), (-0.2, "-20")]
)
def test_a_share_that_is_not_all_is_not_called_all(share, text):
    assert formatting.percent(share) == f"{text}{formatting.NO_BREAK}%"


def test_an_estimate_has_the_digits_that_its_interval_allows():
    found = {"value": 5.12345, "ci95": [4.81, 5.49]}
    text = phrases.estimate("velocity_mm_per_s", found).replace(formatting.NO_BREAK, " ")
    assert text == "velocity 5.12 mm/s, 95 % interval 4.81 to 5.49 mm/s"
    wide = phrases.estimate("force_N", {"value": 212.0, "ci95": [90.0, 400.0]})
    assert wide.startswith("force 212")
    assert phrases.compact("force_N", {"value": -0.0039, "ci95": [-0.0081, 0.00021]}).endswith(
        " (-0.0081 to 0.0002)"
    )
    assert phrases.rounded({"value": 1e-4, "ci95": [1e-5, 0.0013]}) == ("0.0001", "1 × 10⁻⁵", "0.0013")
    assert "no interval" in phrases.estimate("scale", {"value": 1.0, "ci95": [None, None]})
    assert "not determined" in phrases.estimate("scale", {"value": None, "ci95": [None, None]})


@pytest.mark.parametrize(
    ("key", "name", "unit"),
    [
        ("third_phase_deg", "third phase", "°"),
        ("coefficient_N_per_mm3", "coefficient", "N/mm³"),
        ("scale", "scale", ""),
    ],
)
def test_keys_become_a_name_and_a_unit(key, name, unit):
    assert phrases.split_key(key) == (name, unit)


def test_times_and_sizes():
    assert [formatting.duration(seconds) for seconds in (0.34, 59.6, 119, 600, 7500)] == [
        *("0.3 s", "60 s", "119 s", "10 min", "2 h 5 min")
    ]
    assert [formatting.size(count) for count in (3, 24.6e6, 999.7e3, 1.23e9)] == [
        *("3 B", "25 MB", "1 MB", "1.2 GB")
    ]
