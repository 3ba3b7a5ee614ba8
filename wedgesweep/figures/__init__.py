"""Pictures of a dataset: one figure per file, drawn from the dataset alone.

A file that defines ``NAME``, ``DESCRIPTION`` and ``draw(ds, **options) -> Figure`` is a figure;
nothing else has to know of it. Options are in SI units, as the dataset is; mm exist on axes only.
"""

import io
import os
from pathlib import Path

from wedgesweep.figures import catalogue

FORMATS = (".png", ".pdf", ".svg")
DOTS_PER_INCH = 200

_DECLARED = catalogue.declared(Path(__file__).parent)
DESCRIPTIONS = {kind: description for kind, (_, description) in _DECLARED.items()}


def __getattr__(name: str):
    """``FIGURES`` (kind -> module) loads matplotlib, so it is made when first asked for."""
    if name != "FIGURES":
        message = f"module {__name__!r} has no attribute {name!r}"
        raise AttributeError(message)
    return catalogue.load(__name__, _DECLARED)


def save(figure, path: str | Path) -> None:
    """Write a figure as PNG, PDF or SVG, by the suffix; an interrupted write leaves no broken file.

    Raises
    ------
    ValueError
        The suffix is none of ``FORMATS``.
    """
    path = Path(path)
    if path.suffix.lower() not in FORMATS:
        valid = ", ".join(FORMATS)
        message = f"{path}: cannot write '{path.suffix}'; the suffix must be one of {valid}"
        raise ValueError(message)
    partial = path.with_name(f".{path.name}.{os.getpid()}.partial")
    try:
        figure.savefig(partial, format=path.suffix.lower()[1:], dpi=DOTS_PER_INCH)
        partial.replace(path)
    finally:
        partial.unlink(missing_ok=True)


def svg(figure) -> bytes:
    """Draw a figure as an SVG that needs no font and is the same each time."""
    from matplotlib import rc_context

    stream = io.BytesIO()
    with rc_context({"svg.hashsalt": "wedgesweep", "svg.fonttype": "path"}):
        figure.savefig(stream, format="svg", metadata={"Date": None})
    return stream.getvalue()
