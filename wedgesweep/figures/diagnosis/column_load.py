"""Measured and simulated load of the column over one period of the input, test by test."""

from collections.abc import Sequence

import numpy as np

from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.figures import labels
from wedgesweep.figures.diagnosis import marks, selection
from wedgesweep.figures.diagnosis.multiples import multiples
from wedgesweep.figures.diagnosis.selection import closed
from wedgesweep.figures.panels import Panels, Target

NAME = "column-load"
DESCRIPTION = "normal force of a wedge on its column over one period, measured and simulated"
TESTS = "steady"


def draw(target: Target, result: DiagnosisResult, tests: Sequence[int] | None = None) -> Panels:
    """Draw the load in each test that has it (default: the six that misfit most).

    To see: the thick line is measured (mean over the periods), the dashed line is the base model, all of
    them from the harmonics that are compared. A load that is higher all along means more preload; higher
    steps where slip turns, under the same load, mean more friction.
    """
    if "measured_load" not in result.data:
        raise ValueError("the load of the column was not recorded")
    loads = result.data["measured_load"]
    there = [t for t in selection.choose(result, tests) if np.isfinite(loads.values[t]).any()]
    if not there:
        raise ValueError("friction holds the bolster in these tests, and no load is determined")
    made = multiples(target, result, there, (2.5, 1.5))
    phase = np.linspace(0.0, 1.0, result.data.sizes["phase"] + 1)
    for test, (ax,) in made:
        ax.plot(phase, closed(loads.values[test]), **marks.MEASURED)
        for model in result.models:
            simulated = result.data["simulated_load"].sel(model=model).values[test]
            ax.plot(phase, closed(simulated), **marks.line(model))
        ax.set_xlim(0.0, 1.0)
        ax.set_xlabel("time over period [1]", fontsize=8.5)
    made.label_sides("$N_c$ [N]")
    marks.legend(made, result, dots=False)
    made.title(
        "Normal force of a wedge on its column, measured and simulated",
        f"time 0: ${labels.of(result.data).input}$ = 0, rising",
    )
    return made
