"""What axes and titles call the motion and the input of a dataset: those of its system."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import xarray as xr

from wedgesweep.figures import style
from wedgesweep.friction import LAWS

SUSPENSION = "side frame minus bolster"
OSCILLATOR = "oscillator"
# What motions are compared with, by the attribute ``reference`` of a dataset: symbol, and words.
REFERENCES = {
    "the amplitude of u": ("a", "the input amplitude"),
    "force amplitude over k": ("P/k", "the deflection $P/k$ under the force at rest"),
    "force amplitude over m omega^2": (r"P/(mω^2)", "the motion $P/(mω^2)$ of the free mass"),
    "belt velocity over omega_n": (r"v_{belt}/ω_n", "the belt velocity over $ω_n$"),
    "": ("", "the input at scale 1"),  # of one that does not repeat
    "belt velocity over omega": (r"v_{belt}/ω", "the belt velocity over $ω$"),
}


@dataclass(frozen=True)
class Labels:
    """Words and symbols of a dataset.

    ``motion`` and ``rate`` are the symbols of what was recorded, ``whose`` says in words what it is, and
    ``sign`` how to read it. ``scale`` and ``reference`` are symbol and words of what motions are compared
    with. ``forced``: a force is the input, whose amplitude has the ``unit``; ``factor`` turns the dataset's
    number into it.
    """

    motion: str
    rate: str
    whose: str
    sign: str
    scale: str
    reference: str
    kind: str = "relative "
    forced: bool = False
    body: str = "bolster"
    base: str = "side frame"
    positive: str = "positive upwards"
    unit: str = "mm"
    factor: float = style.MM

    @property
    def symbol(self) -> str:
        """Symbol of the input amplitude."""
        return "P" if self.forced else "a"

    @property
    def input(self) -> str:
        """Symbol of the input."""
        return "F" if self.forced else "u"

    @property
    def name(self) -> str:
        """Name of the motion, at the beginning of a title."""
        return f"{self.kind}displacement".capitalize()

    @property
    def own_reference(self) -> str:
        """What each motion is compared with."""
        return self.reference if self.forced else "its input amplitude"

    @property
    def displacement(self) -> str:
        """Label of a displacement."""
        return f"{self.kind}displacement ${self.motion}$ [mm]"

    @property
    def velocity(self) -> str:
        """Label of a velocity."""
        return f"{self.kind}velocity ${self.rate}$ [mm/s]"

    @property
    def ratio(self) -> str:
        """Label of an amplitude ratio."""
        scale = f"({self.scale})" if "/" in self.scale else self.scale
        return f"amplitude ratio $|{self.motion}|/{scale}$ [1]"

    @property
    def amplitude(self) -> str:
        """Label of the input amplitude."""
        return f"{'force' if self.forced else 'input'} amplitude ${self.symbol}$ [{self.unit}]"

    @property
    def driver(self) -> str:
        """What puts energy in."""
        return "the force" if self.forced else f"the {self.base}"

    def size(self, amplitude: float, digits: int) -> str:
        """Write an input amplitude of the dataset with its unit."""
        return f"${self.symbol}$ = {amplitude * self.factor:.{digits}g} {self.unit}"


WEDGE = Labels("x-y", "x'-y'", SUSPENSION, style.SIGN, "a", "the input amplitude")


def of(ds: xr.Dataset) -> Labels:
    """Return the labels of the dataset of a sweep or a diagnosis."""
    return _of_oscillator(ds.attrs) if ds.attrs.get("system") == OSCILLATOR else WEDGE


def _of_oscillator(attributes: Mapping[str, Any]) -> Labels:
    forced, contact = attributes["excitation"] == "force", attributes["contact"]
    relative = contact == "base" and not forced
    motion, rate = ("x-u", "x'-u'") if relative else ("x", "x'")
    rubs = {"base": "its base", "ground": "the ground", "belt": "a belt"}[contact]
    against = " against its base" if relative else ""
    scale, reference = REFERENCES[attributes["reference"]]
    return Labels(
        motion,
        rate,
        "mass minus base" if relative else "of the mass",
        f"${motion}$: displacement of the mass{against}; it rubs on {rubs}",
        scale,
        reference,
        "relative " if relative else "",
        forced,
        "mass",
        "base",
        f"positive along ${motion}$",
        *(("N", 1.0) if forced else ("mm", style.MM)),
    )


def sticking(laws: Iterable[str]) -> str:
    """What counts as stuck, in words: set-valued laws hold a face, the others let it creep."""
    held = {law for law in laws if law in LAWS and LAWS[law].SET_VALUED}
    creeping = set(laws) - held
    if not creeping:
        return "stuck"
    return f"stuck ({', '.join(sorted(held))}) or slip below $v_t$" if held else "slip below $v_t$"
