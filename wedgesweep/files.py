"""Files that a user names: only regular ones are read, and one that is written is complete or not there."""

import errno
import json
import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from glob import escape
from pathlib import Path
from shutil import rmtree
from typing import Any

# Endings of the names of files, by their format. The first of a format is its own.
NETCDF, CSV, TOML, JSON = "netCDF", "CSV", "TOML", "JSON"
ENDINGS = {
    NETCDF: (".nc", ".nc4", ".cdf", ".h5", ".hdf5"),
    CSV: (".csv", ".tsv", ".txt", ".dat"),
    TOML: (".toml", ".txt"),
    JSON: (".json", ".txt"),
    "a figure": (".png", ".pdf", ".svg", ".jpg", ".jpeg"),
    "a page": (".html", ".htm", ".md"),
    "MATLAB": (".mat",),
    "Parquet": (".parquet",),
    "a workbook": (".xlsx", ".xls", ".ods"),
}


def regular(path: Path) -> Path:
    """Return the path of a regular file; raises OSError for anything else.

    Reading a pipe or a device may never end.
    """
    if "\0" in str(path):
        raise OSError(errno.EINVAL, "a path cannot hold a null character", str(path).replace("\0", "\\0"))
    mode = path.stat().st_mode
    if stat.S_ISDIR(mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    if not stat.S_ISREG(mode):
        raise OSError(errno.EINVAL, "not a regular file, but a pipe, socket or device", str(path))
    return path


def missing(path: Path) -> str:
    """Why nothing is found at a path; empty if something is there."""
    try:
        path.stat()
    except OSError as error:
        return error.strerror or str(error)
    return ""


def replaceable(path: Path) -> None:
    """Raise OSError if a file cannot take this place.

    No file may take that of a device or pipe: /dev/null would be a plain file for every program from then on.
    """
    if path.exists() and not path.is_dir():
        regular(path)


def read_bytes(path: Path) -> bytes:
    """Read a regular file."""
    return regular(path).read_bytes()


def read_text(path: Path) -> str:
    """Read a regular file of UTF-8 text."""
    return read_bytes(path).decode("utf-8-sig")


def json_object(text: str | bytes) -> dict[str, Any]:
    """Read a JSON object; raises ValueError for everything else."""
    try:
        found = json.loads(text)
    except RecursionError as error:
        raise ValueError("nested too deeply") from error
    if not isinstance(found, dict):
        raise ValueError("not a JSON object")
    return found


@contextmanager
def written(path: Path) -> Iterator[Path]:
    """A temporary file beside ``path`` to write, which takes its place when it is complete.

    What a killed process left behind is removed. Errors name ``path``; they are OSError.
    """
    if not path.name:
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    replaceable(path)
    _sweep(path)
    temporary = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        with naming(path):
            yield temporary
            os.replace(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)


@contextmanager
def beside(path: Path) -> Iterator[Path]:
    """A temporary directory beside ``path`` for what shall get there when it is complete; it is removed."""
    _sweep(path)
    temporary = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        with naming(path):
            temporary.mkdir()
            yield temporary
    finally:
        rmtree(temporary, ignore_errors=True)


def write_text(path: Path, text: str) -> None:
    """Write UTF-8 text, all of it or nothing."""
    with written(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


@contextmanager
def naming(path: Path) -> Iterator[None]:
    """Name the file in errors of the operating system; a full disk does not say which it was."""
    try:
        yield
    except OSError as error:
        if error.errno is not None:
            error.filename, error.filename2 = str(path), None
        raise


def _sweep(path: Path) -> None:
    """Remove temporary files and directories of ``path`` whose processes have ended."""
    for orphan in path.parent.glob(f".{escape(path.name)}.*"):
        process = orphan.name.rpartition(".")[2]
        if process.isascii() and process.isdigit() and not _runs(int(process)):
            with suppress(OSError):
                rmtree(orphan) if orphan.is_dir() else orphan.unlink()


def _runs(process: int) -> bool:
    try:
        os.kill(process, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except PermissionError:
        return True
    return True


def mismatch(path: Path, written: str) -> str | None:
    """A message if a file that a format is written to has the ending of another; any other name will do."""
    ending, own = path.suffix.lower(), ENDINGS[written]
    meant = next((name for name, endings in ENDINGS.items() if ending in endings), None)
    if meant is None or ending in own:
        return None
    return f"{path}: {written} is written, and {ending} is the ending of {meant}; end it in {own[0]}"
