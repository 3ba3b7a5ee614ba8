"""Backbones of simulated releases."""

import numpy as np
import xarray as xr

from wedgesweep.figures import backbones, cases, labels, style
from wedgesweep.figures.panels import Panels, Target

NAME = "backbone"
DESCRIPTION = "frequency and damping ratio of a release over amplitude, a line per law"
NEEDS = ("displacement", "time", "scale", "input")


def draw(target: Target, ds: xr.Dataset, scale: float | None = None) -> Panels:
    """Draw a line per law at a scale, by default the largest."""
    if np.any(ds["input"].values):
        raise ValueError("an input drives the motion; a backbone is that of a release")
    chosen = cases.one_scale(ds, scale)
    motions = [
        backbones.Motion(
            law,
            style.law_style(law)["color"],
            chosen["time"].values,
            chosen["displacement"].sel(friction_law=law).values * style.MM,
        )
        for law in cases.laws(chosen)
    ]
    made = backbones.draw(target, motions, f"amplitude of {labels.of(ds).displacement}")
    made.title(f"Backbones at scale {chosen['scale'].item():.3g}", backbones.READING)
    return made
