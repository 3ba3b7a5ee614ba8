"""Figures of a dataset whose sweep draws samples, one per file, as in ``wedgesweep.figures``."""

from wedgesweep.figures import catalogue

FIGURES = catalogue.declared(__path__[0], __name__)
