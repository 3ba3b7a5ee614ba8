"""Figures of a dataset whose sweep draws samples, one per file, as in ``wedgesweep.figures``."""

from pathlib import Path

from wedgesweep.figures import catalogue

FIGURES = catalogue.declared(Path(__file__).parent, __name__)
DESCRIPTIONS = {name: kind.description for name, kind in FIGURES.items()}
