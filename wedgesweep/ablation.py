"""Diagnoses without some of their stages, to see what these are worth."""

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

left_out: ContextVar[frozenset[str]] = ContextVar("left_out", default=frozenset())


@contextmanager
def without(*stages: str) -> Iterator[None]:
    """Leave stages out of the diagnoses that begin here; "stages" in diagnosis.json lists their names."""
    token = left_out.set(frozenset(stages))
    try:
        yield
    finally:
        left_out.reset(token)
