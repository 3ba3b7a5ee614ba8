"""Pairs are found even where their effects do not show alone."""

from tests.diagnose.drawn import drawn
from wedgesweep.diagnose import pairs
from wedgesweep.diagnose.search import Search

# More preload and less friction: alone, neither explains as much as another mass.
TRUTH = {"preload": {"force": 0.3}, "friction_level": {"scale": 0.85}}
CANDIDATES = (*TRUTH, "bolster_mass")


def test_an_effect_that_shows_only_beside_another_is_tried_beside_all(monkeypatch):
    monkeypatch.setattr(pairs, "PARTNERS", 1)
    search = Search(drawn(TRUTH), CANDIDATES)
    base = search.base().fit
    singles = search.singles(base)
    assert min(singles, key=lambda each: each.fit.q).effects == ("bolster_mass",)
    best = pairs.pairs(search, base, singles)[0]
    assert set(best.effects) == set(TRUTH)
    assert best.fit.p > 1e-3
