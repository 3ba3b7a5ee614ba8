"""The journal: finished cases of a running sweep, in an append-only file that survives a kill.

The first line holds the fingerprint and the config. Records of fixed size follow, each with its checksum, so
that a record that was cut off by a kill is recognised and dropped.
"""

import errno
import json
import os
from pathlib import Path
from types import TracebackType
from zlib import crc32

import numpy as np

from wedgesweep.errors import MismatchError, SweepError
from wedgesweep.files import json_object, naming, read_bytes, regular, written
from wedgesweep.sweep.fingerprint import differences

try:
    import fcntl
except ImportError:  # Windows: two runs at once are not detected
    fcntl = None  # type: ignore[assignment]


# Keys that every header holds; each journal begins with the first one.
_REQUIRED = {"config", "config_sha256"}
_BEGINNING = b'{"config": "'


# Errors of file systems that have no locks.
NO_LOCKS = (errno.ENOTSUP, errno.EOPNOTSUPP, errno.ENOSYS, errno.ENOLCK, errno.EINVAL)


class Journal:
    """Open journal of one sweep; ``records`` holds the cases that earlier runs finished.

    ``header`` holds the fingerprint and whatever else a reader of the journal needs. Raises MismatchError if
    the journal belongs to another sweep, SweepError if another run has it open or it is not a journal.
    """

    def __init__(self, path: Path, dtype: np.dtype, header: dict[str, str]) -> None:
        self._path, self._file = path, _locked(path)
        try:
            whole, self.records = _kept(path, dtype, header)
            os.ftruncate(self._file, whole)
            os.lseek(self._file, 0, os.SEEK_END)
            if not whole:
                self._write(json.dumps(header, sort_keys=True).encode() + b"\n")
        except BaseException:
            self.close()
            raise

    def append(self, records: np.ndarray) -> None:
        """Append finished cases, a structured array of the journal's dtype."""
        framed = np.empty(len(records), _framed(records.dtype))
        framed["record"] = records
        framed["checksum"] = _checksums(framed)
        self._write(framed.tobytes())

    def _write(self, content: bytes) -> None:
        with naming(self._path):
            while content:
                content = content[os.write(self._file, content) :]

    def close(self) -> None:
        os.close(self._file)

    def __enter__(self) -> "Journal":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def discard(path: Path) -> None:
    """Delete a journal, if there is one and no run has it open; raises SweepError for any other file."""
    if not path.exists():
        return
    file = _locked(path)
    try:
        _require_journal(path, path.read_bytes())
        path.unlink()
    finally:
        os.close(file)


def rewrite(path: Path, records: np.ndarray, header: dict[str, str]) -> None:
    """Put a journal of these records in the place of another one that no run has open, or of none."""
    file = _locked(path) if path.exists() else None
    try:
        with written(path) as temporary, Journal(temporary, records.dtype, header) as made:
            made.append(records)
    finally:
        if file is not None:
            os.close(file)


def header(path: Path) -> dict[str, str]:
    """Read the header of a journal, which may be in use."""
    return _header(path, _content(path))


def read(path: Path, dtype: np.dtype) -> np.ndarray:
    """Read the complete records of a journal, which may be in use; of each case the last one."""
    content = _content(path)
    return _latest(_whole_records(content, content.index(b"\n") + 1, dtype)[1])


def _locked(path: Path) -> int:
    """Open a file and lock it, until it is closed or the process ends.

    On NFS the lock holds between hosts. A file system without locks does not tell two runs apart.
    """
    if path.exists():
        regular(path)
    file = os.open(path, os.O_RDWR | os.O_CREAT, 0o644)
    try:
        if fcntl:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError as error:
        os.close(file)
        raise SweepError(f"{path}: another run is writing it; wait until it ends, or stop it") from error
    except OSError as error:
        if error.errno not in NO_LOCKS:
            raise
    # The run that had the lock until now may have finished, and deleted the file.
    if not (path.exists() and os.path.samestat(os.fstat(file), path.stat())):
        os.close(file)
        return _locked(path)
    return file


def _kept(path: Path, dtype: np.dtype, expected: dict[str, str]) -> tuple[int, np.ndarray]:
    """Length (bytes) of the intact part of the file, 0 if even the header is cut off, and its records."""
    content = path.read_bytes()
    _require_journal(path, content)
    if b"\n" not in content:
        return 0, np.zeros(0, dtype)
    differing = differences(_header(path, content), expected)
    if differing:
        raise MismatchError(
            f"{path}: an unfinished sweep with another config or version ({'; '.join(differing)})"
        )
    whole, records = _whole_records(content, content.index(b"\n") + 1, dtype)
    return whole, _latest(records)


def _header(path: Path, content: bytes) -> dict[str, str]:
    try:
        found = json_object(content[: content.index(b"\n")])
    except ValueError as error:
        raise _no_journal(path) from error
    if not found.keys() >= _REQUIRED or not all(isinstance(each, str) for each in found.values()):
        raise _no_journal(path)
    return found


def _require_journal(path: Path, content: bytes) -> None:
    """Raise SweepError unless the content is that of a journal, or of its torn first line."""
    if b"\n" in content:
        _header(path, content)
    elif not _BEGINNING.startswith(content[: len(_BEGINNING)]):
        raise _no_journal(path)


def _no_journal(path: Path) -> SweepError:
    return SweepError(f"{path}: not the journal of a sweep, or damaged in its first line; it is left alone")


def _content(path: Path) -> bytes:
    try:
        return read_bytes(path)
    except OSError as error:
        raise SweepError(f"{path}: {error.strerror}") from error


def _latest(records: np.ndarray) -> np.ndarray:
    """Drop superseded records of cases that were run again."""
    _, last = np.unique(records["index"][::-1], return_index=True)
    return records[np.sort(len(records) - 1 - last)]


def _framed(dtype: np.dtype) -> np.dtype:
    return np.dtype([("record", dtype), ("checksum", "<u4")])


def _checksums(framed: np.ndarray) -> list[int]:
    """Checksum of each record."""
    content = framed.view(np.uint8).data
    size, stride = framed.dtype["record"].itemsize, framed.itemsize
    return [crc32(content[place : place + size]) for place in range(0, len(content), stride)]


def _whole_records(content: bytes, start: int, dtype: np.dtype) -> tuple[int, np.ndarray]:
    """Length (bytes) of the journal up to its first damaged record, and the records before that."""
    framed = np.frombuffer(content, _framed(dtype), (len(content) - start) // _framed(dtype).itemsize, start)
    torn = np.flatnonzero(framed["checksum"] != _checksums(framed))
    whole = framed[: torn[0]] if torn.size else framed
    return start + whole.nbytes, whole["record"]
