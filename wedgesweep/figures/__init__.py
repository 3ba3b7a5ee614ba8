"""Figures of a sweep's dataset and of a diagnosis, one figure per file.

A file here (in ``transient/`` where the input does not repeat, in ``samples/`` of samples, in
``diagnosis/``, in ``measured/``) that defines ``NAME``, ``DESCRIPTION`` and ``draw(target, data, **picks)``
is a figure; no list names it. ``NEEDS`` names the variables and attributes that it needs of a dataset. The
keywords of ``draw`` are the figure's options, in SI units as the dataset is; mm exist on axes only.
"""

import io
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from wedgesweep import rotation
from wedgesweep.figures import catalogue, diagnosis, measured, samples, transient
from wedgesweep.files import written
from wedgesweep.units import SI

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, SubFigure

    from wedgesweep.diagnosis_result import DiagnosisResult
    from wedgesweep.measured import Measurement

    Data: TypeAlias = xr.Dataset | DiagnosisResult | Measurement

FORMATS = (".png", ".pdf", ".svg")
DOTS_PER_INCH = 200
# The picks that figures of all datasets share: a law, and values of axes by name; and that of all figures: a
# system of units.SYSTEMS.
LAW, AT, UNITS = "law", "at", "units"
# What a diagnosis lacks whose tests are all of other kinds.
LACKS = {
    "steady": "no test is of steady vibration",
    "transient": "the tests are no transients",
    "loop": "the tests are no loops",
}

FIGURES = catalogue.declared(__path__[0], __name__)


def draw(data: "Data", name: str, ax: "Axes | None" = None, **picks: Any) -> "Figure":
    """Draw one figure of a sweep's dataset, of a diagnosis or of measured data.

    Parameters
    ----------
    data : xarray.Dataset, DiagnosisResult or Measurement
        What ``wedgesweep run`` or ``wedgesweep diagnose`` left behind, as read from its files, or what
        ``read_measurement`` returns. A friction
        law, beta or amplitude may have been selected from a dataset, as one value or as several.
    name : str
        Name of the figure: a key of ``figures.FIGURES``, or of ``figures.diagnosis.FIGURES``.
    ax : matplotlib.axes.Axes, optional
        Axes to draw into, for a figure that has a single panel with these data, such as ``"stick-map"``
        with one friction law. By default a new figure is made, in a size that suits its panels.
    **picks
        Options of the figure, by the names that ``figures.FIGURES[name].picks`` lists: ``beta`` (frequency
        ratio), ``amplitude`` or ``amplitudes`` (m) of a dataset, ``tests`` (indices) of a diagnosis; and
        ``law`` and ``at`` (values of axes by name) of any dataset, and ``units`` (``"us"``, ``"us-kip"``).
        The nearest values that the data hold are drawn, if they are near.

    Returns
    -------
    matplotlib.figure.Figure
        The figure drawn into; ``figures.save`` writes it to a file.

    Raises
    ------
    ValueError
        There is no such figure or option, the data lack what the figure needs, or several panels were to
        be drawn into one Axes. The message says which.
    """
    import xarray as xr

    from wedgesweep.diagnosis_result import DiagnosisResult
    from wedgesweep.figures import cases, models, shown_units

    kind, system = kind_of(data, name), picks.get(UNITS, SI)
    try:
        _require_known(picks, options(kind))
        picks.pop(UNITS, None)
        checked = _of_tests(data, kind.tests) if isinstance(data, DiagnosisResult) else data
        if isinstance(data, xr.Dataset):
            data = _to_be_drawn(data, picks) if kind.any_axes else models.of_one(data, picks.pop(AT, {}))
            checked = cases.checked(data, kind.needs, kind.case_lists)
            if (law := picks.pop(LAW, None)) is not None:
                checked = cases.of_law(checked, law)
        panels = kind.load().draw(ax, checked, **picks)
        if isinstance(checked, xr.Dataset):
            named = (str(checked.attrs.get(name, "")) for name in ("title", "model"))
            panels.head("; ".join(filter(None, named)))
    except ValueError as error:
        raise ValueError(f"{name}: {error}") from error
    whole = panels.figure.figure  # of a subfigure: the figure that it is part of
    if _turns(data):
        _relabel(panels.figure)
    if system != SI:
        for part in panels.axes if panels.embedded else [panels.figure]:
            shown_units.show_in(part, system)
    return whole


def _of_tests(result: "DiagnosisResult", tests: str) -> "DiagnosisResult":
    """The part of a diagnosis with tests of a kind; raises ValueError if there are none."""
    part = result.of_kind(tests)
    if tests and part.document.get("kind", "steady") != tests:
        raise ValueError(LACKS[tests])
    return part


def _to_be_drawn(ds: "xr.Dataset", picks: dict[str, Any]) -> "xr.Dataset":
    """The dataset with the variable that is asked for."""
    if (variable := picks.get("variable", "status")) not in ds:
        from wedgesweep.engineering_quantities import OF_MODEL, with_quantities

        ds = with_quantities(ds, [variable])
        if variable in OF_MODEL:  # then no motion is to be read with care
            ds = ds.drop_vars(["lift_off_fraction", "periodicity"], errors="ignore")
    return ds


def _turns(data: "Data") -> bool:
    """Whether the data are of an oscillator that turns."""
    from wedgesweep.diagnosis_result import DiagnosisResult
    from wedgesweep.measured import Measurement

    if isinstance(data, Measurement):
        return data.model.turns
    attributes = data.data.attrs if isinstance(data, DiagnosisResult) else data.attrs
    return attributes.get("motion") == rotation.ROTATION


def _relabel(figure: "Figure | SubFigure") -> None:
    """Write all texts of a figure in the units and words of a rotation, in place."""
    from matplotlib.text import Text

    for label in figure.findobj(Text):
        if isinstance(label, Text):
            label.set_text(rotation.prose(rotation.in_units(label.get_text())))


def options(kind: catalogue.FigureKind) -> tuple[str, ...]:
    """Names of the picks of a figure: units, a law of any dataset, and its own."""
    of_dataset = not kind.module.startswith((diagnosis.__name__, measured.__name__))
    return tuple(dict.fromkeys((*kind.picks, *((LAW, AT) if of_dataset else ()), UNITS)))


def _require_known(picks: Mapping[str, Any], known: Sequence[str]) -> None:
    for name in picks:
        if name not in known:
            raise ValueError(f"unknown option '{name}'; it takes {', '.join(known) or 'no options'}")


def of(data: "Data") -> dict[str, catalogue.FigureKind]:
    """Return the figures that draw such data, by name."""
    from wedgesweep.diagnosis_result import DiagnosisResult
    from wedgesweep.measured import Measurement

    if isinstance(data, DiagnosisResult):
        return diagnosis.FIGURES
    if isinstance(data, Measurement):
        return measured.FIGURES
    if "sample" in data.dims:
        return samples.FIGURES
    if "scale" in data.coords:
        return transient.FIGURES | {name: kind for name, kind in FIGURES.items() if kind.any_axes}
    return FIGURES


def kind_of(data: "Data", name: str) -> catalogue.FigureKind:
    """Return the figure of a name; raises ValueError if it does not draw such data."""
    kinds = of(data)
    if name not in kinds:
        raise ValueError(f"no figure '{name}' of these data; there are {', '.join(kinds)}")
    return kinds[name]


def save(figure: "Figure", path: str | Path) -> None:
    """Write a figure as PNG, PDF or SVG, by the suffix; an interrupted write leaves no broken file.

    Raises
    ------
    ValueError
        The suffix is none of ``FORMATS``.
    """
    path = Path(path)
    if path.suffix.lower() not in FORMATS:
        valid = ", ".join(FORMATS)
        raise ValueError(f"{path}: cannot write '{path.suffix}'; the suffix must be one of {valid}")
    with written(path) as temporary:
        figure.savefig(temporary, format=path.suffix.lower()[1:], dpi=DOTS_PER_INCH)


def svg(figure: "Figure") -> bytes:
    """Return a figure as an SVG that needs no font and is the same each time."""
    from matplotlib import rc_context

    stream = io.BytesIO()
    with rc_context({"svg.hashsalt": "wedgesweep", "svg.fonttype": "path"}):
        figure.savefig(stream, format="svg", metadata={"Date": None})
    return stream.getvalue()
