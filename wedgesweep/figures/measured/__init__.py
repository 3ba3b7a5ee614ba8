"""Figures of measured data, one per file, as in ``wedgesweep.figures``; they draw a ``Measurement``."""

from wedgesweep.figures import catalogue

FIGURES = catalogue.declared(__path__[0], __name__)
