"""Where compiled code is kept between runs: a folder for each state of the sources that it was made from.

numba's own cache looks at the file of a function only, so that an edited callee would leave a stale caller
behind. Here the name of the folder is a digest of all sources that code may come from: those of the package,
those of registered modules (laws, effects and systems from outside), and of whatever these import.

``WEDGESWEEP_CACHE_DIR`` names another place than the user's cache folder. No setting of numba is changed.
Folders of sources that nobody has run for a month are removed.
"""

import ast
import os
import re
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import cache
from hashlib import sha256
from importlib.util import resolve_name
from pathlib import Path
from shutil import rmtree
from tempfile import TemporaryFile, gettempdir
from types import ModuleType
from typing import Any

from numba.core.caching import CompileResultCacheImpl, FunctionCache, _CacheLocator

PACKAGE = Path(__file__).parent
VARIABLE = "WEDGESWEEP_CACHE_DIR"
# Whether numba's own compiler is asked for (compiled.py).
PLAIN = os.environ.get("WEDGESWEEP_COMPILER") == "plain"
# What a source of the package contains if something in it is compiled.
COMPILES = b"from wedgesweep.compiled"
# Modules whose sources do not count: those of Python, this package, and libraries that compiled code can use.
KNOWN = sys.stdlib_module_names | {PACKAGE.name, "numba", "llvmlite", "numpy"}
# Time (s) after which code that nobody used is removed: tens of MB a version, compiled again in a minute.
KEPT = 30 * 86400.0

_registered: dict[str, ModuleType] = {}


def register(module: ModuleType) -> None:
    """Let compiled code depend on a module from outside the package, and on the modules that it imports."""
    if module.__name__.split(".")[0] not in KNOWN:
        _registered[module.__name__] = module


def folder() -> Path | None:
    """Folder for code of the present sources, which exists; None where none can be written to."""
    return _usable(_home(), _digest())


def unwritable() -> Path | None:
    """The user's cache folder if it cannot be written to, else None."""
    return None if folder() == _home() / _digest() else _home()


def _home() -> Path:
    if given := os.environ.get(VARIABLE):
        return Path(given).absolute()
    return Path(os.environ.get("XDG_CACHE_HOME") or "~/.cache").expanduser().absolute() / PACKAGE.name


@cache
def _usable(home: Path, digest: str) -> Path | None:
    # Every process of the user finds the same second choice.
    user = os.getuid() if hasattr(os, "getuid") else 0
    spare = Path(gettempdir()) / f"{PACKAGE.name}-{user}"
    for parent in (home, spare):
        try:
            parent.mkdir(parents=True, exist_ok=True, mode=0o700)
            if parent == spare and spare.stat().st_uid != user:
                continue  # code from there would be run
            (parent / digest).mkdir(exist_ok=True)
            with TemporaryFile(dir=parent / digest):
                os.utime(parent / digest)
                _remove_unused(parent)
                return parent / digest
        except OSError:
            continue
    return None


def _remove_unused(home: Path) -> None:
    """Remove the folders of digests that no process has used for long."""
    for each in home.iterdir():
        with suppress(FileNotFoundError):  # another process has removed it
            if re.fullmatch("[0-9a-f]{16}", each.name) and each.stat().st_mtime < time.time() - KEPT:
                rmtree(each, ignore_errors=True)


def _digest() -> str:
    digest = sha256(_PACKAGE_DIGEST + bytes([PLAIN]))
    for name, source in outside_sources():
        digest.update(name.encode() + b"\0" + source)
    return digest.hexdigest()[:16]


def _digest_of_package() -> bytes:
    digest = sha256(str(PACKAGE).encode())  # numba's files are valid for sources in one place only
    for path in sorted(PACKAGE.rglob("*.py")):
        source = path.read_bytes()
        if COMPILES in source:
            digest.update(path.relative_to(PACKAGE).as_posix().encode() + b"\0" + source)
    return digest.digest()


# Of the sources at import: what is edited while a process runs is not what it compiles.
_PACKAGE_DIGEST = _digest_of_package()


def outside_sources() -> list[tuple[str, bytes]]:
    """Names and sources of registered modules and of those that they import, directly or not."""
    found: dict[str, bytes] = {}
    waiting = [*_registered.values()]
    while waiting:
        module = waiting.pop()
        if module.__name__ not in found:
            found[module.__name__] = _source(module)
            waiting += [sys.modules[name] for name in _imported(module) if name in sys.modules]
    return sorted(found.items())


@cache
def _source(module: ModuleType) -> bytes:
    """Source of a module when it was first asked for; later edits do not reach a running process."""
    file = getattr(module, "__file__", None)
    return Path(file).read_bytes() if file else b""


@cache
def _imported(module: ModuleType) -> tuple[str, ...]:
    """Full names of what a module may import: modules, and names in them."""
    if not str(getattr(module, "__file__", "")).endswith(".py"):
        return ()
    names = _names(ast.parse(_source(module)), module.__package__ or "")
    return tuple(name for name in names if name.split(".")[0] not in KNOWN)


def _names(tree: ast.Module, package: str) -> Iterator[str]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            origin = resolve_name("." * node.level + (node.module or ""), package)
            yield origin
            yield from (f"{origin}.{alias.name}" for alias in node.names)


class KernelCache:
    """numba's cache of one function, in the folder of the sources as they are when code is wanted.

    It touches no file before that.
    """

    def __init__(self, function: Callable) -> None:
        self._function = function

    def load_overload(self, signature: Any, target: Any) -> Any:
        """Code for a signature, or None."""
        place = folder()
        return _files(place)(self._function).load_overload(signature, target) if place else None

    def save_overload(self, signature: Any, code: Any) -> None:
        """Keep the code for a signature."""
        if place := folder():
            _files(place)(self._function).save_overload(signature, code)


@cache
def _files(place: Path) -> Callable:
    """Make numba's cache of a function, in a folder."""

    class Locator(_CacheLocator):
        def __init__(self, function: Callable, file: str) -> None:
            self._py_file = file  # numba names it where it cannot keep a function
            self._line = function.__code__.co_firstlineno

        @classmethod
        def from_function(cls, py_func: Callable, py_file: str) -> "Locator":
            return cls(py_func, py_file)

        def get_cache_path(self) -> str:
            return str(place / sha256(self._py_file.encode()).hexdigest()[:16])

        def get_source_stamp(self) -> str:
            return ""  # the folder's name tells the sources

        def get_disambiguator(self) -> str:
            return str(self._line)

    class Format(CompileResultCacheImpl):
        _locator_classes = [Locator]  # noqa: RUF012

    return type("Files", (FunctionCache,), {"_impl_class": Format})
