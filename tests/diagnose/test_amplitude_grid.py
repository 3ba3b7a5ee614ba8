"""Unknown input amplitudes, from the measured response alone."""

import numpy as np
import pytest

from tests.diagnose.synthetic import base_of, drawn
from wedgesweep.systems.suspension import parameters
from wedgesweep.systems.suspension.rest import breakaway_accelerations

FREQUENCIES = np.array([20.0, 30.0, 8.0, 20.0])


@pytest.mark.parametrize("beyond", [1.6, 2.0])
def test_inputs_are_found_near_breakaway(beyond):
    """There the bolster moves by a small part of its input, and a bit less input holds it."""
    held = breakaway_accelerations(parameters.record("coulomb", 1e-4, 100.0))[0][0]
    true = beyond * held / (2.0 * np.pi * FREQUENCIES) ** 2 * np.array([1.0, 1.0, 1.0, 3.0])
    data = drawn(law="coulomb", known=False, bench=(FREQUENCIES, true))
    if beyond < 2.0:
        assert (true > 30.0 * np.abs(data.measured[:, 0, 0])).sum() == 2
    base = base_of(data)
    assert base.p > 1e-3
    assert base.model.data.amplitudes(base.point) == pytest.approx(true, rel=1e-3)
