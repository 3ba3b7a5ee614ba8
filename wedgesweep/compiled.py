"""numba, set up once: compiled code is cached under a digest of the sources it was made from.

numba's own cache looks only at the file of the function itself, so that an edited callee would leave
a stale caller behind. A cache folder per state of the compiled sources rules that out.
"""

import atexit
import gc
import inspect
import os
from collections.abc import Callable, Mapping, Sequence
from hashlib import sha256
from pathlib import Path
from shutil import rmtree
from tempfile import TemporaryFile, mkdtemp
from typing import Any, TypeVar, cast

import numba
from numba import types
from numba.core import cgutils, event
from numba.core.dispatcher import Dispatcher
from numba.core.registry import cpu_target
from numba.core.typing.templates import AbstractTemplate, infer_global
from numba.extending import intrinsic

from wedgesweep.inner_code import InnerCompiler, InnerDispatcher
from wedgesweep.known_types import keep_known_types

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


def _usable(home: Path) -> tuple[Path, Path | None]:
    """The cache folder to use; and the one below ``home`` if that cannot be written to, else None.

    A temporary folder then takes its place: until this process ends, and for the jobs that it starts as well.
    """
    # numba's cache is valid for sources in one place only.
    sources = source_digest(containing=b"from wedgesweep.compiled") + str(PACKAGE)
    wanted = home / sha256(sources.encode()).hexdigest()[:16]
    try:
        wanted.mkdir(parents=True, exist_ok=True)
        with TemporaryFile(dir=wanted):
            return wanted, None
    except OSError:
        place = mkdtemp(prefix="wedgesweep-")
        atexit.register(rmtree, place, ignore_errors=True)
        os.environ["NUMBA_CACHE_DIR"] = place
        return Path(place), wanted


CACHE_DIR, UNWRITABLE = _usable(_cache_home())
numba.config.CACHE_DIR = str(CACHE_DIR)  # type: ignore[attr-defined]

Function = TypeVar("Function", bound=Callable)


class _PausedCollector(event.Listener):
    """Spares the garbage collector what numba makes.

    While numba compiles, a search would find nothing. Afterwards it would free some hundred MB. Both would
    take a sixth of the time.
    """

    def __init__(self) -> None:
        self._depth, self._was_on = 0, False

    def on_start(self, event: Any) -> None:
        if self._depth == 0:
            self._was_on = gc.isenabled()
            gc.disable()
        self._depth += 1

    def on_end(self, event: Any) -> None:
        self._depth -= 1
        if self._depth == 0 and self._was_on:
            gc.freeze()
            gc.enable()


event.register("numba:compile", _PausedCollector())
keep_known_types(cpu_target.typing_context)

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
# References to arrays are not counted: callers hold the arrays. (Any: numba's stubs know only some options.)
INNER: Any = {**OPTIONS, "_nrt": False, "no_cpython_wrapper": True, "pipeline_class": InnerCompiler}
CONTRACTED: Any = INNER | {"forceinline": True, "fastmath": {"contract"}}


def compiled(function: Function) -> Function:
    """Compile a function that Python calls."""
    return cast(Function, numba.njit(cache=True, **OPTIONS)(function))


def _inner(function: Function, options: dict[str, Any]) -> Function:
    options = {"nopython": True} | options
    compiler = options.pop("pipeline_class")
    return cast(Function, InnerDispatcher(function, targetoptions=options, pipeline_class=compiler))


def inner(function: Function) -> Function:
    """Compile a function that only compiled functions call (see inner_code.py); it cannot make arrays."""
    return _inner(function, INNER)


def allocating(function: Function) -> Function:
    """As ``inner``, for a function that makes arrays, or calls one that returns them."""
    return _inner(function, INNER | {"_nrt": True})


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


class Pointer(types.WrapperAddressProtocol):
    """A compiled function as an argument of compiled code.

    Its callers hold its address instead of a copy of its code, and compile in a fraction of the time.
    ``arguments`` are examples of its arguments, ``result`` is numba's type of what it returns.
    """

    def __init__(self, function: Callable, result: Any, arguments: tuple) -> None:
        self._signature = result(*map(numba.typeof, arguments))
        self._code = numba.cfunc(self._signature, cache=True, error_model="numpy")(function)

    def __wrapper_address__(self) -> int:
        return cast(int, self._code.address)

    def signature(self) -> Any:
        return self._signature


def function_of(arguments: Sequence[str], body: str, **scope: Any) -> Callable:
    """A function of these arguments that returns an expression: numba compiles it like any other."""
    exec(f"def function({', '.join(arguments)}):\n    return {body}", scope)
    return cast(Callable, scope["function"])


_MADE_BY_RECORD: dict[Callable, types.Function] = {}


def by_record(function: Function, choose: Callable[[Mapping[str, Any]], Callable]) -> Function:
    """Let compiled code call another function in place of this one, chosen by the type of the record ``p``.

    ``choose`` gets the fields of the record's type and returns the function, compiled or plain, so that what
    a record has no fields for costs nothing. Returns ``function`` itself, which is what Python would call.
    """
    place = list(inspect.signature(function).parameters).index("p")
    made: dict[types.Record, Any] = {}

    class Chosen(AbstractTemplate):
        key = function

        def generic(self, arguments: Any, keywords: Any) -> Any:
            record = arguments[place]
            if not isinstance(record, types.Record):
                return None
            if record not in made:
                chosen = choose(record.fields)
                ready = isinstance(chosen, Dispatcher) or chosen in _MADE_BY_RECORD
                made[record] = chosen if ready else inlined(chosen)
            self.kind = _MADE_BY_RECORD.get(made[record]) or types.Dispatcher(made[record])
            return self.kind.get_call_type(self.context, arguments, keywords)

        def get_impl_key(self, signature: Any) -> Any:
            return self.kind.get_impl_key(signature)

    _MADE_BY_RECORD[function] = types.Function(Chosen)
    infer_global(function, _MADE_BY_RECORD[function])
    return function


def forward(arguments: Sequence[str], target: Callable) -> Callable:
    """A plain function that passes its arguments on to compiled code."""
    return function_of(arguments, f"target({', '.join(arguments)})", target=target)


def term(owner: str, off: str, **scope: Any) -> Callable[[Function], Function]:
    """Let compiled code call a function only for records p that have a part named ``owner``.

    For other records it is the expression ``off`` of its arguments; ``scope`` holds the names in it.
    """

    def decorate(function: Function) -> Function:
        arguments = list(inspect.signature(function).parameters)
        present, absent = inlined(function), function_of(arguments, off, **scope)
        return by_record(function, lambda fields: present if owner in fields else absent)

    return decorate
