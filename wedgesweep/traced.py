"""Compiled straight lines of arithmetic from Python functions with loops.

numba would compile a loop over the terms of a series as a loop, and takes seconds where some hundred sums are
written out. A traced function runs once, in Python, on symbols in place of numbers: each operation becomes an
instruction.
"""

import inspect
from collections.abc import Callable
from functools import partialmethod
from typing import Any, TypeVar, cast

import numba
from llvmlite import ir
from numba import types

from wedgesweep.compiled import with_code

Function = TypeVar("Function", bound=Callable)
# A product and its sum may be rounded once.
FLAGS = ("contract",)


class _Symbol:
    """A number of compiled code."""

    def __init__(self, builder: ir.IRBuilder, value: Any) -> None:
        self.builder, self.value = builder, value

    def _operation(self, other: Any, name: str, swapped: bool = False) -> "_Symbol":
        value = other.value if isinstance(other, _Symbol) else ir.Constant(ir.DoubleType(), float(other))
        both = (value, self.value) if swapped else (self.value, value)
        return _Symbol(self.builder, getattr(self.builder, name)(*both, flags=FLAGS))

    def __abs__(self) -> "_Symbol":
        absolute = self.builder.module.declare_intrinsic("llvm.fabs", [ir.DoubleType()])
        return _Symbol(self.builder, self.builder.call(absolute, [self.value]))

    def __bool__(self) -> bool:
        raise TypeError("a traced function decides nothing by the value of a number")

    __add__ = partialmethod(_operation, name="fadd")
    __sub__ = partialmethod(_operation, name="fsub")
    __mul__ = partialmethod(_operation, name="fmul")
    __truediv__ = partialmethod(_operation, name="fdiv")
    __radd__ = partialmethod(_operation, name="fadd", swapped=True)
    __rsub__ = partialmethod(_operation, name="fsub", swapped=True)
    __rmul__ = partialmethod(_operation, name="fmul", swapped=True)
    __rtruediv__ = partialmethod(_operation, name="fdiv", swapped=True)


def _parts(kind: Any) -> list | None:
    """Types of the parts of a tuple, or None."""
    return list(cast(Any, kind)) if isinstance(kind, types.BaseTuple) else None


def _built(kind: Any, parts: list) -> Any:
    """The tuple of a numba type from its parts."""
    return kind.instance_class(*parts) if hasattr(kind, "instance_class") else tuple(parts)


def _ones(kind: Any) -> Any:
    """Numbers, or nested tuples of them, of a numba type."""
    kinds = _parts(kind)
    return 1.0 if kinds is None else _built(kind, [_ones(each) for each in kinds])


def _symbols(builder: ir.IRBuilder, kind: Any, value: Any) -> Any:
    """Symbols for a number, or for all numbers in a tuple."""
    kinds = _parts(kind)
    if kinds is None:
        return _Symbol(builder, value)
    parts = [_symbols(builder, each, builder.extract_value(value, i)) for i, each in enumerate(kinds)]
    return _built(kind, parts)


def _packed(context: Any, builder: ir.IRBuilder, kind: Any, found: Any) -> Any:
    """The value of compiled code for what a traced function has returned."""
    kinds = _parts(kind)
    if kinds is None:
        return found.value
    parts = [_packed(context, builder, *each) for each in zip(kinds, found, strict=True)]
    return context.make_tuple(builder, kind, parts)


def traced(function: Function) -> Function:
    """Let compiled code call a Python function of numbers and tuples, with its loops written out.

    Tuples hold floats, or tuples of floats. The function adds, subtracts, multiplies and divides them, and
    takes no decision that depends on their values.
    """

    def typed(*kinds: Any) -> Any:
        result = numba.typeof(function(*map(_ones, kinds)))

        def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            given = (_symbols(builder, *each) for each in zip(signature.args, values, strict=True))
            return _packed(context, builder, result, function(*given))

        return result(*kinds), code

    return cast(Function, with_code(list(inspect.signature(function).parameters), typed))
