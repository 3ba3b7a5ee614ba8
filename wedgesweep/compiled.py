"""numba, set up once: compiled code is cached under a digest of the sources it was made from.

numba's own cache looks only at the file of the function itself, so that an edited callee would leave
a stale caller behind. A cache folder per state of the compiled sources rules that out.
"""

import os
from collections.abc import Callable
from hashlib import sha256
from pathlib import Path
from typing import Any, TypeVar, cast

import numba
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

PACKAGE = Path(__file__).parent


def source_digest(containing: bytes = b"") -> str:
    """sha256 (hex) of the package's Python sources that contain the given bytes."""
    digest = sha256()
    for path in sorted(PACKAGE.rglob("*.py")):
        source = path.read_bytes()
        if containing in source:
            digest.update(path.relative_to(PACKAGE).as_posix().encode() + b"\0" + source)
    return digest.hexdigest()


def _cache_home() -> Path:
    default = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(os.environ.get("NUMBA_CACHE_DIR") or Path(default) / "wedgesweep")


CACHE_DIR = _cache_home() / source_digest(containing=b"from wedgesweep.compiled")[:16]
numba.config.CACHE_DIR = str(CACHE_DIR)  # type: ignore[attr-defined]

Function = TypeVar("Function", bound=Callable)


# A division by zero gives inf or NaN, as in numpy; threads run at once; nobody calls these from C, and
# without a way to do so they compile in nine tenths of the time.
OPTIONS: dict[str, Any] = {"cache": True, "error_model": "numpy", "nogil": True, "no_cfunc_wrapper": True}


def compiled(function: Function) -> Function:
    """Compile with numba."""
    return cast(Function, numba.njit(**OPTIONS)(function))


def inlined(function: Function) -> Function:
    """``compiled``, and copied into its callers: for what is short and called in the innermost loops."""
    return cast(Function, numba.njit(forceinline=True, **OPTIONS)(function))


def _without_owner(context: Any, builder: Any, kind: Any, value: Any) -> Any:
    """LLVM code of an array, or of a tuple of such, that nobody counts the users of."""
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
    """The same array, or tuple of arrays, of which the caller keeps the original while it is in use.

    numba counts the users of an array at every call, in steps that hold up the processor: for short functions
    that took two thirds of their time. What is borrowed is not counted.
    """

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return _without_owner(context, builder, signature.args[0], arguments[0])

    return value(value), code


borrowed = cast(Callable[[Any], Any], intrinsic(_borrowed))


class Pointer(types.WrapperAddressProtocol):
    """A compiled function as an argument of compiled code.

    Its callers hold an address, not another copy of all that it calls: they compile in a fraction of
    the time. ``arguments`` are examples of its arguments, ``result`` is numba's type of what it returns.
    """

    def __init__(self, function: Callable, result: Any, arguments: tuple) -> None:
        self._signature = result(*map(numba.typeof, arguments))
        self._code = numba.cfunc(self._signature, cache=True, error_model="numpy")(function)

    def __wrapper_address__(self) -> int:
        return cast(int, self._code.address)

    def signature(self) -> Any:
        return self._signature
