"""Error on tests that were held out of the fit, before and after."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from wedgesweep import formatting
from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.figures import style
from wedgesweep.figures.diagnosis import marks, rows, selection
from wedgesweep.figures.panels import Panels, Target, panels

NAME = "gain"
DESCRIPTION = "error on held-out tests before and after, a row per test"

TITLES = {
    "frequency": "its frequency left out",
    "amplitude": "its amplitude left out",
    "test": "left out by itself",
    "block": "its block left out",
    "record": "its record left out",
}


def _draw(ax: Axes, result: DiagnosisResult, held: list[dict[str, Any]], order: list[int]) -> None:
    for each in held:
        row = order.index(result.test_index(each["test"]))
        base, extended, noise = (each[f"rmse_{kind}"] for kind in ("base", "extended", "noise"))
        if base is None or extended is None:
            continue
        ax.plot([base, extended], [row, row], color="0.75", linewidth=1.2, zorder=1)
        ax.plot(noise, row, **marks.BAR)
        ax.plot(base, row, **marks.dot("base"))
        ax.plot(extended, row, **marks.dot("extended"))
    ax.set_xscale("log")
    low, high = ax.get_xlim()
    ax.set_xlim(min(low, 0.5), max(high, 2.2))
    style.log_ticks(ax.xaxis)
    ax.set_title(TITLES[held[0]["scheme"]], fontsize=10)
    ax.set_xlabel("error over noise, rms [1]", fontsize=9)


def draw(target: Target, result: DiagnosisResult) -> Panels:
    """Draw the whitened error of both models in each test, after a fit to other frequencies or amplitudes.

    To see: the grey line is what the extension gains on data that it was not fitted to; a plus at the noise
    floor predicts as well as possible. A plus right of the cross speaks against the extension.
    """
    gain = result.gain
    if gain is None:
        raise ValueError("no test was held out (there is no extended model, or there are too few tests)")
    held = gain["held_out"]
    schemes = [scheme for scheme in TITLES if any(each["scheme"] == scheme for each in held)]
    tested = {result.test_index(each["test"]) for each in held}
    order = [int(test) for test in selection.by_frequency(result.data) if test in tested]
    size = 3.6, max(rows.height(len(order)), 2.2)
    made = panels(target, len(schemes), columns=2, size=size, share=False, margin=(1.6, 0.8))
    for place, (ax, scheme) in enumerate(zip(made.axes, schemes, strict=True)):
        _draw(ax, result, [each for each in held if each["scheme"] == scheme], order)
        rows.set_rows(ax, result, np.array(order), named=place == 0)
    handles = [Line2D([], [], **look) for look in (marks.dot("base"), marks.dot("extended"), marks.BAR)]
    made.legend(handles, [*marks.names(result).values(), "noise floor"])
    ends = " to ".join(formatting.percent(end) for end in gain["ci95"] or ())
    interval = f" (95 % interval {ends})" if ends else ""
    made.title(
        f"Held-out tests: {formatting.percent(gain['excess_removed'])} of the excess error removed{interval}",
        "each test is predicted by models fitted to the others",
    )
    return made
