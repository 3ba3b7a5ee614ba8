"""Energy that the base puts in per cycle, measured and simulated."""

from matplotlib.figure import Figure

from wedgesweep.diagnosed import Diagnosed
from wedgesweep.figures import style
from wedgesweep.figures.diagnosis import look, rows

NAME = "energy"
DESCRIPTION = "energy per cycle, measured and simulated"

MJ = 1e3  # mJ per J


def draw(found: Diagnosed) -> Figure:
    """Draw the energy per cycle, and what each model has of the measured one, a row per test.

    It follows from the fundamental of the displacement, and in steady vibration it is what friction takes.
    To see: a base model right of 1 dissipates more than the bench does, left of it less.
    """
    order = rows.shown(found, "energy")
    if not order.size:
        message = (
            f"{NAME}: no test has a known input of the side frame itself, without which there is no energy"
        )
        raise ValueError(message)
    figure, (left, right) = rows.panels(found, order, 2)
    rows.draw_values(left, found, order, "energy", MJ)
    left.set_xscale("log", nonpositive="mask")
    style.log_ticks(left.xaxis)
    left.set_xlabel("energy per cycle [mJ]", fontsize=9)
    rows.draw_ratios(right, found, order, "energy")
    right.set_xlabel("simulated over measured [1]", fontsize=9)
    look.legend(figure, found, dots=True)
    style.title(figure, "Energy that the base puts in per cycle")
    return figure
