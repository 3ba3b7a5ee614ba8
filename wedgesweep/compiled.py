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


def compiled(function: Function) -> Function:
    """Compile with numba; a division by zero gives inf or NaN, as in numpy, and threads run at once."""
    return cast(Function, numba.njit(cache=True, error_model="numpy", nogil=True)(function))


def inlined(function: Function) -> Function:
    """``compiled``, and copied into its callers: for what is short and called in the innermost loops."""
    compiler = numba.njit(cache=True, error_model="numpy", nogil=True, forceinline=True)
    return cast(Function, compiler(function))


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
