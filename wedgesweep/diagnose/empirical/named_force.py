"""The force of named effects at places and speeds, as far as it depends on nothing else."""

import numpy as np

from wedgesweep.diagnose.empirical.hypothesis import Ranges
from wedgesweep.diagnose.fit_data import FitData
from wedgesweep.diagnose.fit_parameters import Values
from wedgesweep.effects import merge
from wedgesweep.effects.empirical_force import SPEEDS, nodes
from wedgesweep.solvers import imposed_motion

# Time (s) between samples of a motion in which nothing that has a memory moves.
INSTANT = 1e-9
# Velocity at which a step of friction is taken, over the largest one: beyond the ramp of regularised laws.
SLOW = 1e-2


def force_of(data: FitData, values: Values, without: Values, motion: tuple[np.ndarray, float]) -> np.ndarray:
    """Force (n,) on the mass (N) of effects less that of others at places (n,) (m) and one speed (m/s)."""
    places, speed = motion
    model = data.model
    rows = [model.record_with(merge(model.effects, each), data.law, 0.0) for each in (values, without)]
    velocity, nothing = np.full(places.size, speed), np.zeros(places.size)
    there, here = imposed_motion.forces(np.concatenate(rows), places, velocity, nothing, INSTANT)
    return np.asarray(here - there)


def half_step(data: FitData, values: Values, without: Values, ranges: Ranges) -> float:
    """Half the step (N) that the force against the motion makes at zero velocity in the centre."""
    place, speed = np.full(2, ranges.centre), SLOW * ranges.velocity
    ahead, back = (force_of(data, values, without, (place, side * speed))[0] for side in (1.0, -1.0))
    return 0.5 * float(back - ahead)


def at_nodes(data: FitData, values: Values, without: Values, ranges: Ranges) -> tuple[np.ndarray, float]:
    """Force at the nodes, (PLACES, SPEEDS), without its step at zero velocity, and half of that."""
    places, speeds = nodes(ranges.displacement, ranges.velocity, ranges.centre)
    step, middle = half_step(data, values, without, ranges), SPEEDS // 2
    found = np.empty((places.size, speeds.size))
    for j, speed in enumerate(speeds):
        if j != middle:
            found[:, j] = force_of(data, values, without, (places, speed)) + step * np.sign(speed)
    found[:, middle] = 0.5 * (found[:, middle - 1] + found[:, middle + 1])
    return found, step
