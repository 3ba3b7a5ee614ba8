"""Small vectors as tuples of floats, which compiled code keeps in registers; their type includes the length.

``vector`` and ``store`` convert from and to arrays.
"""

from typing import Any

from numba.core import types
from numba.cpython.unsafe.tuple import tuple_setitem

from wedgesweep.compiled import by_type, contracted_of, inlined
from wedgesweep.traced import traced

_set_item: Any = tuple_setitem


def _products(i, factors, vectors):
    """Element i of each vector times its factor."""
    return [factor * each[i] for factor, each in zip(factors, vectors, strict=True)]


@traced
def weighted(start, scale, weights, vectors):
    """Start + scale (w_1 v_1 + w_2 v_2 + ...), each product with the scale taken first."""
    factors = [scale * weight for weight in weights]
    # Added one by one to the start: each product and its sum are one operation.
    return tuple(sum(_products(i, factors, vectors), each) for i, each in enumerate(start))


@traced
def combination(scale, weights, vectors):
    """The weighted sum alone."""
    factors = [scale * weight for weight in weights]
    elements = [_products(i, factors, vectors) for i in range(len(vectors[0]))]
    return tuple(sum(terms[1:], terms[0]) for terms in elements)


def vector(array, like):
    """The first numbers of an array as a vector as long as another."""
    raise NotImplementedError


@by_type(vector)
def _vector(array, like):
    if not isinstance(like, types.BaseTuple):
        return None
    parts = ", ".join(f"array[{i}]" for i in range(len(like)))
    return contracted_of(("array", "like"), f"({parts},)")


def with_first(y: Any, first: Any) -> Any:
    """The vector with others in place of its first numbers."""
    raise NotImplementedError


@by_type(with_first)
def _with_first(y, first):
    if not isinstance(y, types.BaseTuple):
        return None
    parts = [f"{'first' if i < len(first) else 'y'}[{i}]" for i in range(len(y))]
    return contracted_of(("y", "first"), f"({', '.join(parts)},)")


@inlined
def store(y, out):
    """Write a vector into an array."""
    for i in range(len(y)):
        out[i] = y[i]


@inlined
def replaced(y, place, value):
    """The vector with another number at a place."""
    return _set_item(y, place, value)


@inlined
def with_motion(y, x, velocity):
    """The state vector with another displacement and velocity, the first two states of every system."""
    return replaced(replaced(y, 0, x), 1, velocity)
