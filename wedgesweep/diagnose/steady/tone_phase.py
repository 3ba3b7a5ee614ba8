"""The phase of a spurious tone relative to the input of each record.

A tone runs through all phases of the input, but in a record of few periods only through some of them, and
friction responds to both at once. Where the tone shows in the record, so does its phase. But near half the
input's frequency the lag of the response depends on that phase, and a tone that the record cannot resolve
from a harmonic shows in the other harmonics only. So the phase is fitted.
"""

from dataclasses import replace

import numpy as np

from wedgesweep.diagnose.evaluation import Point

# Phases that are tried.
PHASES = 12


def points(point: Point, tone_tests: np.ndarray) -> list[Point]:
    """The point with every phase tried in all tests (T,) that have a tone; NaN in the others."""
    fitted = np.where(tone_tests, 0.0, np.nan)
    phases = 2.0 * np.pi / PHASES * np.arange(PHASES)
    return [
        replace(point, nuisance=np.column_stack([point.nuisance[:, 0], fitted + phase])) for phase in phases
    ]
