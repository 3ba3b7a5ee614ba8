"""Shares of forms in a force that is known with an error."""

import numpy as np

from wedgesweep.diagnose.empirical.force_map import ForceMap
from wedgesweep.diagnose.empirical.nearest import FORMS, nearest

PLACES, SPEEDS = np.linspace(-1.0, 1.0, 7), np.linspace(-1.0, 1.0, 13)
GRID = np.meshgrid(PLACES, SPEEDS, indexing="ij")
DRAG, SPRING = "drag (quadratic_drag)", "spring (bolster_stiffness)"


def force_map(force, std):
    covariance = std**2 * np.eye(force.size)
    return ForceMap(PLACES, SPEEDS, force, covariance, np.ones(force.shape))


def test_a_form_explains_itself_and_forms_at_right_angles_share():
    (first, *_) = nearest(force_map(FORMS[DRAG](*GRID) + 5.0, 1e-6))
    assert (first.name, round(first.share, 9)) == (DRAG, 1.0)
    z, v = GRID
    both = z / np.linalg.norm(z) + v * np.abs(v) / np.linalg.norm(v * np.abs(v))
    shares = {each.name: each.share for each in nearest(force_map(both, 1e-6))}
    assert np.allclose([shares[DRAG], shares[SPRING]], 0.5)


def test_intervals_hold_the_share_of_the_force_without_error():
    true = FORMS[DRAG](*GRID) + 0.4 * GRID[0]
    share = {each.name: each.share for each in nearest(force_map(true, 1e-6))}[DRAG]
    held = 0
    for seed in range(100):
        drawn = true + np.random.default_rng(seed).normal(0.0, 0.15, true.shape)
        (found,) = (each for each in nearest(force_map(drawn, 0.15)) if each.name == DRAG)
        low, high = found.interval
        assert low <= found.share <= high
        held += low <= share <= high
    assert held >= 85
