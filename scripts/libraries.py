"""ODE libraries on the workload: each gives the amplitude ratio of a record at a tolerance.

All integrate smooth.py's right-hand side from rest to the end of the window in one go and are asked for
samples of its kept part. An optional library that is not installed is named as absent.
"""

from importlib.util import find_spec

import numpy as np
import smooth
from scipy.integrate import odeint
from workload import sample_times, turning_point_ratio

from wedgesweep.systems import compact

ABSOLUTE = 1e-2  # absolute tolerance over the relative one; the state is scaled to order one
MOST_STEPS = 1_000_000


def _times(record):
    """Start and samples (s)."""
    return np.concatenate([[0.0], sample_times(float(record["input"]["omega"][0]))])


def _ratio(times, states, record):
    """Amplitude ratio from the scaled states at the start and the samples; NaN if it is not finite."""
    if not np.isfinite(states).all():
        return np.nan
    position, velocity = states[1:].T
    return turning_point_ratio(times[1:], position, velocity * record["input"]["omega"][0], 1.0)


def scipy_lsoda(record, rtol):
    # odeint, because it makes fewer Python calls a step than solve_ivp.
    times = _times(record)
    options = {"rtol": rtol, "atol": ABSOLUTE * rtol, "mxstep": MOST_STEPS, "tfirst": True}
    return _ratio(times, odeint(smooth.rate_of, np.zeros(2), times, (compact(record),), **options), record)


def numbalsoda(record, rtol):
    from numbalsoda import lsoda

    times = _times(record)
    states, success = lsoda(
        smooth.rate_at.address, np.zeros(2), times, compact(record), rtol, ABSOLUTE * rtol, MOST_STEPS
    )
    return _ratio(times, states, record) if success else np.nan


# Name, module that it needs, function.
LIBRARIES = (
    ("LSODA (scipy odeint)", "scipy", scipy_lsoda),
    ("numbalsoda", "numbalsoda", numbalsoda),
)


def installed():
    """Functions of the libraries that are there, by name, and the names of the others."""
    there = {name: solve for name, module, solve in LIBRARIES if find_spec(module)}
    return there, [name for name, _, _ in LIBRARIES if name not in there]
