"""Figures of a diagnosis, one per file, as in ``wedgesweep.figures``; they draw a ``DiagnosisResult``.

``TESTS`` names the kind of tests that a figure draws, if it does not draw all. A figure for which they lack
something raises ValueError and says what. The docstring of ``draw`` ends with "To see: ...", which is the
caption in a report unless that has a better one.
"""

from wedgesweep.figures import catalogue

FIGURES = catalogue.declared(__path__[0], __name__)
