"""Finished cases on disk while a sweep runs: an append-only file that survives a kill.

The first line is a fingerprint of what is computed. Then come records of fixed size, each followed by
its checksum, so that a record torn by a kill is recognised and dropped.
"""

import json
import os
from pathlib import Path
from types import TracebackType
from zlib import crc32

import numpy as np


class JournalMismatchError(Exception):
    """The journal on disk belongs to another config, version or machine set-up."""


class Journal:
    """Open journal of one sweep; ``records`` holds what earlier runs finished."""

    def __init__(self, path: Path, dtype: np.dtype, fingerprint: dict[str, str]) -> None:
        self.path, self.dtype = path, dtype
        header = json.dumps(fingerprint, sort_keys=True).encode() + b"\n"
        content = path.read_bytes() if path.exists() else b""
        if content.endswith(b"\n") or b"\n" in content:
            _require_same(path, content, fingerprint)
            whole, self.records = _whole_records(content, len(header), dtype)
        else:
            whole, self.records = 0, np.zeros(0, dtype)
        self._file = os.open(path, os.O_WRONLY | os.O_CREAT, 0o644)
        os.ftruncate(self._file, whole)
        os.lseek(self._file, 0, os.SEEK_END)
        if not whole:
            self._write(header)

    def append(self, records: np.ndarray) -> None:
        """Add finished cases, a structured array of the journal's dtype."""
        payloads = [record.tobytes() for record in records]
        self._write(b"".join(payload + _checksum(payload) for payload in payloads))

    def _write(self, content: bytes) -> None:
        while content:
            content = content[os.write(self._file, content) :]

    def close(self) -> None:
        os.close(self._file)

    def __enter__(self) -> "Journal":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()


def read(path: Path, dtype: np.dtype) -> np.ndarray:
    """Whole records of a journal that may be in use."""
    content = path.read_bytes()
    return _whole_records(content, content.index(b"\n") + 1, dtype)[1]


def fingerprint(path: Path) -> dict[str, str]:
    """First line of a journal."""
    with path.open("rb") as file:
        return dict(json.loads(file.readline()))


def _require_same(path: Path, content: bytes, expected: dict[str, str]) -> None:
    found = json.loads(content[: content.index(b"\n")])
    differing = [key for key in expected if found.get(key) != expected[key]]
    if differing:
        details = "; ".join(f"{key}: {found.get(key)} there, {expected[key]} now" for key in differing)
        message = f"{path}: unfinished sweep of another set-up ({details})"
        raise JournalMismatchError(message)


def _checksum(payload: bytes) -> bytes:
    return crc32(payload).to_bytes(4, "little")


def _whole_records(content: bytes, start: int, dtype: np.dtype) -> tuple[int, np.ndarray]:
    """Length of the journal up to its first torn record, and the records before that."""
    size = dtype.itemsize
    stride = size + 4
    payloads = []
    for place in range(start, len(content) - stride + 1, stride):
        payload = content[place : place + size]
        if content[place + size : place + stride] != _checksum(payload):
            break
        payloads.append(payload)
    return start + stride * len(payloads), np.frombuffer(b"".join(payloads), dtype)
