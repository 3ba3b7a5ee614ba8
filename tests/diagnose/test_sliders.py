"""Springs with sliders: Prandtl's element is a spring up to its elongation, and turns on a straight line."""

import numpy as np

from wedgesweep.diagnose import sliders


def test_a_slider_is_a_spring_until_it_slips_also_after_a_turn():
    out, back = np.linspace(0.0, 1.0, 401), np.linspace(1.0, -1.0, 801)
    half, elongation = 1.0, sliders.ELONGATIONS
    forces = sliders.forces(np.concatenate([out, back[1:]]), half)
    np.testing.assert_allclose(
        forces[:, :401], np.minimum(out / (half * elongation)[:, None], 1.0), atol=1e-12
    )
    after = np.maximum(1.0 - (1.0 - back[1:]) / (half * elongation)[:, None], -1.0)
    np.testing.assert_allclose(forces[:, 401:], after, atol=1e-11)
