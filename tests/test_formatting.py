"""Formatted numbers show what was computed, to the digits that are known."""

from wedgesweep import formatting
from wedgesweep.report import phrases

NUMBERS = {
    0.0: "0",
    5.1: "5.10",
    -0.0123: "-0.0123",
    61234.0: "61\N{NARROW NO-BREAK SPACE}234",
    3.14e8: "3.14 × 10⁸",
    -2.0e-5: "-2.00 × 10⁻⁵",
    float("nan"): "–",
    float("inf"): "–",
    None: "–",
}


def test_numbers():
    assert {value: formatting.number(value) for value in NUMBERS} == NUMBERS
    # Short ones have no zeros at their end.
    short = {24.0: "24", 0.1: "0.1", 14.6667: "14.67", 120.0: "120", 1e-7: "1.000 × 10⁻⁷"}
    assert {value: formatting.short(value) for value in short} == short
    # A share that is not all is not called all.
    shares = {0.5: "50", 0.991: "99.1", 0.9999999: "99.99", 1.0: "100", -0.2: "-20"}
    for share, text in shares.items():
        assert formatting.percent(share) == f"{text}{formatting.NO_BREAK}%"
    times = {0.34: "0.3 s", 59.6: "60 s", 119: "119 s", 600: "10 min", 7500: "2 h 5 min"}
    assert {seconds: formatting.duration(seconds) for seconds in times} == times
    sizes = {3: "3 B", 24.6e6: "25 MB", 999.7e3: "1 MB", 1.23e9: "1.2 GB"}
    assert {count: formatting.size(count) for count in sizes} == sizes


def test_keys_become_a_name_and_a_unit():
    assert phrases.split_key("third_phase_deg") == ("third phase", "°")
    assert phrases.split_key("coefficient_N_per_mm3") == ("coefficient", "N/mm³")
    assert phrases.split_key("scale") == ("scale", "")


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
