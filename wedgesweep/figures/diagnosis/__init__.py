"""Figures of a diagnosis, one per file, as in ``wedgesweep.figures``; they draw a ``DiagnosisResult``.

A figure for which the tests lack something raises ValueError and says what. The docstring of ``draw`` ends
with "To see: ...", which is the caption in a report unless that has a better one.
"""

from wedgesweep.figures import catalogue

FIGURES = catalogue.declared(__path__[0], __name__)
DESCRIPTIONS = {name: kind.description for name, kind in FIGURES.items()}
