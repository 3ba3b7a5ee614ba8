"""What axes and titles call the motion and the input of a dataset: those of its system."""

from dataclasses import dataclass

import xarray as xr

from wedgesweep.figures import style

SUSPENSION = "side frame minus bolster"


@dataclass(frozen=True)
class Labels:
    """Words and units of a dataset.

    ``motion`` and ``rate`` are the symbols of what was recorded, and ``whose`` says in words what it is;
    ``symbol`` is that of the input amplitude, ``factor`` turns it into ``unit``. ``scale`` and ``reference``
    are symbol and words of what motions are compared with.
    """

    motion: str
    rate: str
    whose: str
    symbol: str
    scale: str
    unit: str
    factor: float
    ratio: str
    reference: str
    sign: str
    kind: str = "relative "

    @property
    def input(self) -> str:
        """Symbol of the input."""
        return "F" if self.unit == "N" else "u"

    @property
    def name(self) -> str:
        """Name of the motion, at the beginning of a title."""
        return f"{self.kind}displacement".capitalize()

    @property
    def own_reference(self) -> str:
        """What each motion is compared with."""
        return self.reference if self.unit == "N" else "its input amplitude"

    @property
    def displacement(self) -> str:
        """Label of a displacement."""
        return f"{self.kind}displacement ${self.motion}$ [mm]"

    @property
    def velocity(self) -> str:
        """Label of a velocity."""
        return f"{self.kind}velocity ${self.rate}$ [mm/s]"

    @property
    def amplitude(self) -> str:
        """Label of the input amplitude."""
        what = "input amplitude" if self.unit == "mm" else "amplitude of the force"
        return f"{what} ${self.symbol}$ [{self.unit}]"

    def size(self, amplitude: float, digits: int) -> str:
        """Write an input amplitude (m or N) with its unit."""
        return f"${self.symbol}$ = {amplitude * self.factor:.{digits}g} {self.unit}"


def of(ds: xr.Dataset) -> Labels:
    """Return the labels of a dataset."""
    if ds.attrs.get("system") != "oscillator":
        return Labels(
            "x-y",
            "x'-y'",
            SUSPENSION,
            "a",
            "a",
            "mm",
            style.MM,
            "amplitude ratio $|x-y|/a$ [1]",
            "the input amplitude",
            style.SIGN,
        )
    forced, contact = ds.attrs["excitation"] == "force", ds.attrs["contact"]
    relative = contact == "base" and not forced
    motion, rate = ("x-u", "x'-u'") if relative else ("x", "x'")
    words = {"base": "the base", "ground": "the ground", "belt": "a belt"}[contact]
    reference = ds.attrs["reference"]
    return Labels(
        motion,
        rate,
        "mass minus base" if relative else "of the mass",
        "P" if forced else "a",
        ("P/k" if reference.endswith("k") else r"P/(m \omega^2)") if forced else "a",
        "N" if forced else "mm",
        1.0 if forced else style.MM,
        f"amplitude ratio $|{motion}|$ over {reference} [1]",
        reference,
        f"${motion}$: displacement of the mass{' against the base' * relative}, which rubs on {words}",
        "relative " if relative else "",
    )
