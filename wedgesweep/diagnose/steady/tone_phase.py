"""At which phase a foreign vibration met the input in each record, learnt from a fit.

A tone of another frequency runs through all phases of the input, but in a record of few periods only through
some of them, and friction answers to both at once. Where the tone shows, so does its phase, but next to
half the input's frequency the response does not lag behind it by the same in every phase; where it lies so
close to a harmonic that the record cannot tell them apart, only the other harmonics know.
"""

from dataclasses import replace

import numpy as np

from wedgesweep.diagnose.least_squares import refine
from wedgesweep.diagnose.steady.model import Fit, Model, Point, best_evaluation_per_test

# Phases that are tried.
PHASES = 12


def with_tone_phase(fit: Fit) -> Fit:
    """A fit followed on with the phases of a foreign vibration among what is unknown, if that is better."""
    if not fit.model.has_tone or not fit.evaluation.found or fit.model.fits_tone_phase(fit.evaluation.point):
        return fit
    again = refine(fit.model, fit.model.evaluate(_at_best_phases(fit.model, fit.evaluation.point)))
    return min(fit, again, key=lambda each: each.chi2)


def _at_best_phases(model: Model, point: Point) -> Point:
    """The point with the phase that leaves least of each test in which a tone shows."""
    phases = 2.0 * np.pi / PHASES * np.arange(PHASES)
    told = np.where(model.tone_tests, 0.0, np.nan)
    evaluations = model.evaluate_all([replace(point, tone_phase=told + phase) for phase in phases])
    return replace(point, tone_phase=told + phases[best_evaluation_per_test(evaluations)])
