"""Fig. 2: the friction laws of the sweep with the coefficients of its config."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from wedgesweep.figures import cases, style
from wedgesweep.figures.panels import Panels, Target, panels
from wedgesweep.friction import LAWS
from wedgesweep.friction.curve import curve as friction_curve

NAME = "friction-laws"
DESCRIPTION = "coefficient of friction over slip velocity, a panel per law (Fig. 2)"
NEEDS = ("config",)
CASE_LISTS = True

REACH = 4.0  # the slip velocities shown, in threshold velocities
POINTS = 200


def curve(name: str, parameters: np.void, reach: float) -> tuple[np.ndarray, np.ndarray]:
    """Trace slip velocity (m/s) up to ``reach`` and signed coefficient, vertical where the law jumps."""
    law = LAWS[name]
    threshold = float(parameters["friction"]["v_t"])
    start = 0.0 if law.SET_VALUED else threshold
    pieces = {1: np.linspace(start, reach, POINTS)}
    pieces[-1] = -pieces[1][::-1]
    if not law.SET_VALUED:
        pieces[0] = np.array([-threshold, threshold])
    order = [branch for branch in (-1, 0, 1) if branch in pieces]
    coefficients = [friction_curve(pieces[branch], branch, parameters) for branch in order]
    return np.concatenate([pieces[branch] for branch in order]), np.concatenate(coefficients)


def _annotate(ax: Axes, law: str, parameters: np.void) -> None:
    """Mark the levels of the coefficients that a law has, and say how it behaves at rest."""
    used = " ".join(getattr(LAWS[law], "EQUATIONS", ("mu_s, mu_d",)))
    for name, side in (("s", "bottom"), ("d", "top")):
        if f"mu_{name}" not in used:
            continue
        level = float(parameters["friction"][f"mu_{name}"])
        ax.axhline(level, color="0.75", linewidth=0.8, linestyle=(0, (2, 2)), zorder=0)
        place = {"va": side, "transform": ax.get_yaxis_transform(), "color": style.GREY}
        ax.text(0.02, level, f"$μ_{name}$ = {level:g}", fontsize=8, **place)
    ramp = f"ramp up to $v_t$ = {float(parameters['friction']['v_t']) * style.MM:g} mm/s"
    note = "set-valued at rest" if parameters["friction"]["set_valued"] else ramp
    ax.annotate(note, (0.97, 0.06), xycoords="axes fraction", ha="right", fontsize=8, color=style.GREY)


def draw(target: Target, ds: xr.Dataset) -> Panels:
    """Draw every law of the dataset, the others in grey behind it for comparison."""
    from wedgesweep import config

    settings = config.parse(ds.attrs["config"])
    names = cases.laws(ds)
    parameters = {law: settings.record(config.Case(law, 1.0, 1e-3))[0] for law in names}
    reach = REACH * settings.friction["threshold_velocity"]
    curves = {law: curve(law, parameters[law], reach) for law in names}
    made = panels(target, len(names), size=(3.2, 3.0))
    for ax, law in zip(made.axes, names, strict=True):
        for velocity, coefficient in curves.values():
            ax.plot(velocity * style.MM, coefficient, color="0.8", linewidth=1)
        velocity, coefficient = curves[law]
        ax.plot(velocity * style.MM, coefficient, color=style.law_style(law)["color"], linewidth=1.7)
        ax.set_title(law, fontsize=10)
        _annotate(ax, law, parameters[law])
    style.label(made.axes, "slip velocity [mm/s]", "friction coefficient $μ$, signed [1]")
    grey = "; grey: the other laws" if len(names) > 1 else ""
    made.title("Friction laws", "a positive coefficient opposes a positive slip velocity" + grey)
    return made
