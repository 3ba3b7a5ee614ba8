"""How functions are compiled that only compiled functions call, and what is traced of their operations."""

from typing import NamedTuple

import numpy as np
import pytest

from wedgesweep.compiled import allocating, compiled, inlined, inner, inner_code
from wedgesweep.traced import traced

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


class Pair(NamedTuple):
    """Two numbers."""

    first: float
    second: float


def operations(numbers):
    (a, b), pair = numbers
    total = 0.0
    for k in range(1, 4):
        total = total + k * a - b / k
    return Pair(2.0 - pair.first, 3.0 / pair.second), (total, a * b, 1.0 + b)


line = traced(operations)


@compiled
def called(a, b, first, second):
    return line(((a, b), Pair(first, second)))


def test_every_operation_is_that_of_python():
    numbers = 1.3, -0.7, 2.5, 0.4
    found = called(*numbers)
    exact = operations((numbers[:2], Pair(*numbers[2:])))
    assert isinstance(found[0], Pair)
    assert found[0] == pytest.approx(exact[0], rel=1e-15)
    assert found[1] == pytest.approx(exact[1], rel=1e-15)


def test_a_decision_by_a_value_is_refused():
    decided = traced(lambda numbers: numbers[0] if numbers[0] else numbers[1])

    @compiled
    def call(a, b):
        return decided((a, b))

    with pytest.raises(TypeError, match="decides nothing"):
        call(1.0, 2.0)
