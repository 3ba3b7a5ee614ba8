"""Cases that several physics tests share."""

from math import inf

from wedgesweep import response
from wedgesweep.solvers import event_driven, radau
from wedgesweep.solvers.trajectory import Window
from wedgesweep.systems.suspension.parameters import SUSPENSION

TABLE_1 = {quantity.name: quantity.default * quantity.factor for quantity in SUSPENSION}
OMEGA_N = (TABLE_1["bolster_spring"] / TABLE_1["bolster_mass"]) ** 0.5


def steady(record, settle_periods=60, periods=2, rtol=1e-6, samples_per_period=256, settled=None):
    """Numbers of the response after a settling time, by Radau."""
    return evaluated(record, settle_periods, periods, rtol, samples_per_period, settled).numbers


def fast(record, settle_periods=60):
    """Response after a settling time, by the event-driven solver, which takes a hundredth of the time."""
    window = Window(float(record["input"]["omega"][0]), settle_periods, 2, 256)
    return response.evaluate(event_driven.solve(record, window, 1e-8, inf), record, harmonics=9)


def evaluated(record, settle_periods=60, periods=2, rtol=1e-6, samples_per_period=256, settled=None):
    """Numbers, spectra and waveforms of the response after a settling time, see radau.solve."""
    window = Window(float(record["input"]["omega"][0]), settle_periods, periods, samples_per_period)
    run = radau.solve(record, window, rtol, time_limit=inf, settled=settled)
    return response.evaluate(run, record, harmonics=9)
