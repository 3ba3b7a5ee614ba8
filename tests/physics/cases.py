"""Cases that several physics tests share."""

from wedgesweep import response
from wedgesweep.solvers import radau
from wedgesweep.solvers.trajectory import Window
from wedgesweep.systems.suspension.parameters import SUSPENSION

TABLE_1 = {quantity.name: quantity.default * quantity.factor for quantity in SUSPENSION}
OMEGA_N = (TABLE_1["bolster_spring"] / TABLE_1["bolster_mass"]) ** 0.5


def steady(record, settle_periods=60, periods=2, rtol=1e-6, samples_per_period=256, settled=None):
    """Numbers of the response after a settling time."""
    return evaluated(record, settle_periods, periods, rtol, samples_per_period, settled).numbers


def evaluated(record, settle_periods=60, periods=2, rtol=1e-6, samples_per_period=256, settled=None):
    """Numbers, spectra and waveforms of the response after a settling time, see radau.solve."""
    window = Window(float(record["input"]["omega"][0]), settle_periods, periods, samples_per_period)
    run = radau.solve(record, window, rtol, time_limit=120.0, settled=settled)
    return response.evaluate(run, record, harmonics=9)
