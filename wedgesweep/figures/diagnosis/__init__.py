"""Pictures of a diagnosis: one figure per file, drawn from what ``wedgesweep diagnose`` left behind.

As in ``wedgesweep.figures``, but ``draw(found, **options)`` takes a ``Diagnosed``. A figure that the
tests cannot fill raises ValueError and says why.
"""

from pathlib import Path

from wedgesweep.figures import catalogue

_DECLARED = catalogue.declared(Path(__file__).parent)
DESCRIPTIONS = {kind: description for kind, (_, description) in _DECLARED.items()}


def __getattr__(name: str):
    """``FIGURES`` (kind -> module) loads matplotlib, so it is made when first asked for."""
    if name != "FIGURES":
        message = f"module {__name__!r} has no attribute {name!r}"
        raise AttributeError(message)
    return catalogue.load(__name__, _DECLARED)
