"""A step of Radau whose error meets a state without a rate is rejected."""

import numpy as np
import pytest

from wedgesweep.solvers.radau import SmallRadau, StrictRadau

METHODS = pytest.mark.parametrize("method", [StrictRadau, SmallRadau])
MATRIX = np.array([[-3.0, 1.0], [0.5, -2.0]])


def begun(method, rate=lambda t, y: MATRIX @ y):
    return method(rate, 0.0, np.array([1.0, 0.0]), 1.0, jac=lambda t, y: MATRIX, rtol=1e-8, atol=1e-10)


@METHODS
def test_finite_numbers_are_solved_and_others_are_errors_without_end(method):
    solver = begun(method)
    for shift in (2.0, 2.0 + 1.0j):
        matrix, right = shift * np.eye(2) - MATRIX, np.array([0.3, -0.7]) * shift
        assert np.allclose(matrix @ solver.solve_lu(solver.lu(matrix.copy()), right.copy()), right)
        for undetermined in (np.nan, np.inf):
            right[1] = undetermined
            assert np.isinf(solver.solve_lu(solver.lu(matrix.copy()), right)).all()


@METHODS
def test_a_step_is_rejected_where_its_second_estimate_has_no_rate(method):
    """After a rejection only this estimate takes the rate where the step begins."""
    seen = []

    def rate(t, y):
        seen.append(t)
        undetermined = t == 0.0 and len(seen) > 1
        return np.full(2, np.nan) if undetermined else MATRIX @ y + 1e3 * np.cos(200.0 * t)

    solver = begun(method, rate)
    solver.h_abs = 0.5
    solver.step()
    assert seen.count(0.0) > 1
    assert 0.0 < solver.t < 0.05
    assert np.isfinite(solver.y).all()
