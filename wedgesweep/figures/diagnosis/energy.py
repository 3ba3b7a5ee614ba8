"""Energy that the input puts in per cycle, measured and simulated."""

from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.figures import labels, style
from wedgesweep.figures.diagnosis import marks, rows
from wedgesweep.figures.panels import Panels, Target

NAME = "energy"
DESCRIPTION = "energy per cycle, measured and simulated"
TESTS = "steady"

MJ = 1e3  # mJ per J


def draw(target: Target, result: DiagnosisResult) -> Panels:
    """Draw the energy per cycle and the ratio of simulated to measured energy, a row per test.

    The energy follows from the fundamental of the displacement; in steady vibration friction dissipates it.
    To see: where the base model is right of 1 it dissipates more than the bench does, left of 1 less.
    """
    order, words = rows.known(result, "energy"), labels.of(result.data)
    if not order.size:
        known = "amplitude of the force" if words.forced else f"motion of the {words.base}"
        raise ValueError(f"no test has a known {known}, from which the energy follows")
    made = rows.make_panels(target, result, order, 2)
    left, right = made.axes
    rows.draw_values(left, result, order, "energy", MJ)
    left.set_xscale("log", nonpositive="mask")
    style.log_ticks(left.xaxis)
    left.set_xlabel("energy per cycle [mJ]", fontsize=9)
    rows.draw_ratios(right, result, order, "energy")
    right.set_xlabel("simulated over measured energy [1]", fontsize=9)
    marks.legend(made, result, dots=True)
    made.title(f"Energy that {words.driver} puts in per cycle")
    return made
