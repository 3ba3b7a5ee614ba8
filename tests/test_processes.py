"""Work in a process apart that may die or find no end."""

import os
from functools import partial

import pytest

from wedgesweep import processes


def endless():
    while True:
        pass


@pytest.mark.skipif(not hasattr(os, "fork"), reason="processes cannot fork here")
@pytest.mark.parametrize("work", [endless, partial(os._exit, 1)], ids=["endless", "dies"])
def test_a_library_that_dies_or_finds_no_end_is_an_error(monkeypatch, work):
    monkeypatch.setattr(processes, "MOST_WORK", 1)
    with pytest.raises(OSError, match="gave up, or found no end"):
        processes.apart(work)


def test_what_is_found_apart_comes_back():
    assert processes.apart(divmod, 7, 2) == (3, 1)
    with pytest.raises(ZeroDivisionError):
        processes.apart(divmod, 7, 0)
