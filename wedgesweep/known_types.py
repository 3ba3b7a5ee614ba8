"""Keeps what numba infers for operators and functions of numbers, which it infers anew for every use.

It tries the templates of an operator, which are for arrays, strings, dates and numbers, one after the other,
and describes each one that does not fit: a tenth of the compile time of this package.
"""

from typing import Any

from numba import types

SCALARS = (types.Number, types.Boolean)


def keep_known_types(context: Any) -> None:
    """Let a typing context of numba look up the signatures of calls that it has seen before.

    Only calls of numba's own functions with nothing but numbers: their types alone decide on the signature.
    """
    resolve = context.resolve_function_type
    known: dict[tuple, Any] = {}

    def resolved(function: Any, arguments: tuple, keywords: Any) -> Any:
        own = isinstance(function, types.Function) and not keywords
        if not own or not all(isinstance(each, SCALARS) for each in arguments):
            return resolve(function, arguments, keywords)
        call = function, arguments
        if call not in known:
            known[call] = resolve(*call, keywords)
        return known[call]

    context.resolve_function_type = resolved
