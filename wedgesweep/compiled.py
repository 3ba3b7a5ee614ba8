"""How functions are compiled, by numba; kernels.py keeps the code between runs.

Functions that Python calls are ``compiled``; those that only compiled code calls are ``inner``, ``inlined``
or ``allocating``, and inner_code.py compiles them in a third of numba's time. Where numba's internals differ
from what that needs, or ``WEDGESWEEP_COMPILER=plain`` asks for it, numba's own compiler takes its place.
"""

import inspect
from ast import literal_eval
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import cache
from typing import Any, TypeVar, cast

import numba
from numba import types
from numba.core import cgutils
from numba.core.ccallback import CFunc
from numba.core.typing.templates import AbstractTemplate, infer_global
from numba.extending import intrinsic

from wedgesweep.kernels import PLAIN, KernelCache

inner_code: Any = None
if not PLAIN:
    with suppress(ImportError):
        from wedgesweep import inner_code

Function = TypeVar("Function", bound=Callable)

# A division by zero gives inf or NaN, as in numpy. Threads run without the interpreter's lock. Nothing calls
# these functions from C, and without C wrappers compilation takes nine tenths of the time. The last two
# options stand here because a function inherits those of its caller otherwise.
OPTIONS: dict[str, Any] = {
    "error_model": "numpy",
    "nogil": True,
    "no_cfunc_wrapper": True,
    "forceinline": False,
    "_nrt": True,
}
# (Any: numba's stubs know only some options.)
ALLOCATING: Any = OPTIONS | {"no_cpython_wrapper": True}
INNER: Any = ALLOCATING
if inner_code:
    ALLOCATING = ALLOCATING | {"pipeline_class": inner_code.InnerCompiler}
    # References to arrays are not counted: callers hold the arrays.
    INNER = ALLOCATING | {"_nrt": False}
CONTRACTED: Any = INNER | {"forceinline": True, "fastmath": {"contract"}}


def compiled(function: Function) -> Function:
    """Compile a function that Python calls."""
    dispatcher = cast(Any, numba.njit(**OPTIONS)(function))
    dispatcher._cache = KernelCache(function)
    return cast(Function, dispatcher)


def _inner(function: Function, options: dict[str, Any]) -> Function:
    if not inner_code:
        return cast(Function, numba.njit(**options)(function))
    return cast(Function, inner_code.compile_inner(function, options))


def inner(function: Function) -> Function:
    """Compile a function that only compiled functions call (see inner_code.py); it cannot make arrays."""
    return _inner(function, INNER)


def allocating(function: Function) -> Function:
    """As ``inner``, for a function that makes arrays, or calls one that returns them."""
    return _inner(function, ALLOCATING)


def inlined(function: Function) -> Function:
    """As ``inner``, and copied into its callers: for short functions in the innermost loops."""
    return _inner(function, INNER | {"forceinline": True})


def contracted(function: Function) -> Function:
    """As ``inlined``; a product and its sum may be rounded once, which shortens chains of operations."""
    return _inner(function, CONTRACTED)


def _without_owner(context: Any, builder: Any, kind: Any, value: Any) -> Any:
    """LLVM value of an array, or of a tuple of arrays, without reference counting."""
    if isinstance(kind, types.Array):
        array = context.make_array(kind)(context, builder, value)
        array.meminfo = cgutils.get_null_value(array.meminfo.type)
        return array._getvalue()
    if isinstance(kind, types.BaseTuple):
        for i, part in enumerate(cast(Any, kind)):
            item = _without_owner(context, builder, part, builder.extract_value(value, i))
            value = builder.insert_value(value, item, i)
    return value


def _borrowed(typing_context: Any, value: Any) -> Any:
    """The same array, or tuple of arrays, without reference counting; the caller keeps the original alive.

    numba counts references to an array at every call, with atomic operations: they took two thirds of the
    time of short functions.
    """

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return _without_owner(context, builder, signature.args[0], arguments[0])

    return value(value), code


borrowed = cast(Callable[[Any], Any], intrinsic(_borrowed))


def _record_in(typing_context: Any, kind: Any, content: Any) -> Any:
    """The record of a type (a dtype) that an array of bytes holds, without a copy."""

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        array = context.make_array(content)(context, builder, arguments[1])
        return builder.bitcast(array.data, context.get_value_type(kind.dtype))

    return kind.dtype(kind, content), code


record_in = cast(Callable[[Any, Any], Any], intrinsic(_record_in))


class Pointer(types.WrapperAddressProtocol):
    """A compiled function as an argument of compiled code.

    Its callers hold its address instead of a copy of its code, and compile in a fraction of the time.
    ``arguments`` are examples of its arguments, ``result`` is numba's type of what it returns.
    """

    def __init__(self, function: Callable, result: Any, arguments: tuple) -> None:
        self._signature = result(*map(numba.typeof, arguments))
        signature = (self._signature.args, self._signature.return_type)
        options = {"nopython": True, "error_model": "numpy"}
        self._code = cast(Any, CFunc(function, signature, {}, options))
        self._code._cache = KernelCache(function)
        self._code.compile()

    def __wrapper_address__(self) -> int:
        return cast(int, self._code.address)

    def signature(self) -> Any:
        return self._signature


def function_of(arguments: Sequence[str], body: str, **scope: Any) -> Callable:
    """A function of these arguments that returns an expression: numba compiles it like any other."""
    exec(f"def function({', '.join(arguments)}):\n    return {body}", scope)
    return cast(Callable, scope["function"])


def expression_of(arguments: Sequence[str], body: str, **scope: Any) -> Callable:
    """As ``function_of``; a constant, or one of the arguments, needs no function to be compiled."""
    if body not in arguments and body not in LITERALS:
        return function_of(arguments, body, **scope)

    def typed(*kinds: Any) -> Any:
        place = arguments.index(body) if body in arguments else None
        value = None if body in arguments else literal_eval(body)
        result = numba.typeof(value) if place is None else types.unliteral(kinds[place])

        def code(target: Any, builder: Any, signature: Any, given: Any) -> Any:
            return target.get_constant_generic(builder, result, value) if place is None else given[place]

        return result(*kinds), code

    return with_code(arguments, typed)


def with_code(arguments: Sequence[str], typed: Callable) -> Callable:
    """An intrinsic of numba with these arguments; ``typed`` gets their types: signature and code."""
    body = f"typed({', '.join(arguments)})"
    return cast(Callable, intrinsic(function_of(["context", *arguments], body, typed=typed)))


# Expressions whose value stands in the code itself.
LITERALS = ("0.0", "1.0", "0", "()", "False")


@cache
def contracted_of(arguments: tuple[str, ...], body: str) -> Callable:
    """As ``function_of``, ``contracted``; the same one for the same text."""
    return contracted(function_of(arguments, body))


def by_type(function: Callable) -> Callable[[Function], Function]:
    """Let compiled code call other functions in place of this one, chosen by the types of the arguments.

    What is decorated gets numba's types, and returns compiled code: always the same for the same purpose, so
    that it is compiled once. It returns None for arguments that there is nothing for.
    """

    def decorate(choose: Function) -> Function:
        class Chosen(AbstractTemplate):
            key = function

            def generic(self, arguments: Any, keywords: Any) -> Any:
                chosen = choose(*arguments)
                if chosen is None:
                    return None
                self.context.refresh()  # it may be an intrinsic that was made just now
                self.kind = self.context.resolve_value_type(chosen)
                return self.kind.get_call_type(self.context, arguments, keywords)

            def get_impl_key(self, signature: Any) -> Any:
                return self.kind.get_impl_key(signature)

        _BY_TYPE.add(function)
        infer_global(function, types.Function(Chosen))
        return choose

    return decorate


_BY_TYPE: set[Callable] = set()


def by_record(function: Function, choose: Callable[..., Callable], vector: str | None = None) -> Function:
    """Let compiled code call another function in place of this one, chosen by the type of the record ``p``.

    ``choose`` gets the fields of the record's type and returns the function, compiled or plain, so that what
    a record has no fields for costs nothing. It also gets the length of the argument ``vector``, if one is
    named. Returns ``function`` itself, which is what Python would call.
    """
    arguments = list(inspect.signature(function).parameters)
    place, of_vector = arguments.index("p"), arguments.index(vector) if vector else 0

    @cache
    def chosen_for(record: types.Record, *length: int) -> Callable:
        chosen = choose(cast(Any, record).fields, *length)
        return inlined(chosen) if inspect.isfunction(chosen) and chosen not in _BY_TYPE else chosen

    def of_types(*kinds: Any) -> Callable | None:
        if not isinstance(kinds[place], types.Record):
            return None
        return chosen_for(kinds[place], *([len(kinds[of_vector])] if vector else []))

    by_type(function)(of_types)
    return function


def term(owner: str, off: str, **scope: Any) -> Callable[[Function], Function]:
    """Let compiled code call a function only for records p that have a part named ``owner``.

    For other records it is the expression ``off`` of its arguments; ``scope`` holds the names in it.
    """

    def decorate(function: Function) -> Function:
        arguments = list(inspect.signature(function).parameters)
        present, absent = inlined(function), expression_of(arguments, off, **scope)
        return by_record(function, lambda fields: present if owner in fields else absent)

    return decorate
