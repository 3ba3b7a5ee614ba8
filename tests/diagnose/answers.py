"""Diagnoses of files, and what their answer must be."""

import pytest

from wedgesweep import api
from wedgesweep.effects import EFFECTS
from wedgesweep.measured import read


def diagnosed(path, effects=None):
    return api.diagnose_measurement(read(path), effects=effects, n_jobs=1)


def is_told(found, hidden, rel):
    """Assert that the hidden effect, SI numbers by its name, is the only cause, with these numbers.

    Angles are left out: where x = 0 is, nobody knows.
    """
    ((effect, numbers),) = hidden.items()
    (cause,) = found.causes
    assert cause["effect"] == effect
    for quantity in EFFECTS[effect].quantities:
        if quantity.name in numbers and not quantity.angle:
            value = cause["parameters"][quantity.key]["value"] * quantity.factor
            assert value == pytest.approx(numbers[quantity.name], rel=rel), quantity.key
