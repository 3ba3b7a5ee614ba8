"""The force that no named effect explains, as a person looks at forces."""

import numpy as np
from matplotlib.axes import Axes

from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.figures import labels, style
from wedgesweep.figures.diagnosis import marks
from wedgesweep.figures.panels import Panels, Target, panels

NAME = "missing-force"
DESCRIPTION = "empirical force that no name explains, over velocity, over displacement, and as a map"

REACH = 1.5  # of the force axes, in the largest forces of the map


def draw(target: Target, result: DiagnosisResult) -> Panels:
    """Draw the empirical force of a diagnosis in which it predicts better than every named explanation.

    To see: the force on the mass beyond the base model, without its mean: over velocity and over
    displacement (averages where the tests have been, with 95 % bands), and as a map, empty where nothing
    was measured. A step at zero velocity is friction, a slope over velocity a damper, one over
    displacement a spring.
    """
    data = result.data
    if "missing_force" not in data:
        raise ValueError("no empirical force was fitted that predicts better than what has a name")
    words = labels.of(data)
    made = panels(target, 3, size=(3.4, 2.9), share=False)
    over_speed, over_place, both = made.axes
    motion, rate = f"${words.motion}$ [mm]", f"${words.rate}$ [mm/s]"
    force = data["missing_force"].values
    largest = float(np.nanmax(np.abs(force)))
    for ax, over, name in ((over_speed, "speed", rate), (over_place, "place", motion)):
        names = (f"force_{over}", f"missing_force_over_{over}", f"missing_force_over_{over}_std")
        _curve(ax, *(data[each].values for each in names))
        # Where the force is hardly known its band leaves the panel.
        ax.set_ylim(-REACH * largest, REACH * largest)
        ax.set_xlabel(name, fontsize=9)
        ax.set_ylabel("missing force [N]", fontsize=9)
    shown = both.pcolormesh(
        data["force_place"].values * style.MM,
        data["force_speed"].values * style.MM,
        np.ma.masked_invalid(force).T,
        cmap="RdBu_r",
        vmin=-largest,
        vmax=largest,
        shading="nearest",
    )
    both.set_xlabel(motion, fontsize=9)
    both.set_ylabel(rate, fontsize=9)
    made.colorbar(shown, "missing force [N]", [both])
    made.title(f"Force on the {words.body} that no name explains", "bands: 95 %; empty: not measured")
    return made


def _curve(ax: Axes, along: np.ndarray, force: np.ndarray, std: np.ndarray) -> None:
    x, half = along * style.MM, marks.STDS * std
    ax.axhline(0.0, color=style.GREY, linewidth=0.8)
    ax.fill_between(x, force - half, force + half, color=style.BLUE, alpha=0.25, linewidth=0)
    ax.plot(x, force, color=style.BLUE, linewidth=1.6)
    ax.locator_params(axis="x", nbins=5)
