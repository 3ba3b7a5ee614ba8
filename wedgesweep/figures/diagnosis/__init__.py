"""Figures of a diagnosis, one per file, as in ``wedgesweep.figures``; they draw a ``DiagnosisResult``.

A figure for which the tests lack something raises ValueError and says what.
"""

from pathlib import Path

from wedgesweep.figures import catalogue

FIGURES = catalogue.declared(Path(__file__).parent, __name__)
DESCRIPTIONS = {name: kind.description for name, kind in FIGURES.items()}
