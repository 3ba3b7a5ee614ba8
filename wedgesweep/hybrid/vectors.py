"""Small vectors as tuples of floats, which compiled code keeps in registers; their type includes the length.

``vector`` and ``store`` convert from and to arrays.
"""

from collections.abc import Callable
from functools import cache
from typing import Any

from numba.core import types
from numba.cpython.unsafe.tuple import tuple_setitem

from wedgesweep.compiled import by_type, contracted, contracted_of, inlined

_set_item: Any = tuple_setitem


@cache
def _sum_of_products(arguments: str, size: int, count: int) -> Callable:
    """A function that adds ``count`` vectors of ``size`` numbers, to ``start`` if that is an argument."""
    factors = "\n".join(f"    w{j} = scale * weights[{j}]" for j in range(count))
    parts = []
    for i in range(size):
        first = [f"start[{i}]"] if "start" in arguments else []
        parts.append(" + ".join([*first, *(f"w{j} * vectors[{j}][{i}]" for j in range(count))]))
    scope: dict[str, Any] = {}
    exec(f"def sum({arguments}):\n{factors}\n    return ({', '.join(parts)},)", scope)
    return contracted(scope["sum"])


def weighted(start, scale, weights, vectors):
    """Start + scale (w_1 v_1 + w_2 v_2 + ...), each product with the scale taken first."""
    raise NotImplementedError


@by_type(weighted)
def _weighted(start, scale, weights, vectors):
    return _sum_of_products("start, scale, weights, vectors", len(start), len(vectors))


def combination(scale, weights, vectors):
    """The weighted sum alone."""
    raise NotImplementedError


@by_type(combination)
def _combination(scale, weights, vectors):
    return _sum_of_products("scale, weights, vectors", len(vectors[0]), len(vectors))


def vector(array, like):
    """The first numbers of an array as a vector as long as another."""
    raise NotImplementedError


@by_type(vector)
def _vector(array, like):
    if not isinstance(like, types.BaseTuple):
        return None
    parts = ", ".join(f"array[{i}]" for i in range(len(like)))
    return contracted_of(("array", "like"), f"({parts},)")


@inlined
def store(y, out):
    """Write a vector into an array."""
    for i in range(len(y)):
        out[i] = y[i]


@inlined
def replaced(y, place, value):
    """The vector with another number at a place."""
    return _set_item(y, place, value)
