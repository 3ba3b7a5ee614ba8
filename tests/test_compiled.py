"""How functions are compiled that only compiled functions call."""

import gc
import operator
from types import SimpleNamespace

import numpy as np
import pytest
from numba import types
from numba.core.errors import TypingError
from numba.core.registry import cpu_target

from wedgesweep.compiled import allocating, inlined, inner
from wedgesweep.known_types import keep_known_types


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


def test_types_of_numbers_are_inferred_once():
    """Anything else, and what ended with an error, is inferred again."""
    context, asked = SimpleNamespace(), []

    def resolve(function, arguments, keywords):
        asked.append((function, arguments))
        if arguments[0] == types.unicode_type:
            message = "no signature"
            raise TypingError(message)
        return arguments[0](*arguments)

    context.resolve_function_type = resolve
    keep_known_types(context)
    cpu_target.typing_context.refresh()
    add, less = map(cpu_target.typing_context.resolve_value_type, (operator.add, operator.lt))
    for function, kind in ((add, types.float64), (add, types.int64), (less, types.float64)) * 2:
        assert context.resolve_function_type(function, (kind, kind), {}) == kind(kind, kind)
    assert len(asked) == 3
    for _ in range(2):
        with pytest.raises(TypingError):
            context.resolve_function_type(add, (types.unicode_type,), {})
        context.resolve_function_type(add, (types.float64[:],), {})
    assert len(asked) == 7


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


@pytest.mark.parametrize("on", [True, False])
def test_the_collector_is_as_before_after_compilation(on):
    seen = []
    before = gc.isenabled()
    try:
        gc.enable() if on else gc.disable()
        from_python(lambda x: x + 1.0)(1.0)
        seen.append(gc.isenabled())
        with pytest.raises(Exception, match="nothing"):
            from_python(lambda x: x.nothing)(1.0)
        seen.append(gc.isenabled())
    finally:
        gc.enable() if before else gc.disable()
    assert seen == [on, on]
