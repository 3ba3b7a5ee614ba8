"""Recordings like those that people have, by an independent simulator: right causes, no false friction."""

import look_alikes
import pytest

NAMED = {
    "stiffening, random force": {"cubic_stiffness"},
    "stiffening, nine samples a period": {"cubic_stiffness"},
    "drag, random force": {"quadratic_drag"},
    "pendulum from 10 deg": {"viscous_damping", "cubic_stiffness"},
    # A sine is no candidate, and from far away damping is less than what a cubic spring leaves of it.
    "pendulum from 60 deg": {"cubic_stiffness"},
    "pendulum with drag": {"cubic_stiffness"},
    "pendulum with dry friction": {"cubic_stiffness", "guide_friction"},
    "damper that differs by direction": {"directional_damping"},
    "damper with play of 1 mm": {"damper_play"},
    "damper on a bushing": {"series_compliance"},
    "spring with play": {"backlash"},
    "spring that stiffens": {"cubic_stiffness"},
}
NOTHING = ("linear, random force", "damper")
# One of each verdict: a loop and a release; make validate has all of them.
FEW = ("damper", "pendulum from 60 deg")


def comes_out_right(name):
    """Diagnose a look-alike and compare the answer with what is expected."""
    found = look_alikes.diagnosed(look_alikes.MADE[name]())
    causes = {cause["effect"] for cause in found.causes}
    if name in NOTHING:
        assert found.verdict == "nothing-missing"
    else:
        assert (found.verdict, causes) in (("named", NAMED[name]), ("consistent-with", NAMED[name]))


def test_no_look_alike_is_left_out():
    assert {*NAMED, *NOTHING} == set(look_alikes.MADE) > set(FEW)


@pytest.mark.acceptance
@pytest.mark.parametrize("name", FEW)
def test_a_look_alike_comes_out_right(name):
    comes_out_right(name)
