"""Where the search for an explanation goes on, and where it ends."""

import numpy as np
import pytest

from tests.diagnose.drawn import drawn, searched
from wedgesweep.diagnose import diagnosis
from wedgesweep.diagnose.search import Search

CANDIDATES = ("displacement_gain", "velocity_lag")


@pytest.mark.parametrize(
    ("truth", "looked"),
    [({"velocity_lag": {"time": 3e-4}}, False), ({"bolster_mass": {"scale": 1.05}}, True)],
)
def test_all_starts_are_followed_only_where_nothing_will_do(truth, looked, monkeypatch):
    followed = []
    everywhere = Search.everywhere

    def told(self):
        followed.extend(everywhere(self))
        return followed

    monkeypatch.setattr(Search, "everywhere", told)
    search = Search(drawn(truth), CANDIDATES)
    found = diagnosis.explain(search, search.base())
    assert [each.effects for each in followed] == [(name,) for name in CANDIDATES if looked]
    single = {each.effects: each.fit.q for each in found if len(each.effects) == 1}
    for each in followed:
        assert single[each.effects] <= each.fit.q


def test_the_right_way_is_found_though_its_start_looks_worst():
    truth = 3e-4
    search, _, _ = searched(drawn({"velocity_lag": {"time": truth}}), "velocity_lag")
    search.along["velocity_lag"] = sorted(search.along["velocity_lag"], key=lambda trial: trial.q)[-3:]
    assert search.everywhere()[0].fit.x[0] == pytest.approx(truth, rel=0.05)


@pytest.mark.parametrize("length", [0.9e-6, 1.03e-6, 1.5e-6])
def test_what_leads_the_base_model_far_astray_begins_without_it(length):
    """Faces that creep where the base model's stick: it moves only with far less friction or input.

    Nor does a fit get there whose inputs are free to make up for a length that is wrong by then.
    """
    bench = np.array([20.0, 30.0, 6.0]), 1e-3 * np.array([0.0663, 0.0471, 0.2133])
    problem = drawn(
        {"presliding": {"length": length}}, bench=bench, std=0.01, uncertain={"friction_level": 0.02}
    )
    _, base, (found,) = searched(problem, "presliding")
    assert np.abs(base.fit.trial.point.amplitude).max() > 1.0
    assert found.fit.p > 1e-3
    assert found.fit.values["presliding"]["length_mm"] == pytest.approx(1e3 * length, rel=0.05)


def test_a_tone_that_nobody_hears_leaves_nothing_to_fit():
    search = Search(drawn({"viscous_damping": {"coefficient": 8.0}}), ("stray_vibration",))
    base = search.base()
    assert base.fit.p < 1e-9
    assert diagnosis.explain(search, base) == []
