"""Both solvers on a few of the random cases of ``scripts/agreement.py``, which runs 300 of them."""

import agreement
import pytest

# Both leans, preload; 100 locks, 196 has a force that is negative for a fortieth of a period.
NUMBERS = (3, 100, 196)
LOCKED = {100}


@pytest.mark.acceptance
@pytest.mark.parametrize("number", NUMBERS)
def test_radau_and_event_driven_agree(number):
    result = agreement.compared(agreement.sine, number)
    assert result.moved < agreement.MOVED or number in LOCKED
    assert result.agrees, result
    assert (result.statuses[0] == "locked") == (number in LOCKED)


@pytest.mark.acceptance
@pytest.mark.parametrize("number", [0, 17])
def test_both_solvers_agree_on_random_transients(number):
    result = agreement.compared(agreement.transient, number)
    assert result.moved < agreement.MOVED
    assert result.agrees, result


def test_the_report_names_what_disagrees():
    fine = agreement.Result("one", 0.0, 0.0, ("ok", "ok", "ok"))
    apart = fine._replace(case="two", apart=2e-6)
    lost = fine._replace(case="three", apart=float("nan"), statuses=("locked", "ok", "ok"))
    restless = fine._replace(case="four", apart=1.0, moved=0.1)

    def report(*results):
        return agreement.report("sine", results)

    assert report(*[fine] * 50)[1]
    assert report(*[fine] * 99, restless)[1]
    for wrong in (apart, lost):
        text, well = report(*[fine] * 99, wrong)
        assert not well
        assert f"  {wrong.case}: " in text
    assert not report(*[fine] * 9, restless)[1]
