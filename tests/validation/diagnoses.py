"""Full-size diagnoses of planted effects and of the examples of an independent simulator.

They take a quarter of an hour, and run in ``make validate``, not with the tests.
"""

import look_alikes
import pytest
from validation.judge import ABSTAINING

from tests.validation import checks, examples, test_look_alikes
from tests.validation.laboratory import BENCH, CLEAN, GUIDE_FRICTION, Specimen, diagnose, make
from wedgesweep import measured
from wedgesweep.diagnose import diagnosis, work
from wedgesweep.diagnose.search import WORK_PER_TEST
from wedgesweep.effects import EFFECTS

UNCERTAIN = {"friction_level": 0.07}
STRONG = (
    GUIDE_FRICTION,
    Specimen("lag", "exponential", {"velocity_lag": {"time_s": 4e-4}}, "adc", uncertain=UNCERTAIN),
    Specimen(
        "tone",
        "static-dynamic",
        {"stray_vibration": {"acceleration_m_per_s2": 1.0, "frequency_hz": 47.3}},
        "adc",
        tests=BENCH[::2],  # what does not repeat takes long to simulate
        uncertain=UNCERTAIN,
    ),
    Specimen("spring", "coulomb", {"cubic_stiffness": {"coefficient_N_per_mm3": 0.6}}, "differentiated"),
    Specimen(
        "fixture", "static-dynamic", {"fixture_resonance": {"frequency_hz": 90.0, "damping_ratio": 0.1}}
    ),
    Specimen(
        "pair",
        "exponential",
        {"viscous_damping": {"coefficient_N_s_per_m": 6.0}, "displacement_gain": {"scale": 1.06}},
    ),
)
WITHHELD = "column_compliance"


@pytest.mark.parametrize("specimen", STRONG, ids=lambda specimen: specimen.name)
def test_a_strong_cause_is_named_with_its_numbers(specimen, tmp_path):
    checks.strong_cause_is_named(specimen, tmp_path)


def test_in_clean_data_nothing_is_named(tmp_path):
    file, _ = make(CLEAN, tmp_path)
    assert diagnose(file, tmp_path / "found").verdict == "nothing-missing"


def test_an_effect_that_is_no_candidate_is_not_named(tmp_path):
    withheld = Specimen("withheld", "static-dynamic", {WITHHELD: {"stiffness_N_per_mm": 60.0}})
    file, _ = make(withheld, tmp_path)
    found = diagnose(file, tmp_path / "found", [name for name in EFFECTS if name != WITHHELD])
    assert found.document["misfit"]["excess_base"] >= 800.0
    assert found.verdict in ABSTAINING


@pytest.mark.parametrize("name", sorted(examples.TRUTH))
def test_example_comes_out_right(name, tmp_path):
    examples.comes_out_right(name, tmp_path)


@pytest.mark.parametrize("name", sorted(set(look_alikes.MADE) - set(test_look_alikes.FEW)))
def test_a_look_alike_comes_out_right(name):
    test_look_alikes.comes_out_right(name)


@pytest.mark.parametrize("name", examples.IMPERFECT)
def test_a_search_in_which_nothing_fits_ends(name):
    """No model fits to within the noise: the budget is spent, and the hidden effect leads all the same."""
    begun = work.done()
    measurement = measured.read(examples.HARD_EXAMPLES / name / "measured.toml")
    found = diagnosis.diagnose(measurement, threads=2)
    assert found.untried
    # The last fits, scores and predictions come after the search.
    assert work.done() - begun < 1.5 * WORK_PER_TEST * found.data.tests
    hidden = examples.HARD_TRUTH[name]["truth"]
    singles = [each for each in found.explanations if len(each.effects) == 1]
    assert singles[0].effects == tuple(hidden)
    assert found.finding.cause is None or set(hidden) <= set(found.finding.cause.effects)
