"""Tests run as the command does: threads of numpy's libraries stand in each other's way on a busy machine."""

import os
from pathlib import Path

from wedgesweep.__main__ import THREADS

os.environ.update(dict.fromkeys(THREADS, "1"))

# Each of the first of these compiles something else for 10 to 30 s: the two processes of ``make test`` begin
# with them, so that neither compiles what the other one does. Those that take longest follow, so that both
# processes end together.
FIRST = (
    "physics/test_unilateral.py",
    "physics/test_agreement.py",
    "diagnose/test_driven.py",
    "physics/test_transients.py",
    "physics/test_effects.py",
    "diagnose/test_loops.py",
    "physics/test_series.py",
    "sweep/test_backend.py",
    "test_hostile.py",
    "test_cli.py",
    "sweep/test_run.py",
    "physics/test_oscillator_effects.py",
    "validation/test_scale.py",
    "validation/test_real_frame.py",
    "validation/test_planted_effects.py",
    "test_synthesize_kinds.py",
)
TESTS = Path(__file__).parent


def pytest_collection_modifyitems(items):
    """Put the files of FIRST in front."""
    place = {str(TESTS / name): i for i, name in enumerate(FIRST)}
    items.sort(key=lambda item: place.get(str(item.path), len(FIRST)))
