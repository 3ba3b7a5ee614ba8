"""Error on tests that were held out of the fit, before and after."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from wedgesweep import digits
from wedgesweep.diagnosed import Diagnosed
from wedgesweep.figures import style
from wedgesweep.figures.diagnosis import look

NAME = "gain"
DESCRIPTION = "error on held-out tests before and after, a row per test"

WORDS = {"frequency": "its frequency left out", "amplitude": "its amplitude left out"}


def _draw(ax, found: Diagnosed, held: list[dict[str, Any]], order: list[int]) -> None:
    for each in held:
        row = order.index(found.place(each["test"]))
        base, extended, noise = (each[f"rmse_{kind}"] for kind in ("base", "extended", "noise"))
        if base is None or extended is None:
            continue
        ax.plot([base, extended], [row, row], color="0.75", linewidth=1.2, zorder=1)
        ax.plot(noise, row, marker="|", color="black", markersize=11, markeredgewidth=1.6)
        ax.plot(base, row, **look.dot("base"))
        ax.plot(extended, row, **look.dot("extended"))
    ax.set_xscale("log")
    low, high = ax.get_xlim()
    ax.set_xlim(min(low, 0.5), max(high, 2.2))
    style.log_ticks(ax.xaxis)
    ax.set_ylim(len(order) - 0.4, -0.6)
    ax.set_yticks(range(len(order)), [""] * len(order))
    ax.set_title(WORDS[held[0]["scheme"]], fontsize=10)
    ax.set_xlabel("error over noise, rms over harmonics [1]", fontsize=9)


def draw(found: Diagnosed) -> Figure:
    """Draw the whitened error of both models in each test, fitted to other frequencies or amplitudes.

    To see: the grey line is what the extension gains on data that it has not seen; a plus at the noise mark
    predicts as well as can be. A row with the plus on the right speaks against the extension.
    """
    gain = found.gain
    if gain is None:
        message = f"{NAME}: nothing was held out (no extended model, or too few tests)"
        raise ValueError(message)
    held = gain["held_out"]
    schemes = [scheme for scheme in WORDS if any(each["scheme"] == scheme for each in held)]
    tested = {found.place(each["test"]) for each in held}
    order = [int(test) for test in look.by_frequency(found.data) if test in tested]
    height = max(look.per_test_height(len(order)), 2.2)
    figure, axes = style.panels(len(schemes), columns=2, size=(3.6, height), share=False, margin=(1.6, 0.8))
    for ax, scheme in zip(axes, schemes, strict=True):
        _draw(ax, found, [each for each in held if each["scheme"] == scheme], order)
    axes[0].set_yticks(np.arange(len(order)), [look.label(found.data, test) for test in order])
    looks = [look.dot("base"), look.dot("extended")]
    noise = Line2D([], [], marker="|", color="black", linestyle="none", markersize=11, markeredgewidth=1.6)
    handles = [*(Line2D([], [], **each) for each in looks), noise]
    labels = [*look.names(found).values(), "noise floor"]
    figure.legend(handles, labels, loc="outside lower center", ncols=3, fontsize=9, frameon=False)
    ends = " to ".join(digits.percent(end) for end in gain["ci95"] or ())
    interval = f" (95 % interval {ends})" if ends else ""
    style.title(
        figure,
        f"Held-out tests: {digits.percent(gain['excess_removed'])} of the excess error removed{interval}",
        "each test predicted by models fitted to the others",
    )
    return figure
