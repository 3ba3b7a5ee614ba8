"""Figures of a dataset whose input does not repeat, one per file, as in ``wedgesweep.figures``."""

from wedgesweep.figures import catalogue

FIGURES = catalogue.declared(__path__[0], __name__)
