"""A force at the nodes of a table as parameters of a fit, beside friction for its step at zero velocity."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from wedgesweep.config import Config
from wedgesweep.diagnose.fit_data import FitData, Motion
from wedgesweep.diagnose.fit_parameters import FitParameter, Hypothesis, Values
from wedgesweep.effects import merge
from wedgesweep.effects.empirical_force import (
    COEFFICIENTS,
    NAME,
    PLACES,
    SPEEDS,
    TABLE,
    coefficients,
    nodes,
)
from wedgesweep.solvers import imposed_motion

# Largest force of a node, in units of the largest force in the tests.
LARGEST = 10.0
# What changes the step of friction at zero velocity, the first one that a model may lack: where surfaces rub
# already it is their level.
STEPS = ("guide_friction", "friction_level")


@dataclass(frozen=True)
class Ranges:
    """Displacement (m) about a centre and velocity (m/s) of the outermost nodes, and unit of forces (N)."""

    displacement: float
    velocity: float
    force: float
    centre: float = 0.0

    @classmethod
    def of(cls, data: FitData, moved: Motion) -> "Ranges":
        """Ranges of a motion; the largest force was recorded, or is that of spring and inertia in it."""
        lowest, highest = float(moved.displacement.min()), float(moved.displacement.max())
        speed, place, units = float(np.abs(moved.velocity).max()), max(-lowest, highest), data.units
        acting = units.mass * max(speed**2 / place, place / units.time**2)
        force = max(acting, *(0.5 * float(np.ptp(each)) for each in data.recorded_forces), 0.0)
        return cls(0.5 * (highest - lowest), speed, force, 0.5 * (highest + lowest))


@dataclass(frozen=True)
class EmpiricalHypothesis(Hypothesis):
    """A step by friction where the model has any, then the forces at all nodes."""

    ranges: Ranges = field(default_factory=lambda: Ranges(1.0, 1.0, 1.0))

    @classmethod
    def of(cls, model: Config, ranges: Ranges, **more: object) -> "EmpiricalHypothesis":
        step = [name for name in STEPS if name in model.possible_effects][:1]
        return cls((*step, NAME), wider=tuple(step), ranges=ranges, **more)  # type: ignore[arg-type]

    @property
    def step(self) -> str | None:
        """The effect that makes the step."""
        return self.effects[0] if len(self.effects) > 1 else None

    @cached_property
    def parameters(self) -> tuple[FitParameter, ...]:
        others = Hypothesis(self.effects, self.fixed, self.units, self.wider).parameters
        ends = (-LARGEST, LARGEST)
        nodes = (FitParameter(f"{NAME}.{TABLE}.{i}", *ends, ends) for i in range(PLACES * SPEEDS))
        return (*others, *nodes)

    @property
    def nodes(self) -> slice:
        """Where the forces at the nodes stand among the parameters, in units of ``ranges.force``."""
        size = len(self.parameters)
        return slice(size - PLACES * SPEEDS, size)

    def values(self, x: np.ndarray) -> Values:
        found = super().values(x)
        forces = coefficients(self.ranges.force * x[self.nodes])
        own = self.ranges
        table = {"displacement": own.displacement, "velocity": own.velocity, "centre": own.centre}
        return {**found, NAME: {**table, COEFFICIENTS: forces}}  # type: ignore[dict-item]


# Time (s) between samples of a motion in which nothing that has a memory moves.
INSTANT = 1e-9
# Velocity at which a step of friction is taken, over the largest one: beyond the ramp of regularised laws.
SLOW = 1e-2


def force_of(data: FitData, values: Values, without: Values, places: np.ndarray, speed: float) -> np.ndarray:
    """Force (n,) on the mass (N) of effects less that of others at places (n,) (m) and one speed (m/s)."""
    model = data.model
    rows = [model.record_with(merge(model.effects, each), data.law, 0.0) for each in (values, without)]
    velocity, nothing = np.full(places.size, speed), np.zeros(places.size)
    there, here = imposed_motion.forces(np.concatenate(rows), places, velocity, nothing, INSTANT)
    return np.asarray(here - there)


def half_step(data: FitData, values: Values, without: Values, ranges: Ranges) -> float:
    """Half the step (N) that the force against the motion makes at zero velocity in the centre."""
    place, speed = np.full(2, ranges.centre), SLOW * ranges.velocity
    ahead, back = (force_of(data, values, without, place, side * speed)[0] for side in (1.0, -1.0))
    return 0.5 * float(back - ahead)


def at_nodes(data: FitData, values: Values, without: Values, ranges: Ranges) -> tuple[np.ndarray, float]:
    """Force at the nodes, (PLACES, SPEEDS), without its step at zero velocity, and half of that."""
    places, speeds = nodes(ranges.displacement, ranges.velocity, ranges.centre)
    step, middle = half_step(data, values, without, ranges), SPEEDS // 2
    found = np.empty((places.size, speeds.size))
    for j, speed in enumerate(speeds):
        if j != middle:
            found[:, j] = force_of(data, values, without, places, speed) + step * np.sign(speed)
    found[:, middle] = 0.5 * (found[:, middle - 1] + found[:, middle + 1])
    return found, step
