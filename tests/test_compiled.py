"""How functions are compiled that only compiled functions call."""

import numpy as np
import pytest

from wedgesweep.compiled import allocating, inlined, inner, inner_code

pytestmark = pytest.mark.skipif(inner_code is None, reason="numba's own compiler is in its place")


def from_python(function):
    """A function that Python may call, around one that it may not."""
    import numba

    return numba.njit(function)


@inner
def _scaled(factor, values):
    total = 0.0
    for value in values:
        total += factor * value
    return total


def test_constants_share_one_compiled_function():
    @from_python
    def both(values):
        return _scaled(2, values) + _scaled(3, values)

    assert both(np.array([1.0, 2.0])) == 15.0
    assert len(_scaled.overloads) == 1


@pytest.mark.parametrize("decorate", [inner, inlined])
def test_a_function_without_reference_counts_makes_no_arrays(decorate):
    copied = allocating(lambda values: values.copy())
    first = decorate(lambda values: values)
    used = decorate(lambda values: copied(values)[0])
    for wrong in (first, used):
        with pytest.raises(TypeError, match="arrays are for functions marked allocating"):
            from_python(lambda values: wrong(values)[0])(np.zeros(2))  # noqa: B023


def test_allocating_functions_make_arrays():
    """Their arrays are freed once, and not earlier."""

    @allocating
    def doubled(values):
        twice = values.copy()
        twice *= 2.0
        return twice

    @allocating
    def total(values):
        return _scaled(1, doubled(values))

    call = from_python(lambda values: total(values))
    values = np.arange(1000.0)
    for _ in range(100):
        assert call(values) == 2.0 * values.sum()
    assert np.array_equal(values, np.arange(1000.0))


def test_operators_of_numbers_are_inferred_once_and_for_this_package_only():
    known = inner_code._TypingContext.known
    odd = np.int8(3), np.int16(4)  # a product that nothing else here has

    def product(one, other):
        return one * other

    before = len(known)
    assert from_python(product)(*odd) == 12
    assert len(known) == before
    inside = inner(product)
    assert from_python(lambda one, other: inside(one, other))(*odd) == 12
    assert len(known) == before + 1
    again = inner(lambda one, other: one * other)
    assert from_python(lambda one, other: again(one, other))(*odd) == 12
    assert len(known) == before + 1
