"""Both solvers on a few of the random cases of ``scripts/agreement.py``, which runs 200 of them."""

import agreement
import pytest

# All laws and leans, preload, guide friction, forces that turn negative; 100 locks, 196 has a force
# that is negative for a fortieth of a period.
NUMBERS = (2, 3, 6, 10, 100, 181, 189, 196)
LOCKED = {100}


@pytest.mark.few(2)
@pytest.mark.parametrize("number", NUMBERS)
def test_radau_and_event_driven_agree(number):
    result = agreement.compared(number)
    assert result.moved < agreement.MOVED or number in LOCKED
    assert result.agrees, result
    assert (result.statuses[0] == "locked") == (number in LOCKED)


def test_the_report_names_what_disagrees():
    fine = agreement.Result("one", 1.0, 1.0, 1.0, ("ok", "ok", "ok"), 0.0)
    apart = fine._replace(case="two", ours=1.0 + 2e-6)
    lost = fine._replace(case="three", ours=float("nan"), statuses=("locked", "ok", "ok"))
    restless = fine._replace(case="four", ours=2.0, coarse=1.1)
    assert agreement.report([fine] * 50)[1]
    assert agreement.report([*[fine] * 99, restless])[1]
    for wrong in (apart, lost):
        text, well = agreement.report([*[fine] * 99, wrong])
        assert not well
        assert f"  {wrong.case}: " in text
    assert not agreement.report([*[fine] * 9, restless])[1]
