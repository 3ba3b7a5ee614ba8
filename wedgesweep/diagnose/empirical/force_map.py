"""The empirical force over displacement and velocity, where tests have been, with its uncertainty."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from wedgesweep.diagnose.empirical.hypothesis import Ranges
from wedgesweep.diagnose.empirical.smooth_fit import SmoothFit
from wedgesweep.diagnose.fit_data import Motion
from wedgesweep.effects.empirical_force import interpolation

# Cells of the map over displacement and over velocity, odd so that one is at rest.
CELLS = 25, 33
# A cell that holds less than this share of the samples that a cell holds on average was not measured.
SPARSE = 0.1


@dataclass(frozen=True)
class ForceMap:
    """A force (P, V) (N) at ``places`` (P,) (m) and ``speeds`` (V,) (m/s), with its error.

    ``density`` (P, V): samples in each cell over the average; ``covariance`` of forces (P V, P V).
    The force is on the mass, the step of friction at v = 0 included.
    """

    places: np.ndarray
    speeds: np.ndarray
    force: np.ndarray
    covariance: np.ndarray
    density: np.ndarray

    @cached_property
    def std(self) -> np.ndarray:
        return np.sqrt(np.diag(self.covariance)).reshape(self.force.shape)

    @property
    def measured(self) -> np.ndarray:
        """Whether tests have been in a cell, (P, V)."""
        return self.density >= SPARSE

    def over(self, axis: int) -> tuple[np.ndarray, np.ndarray]:
        """Mean force and its standard deviation over speeds (axis 0: mean over places), or over places (1).

        The mean is weighted with the density; NaN where nothing was measured.
        """
        weight = np.where(self.measured, self.density, 0.0)
        total = weight.sum(axis=axis, keepdims=True)
        weight = np.divide(weight, total, out=np.zeros_like(weight), where=total > 0.0)
        mean = (weight * self.force).sum(axis=axis)
        own = self.covariance.reshape(*self.force.shape, *self.force.shape)
        std = np.sqrt(np.einsum(("ij,kj,ijkj->j", "ij,il,ijil->i")[axis], weight, weight, own))
        seen = total.squeeze(axis) > 0.0
        return np.where(seen, mean, np.nan), np.where(seen, std, np.nan)


def force_map(fit: SmoothFit, moved: Motion, step: float, slope: float) -> ForceMap:
    """The force of a fit, without its mean, which no test shows as all sensors have an unknown zero.

    ``step``: half the step of friction at v = 0 beyond the base model's (N), ``slope``: its derivative by the
    first parameter.
    """
    ranges, own = fit.hypothesis.ranges, fit.hypothesis.nodes
    places, speeds = (np.linspace(-1.0, 1.0, count) for count in CELLS)
    grid = np.array([(place, speed) for place in places for speed in speeds])
    basis = np.zeros((len(grid), len(fit.x)))
    basis[:, own] = ranges.force * interpolation(grid[:, 0], grid[:, 1])
    density = _density(moved, ranges)
    weight = np.where(density >= SPARSE, density, 0.0).ravel()
    sign = np.sign(grid[:, 1])
    force = basis @ fit.x - step * sign
    if own.start:
        basis[:, 0] = -slope * sign
    basis -= weight @ basis / weight.sum()
    force -= weight @ force / weight.sum()
    covariance = basis @ fit.covariance @ basis.T
    return ForceMap(
        ranges.centre + ranges.displacement * places,
        ranges.velocity * speeds,
        force.reshape(CELLS),
        covariance,
        density,
    )


def _density(moved: Motion, ranges: Ranges) -> np.ndarray:
    """Samples in each cell over those in an average cell that any are in."""
    edges = [np.linspace(-1.0 - 1.0 / (n - 1), 1.0 + 1.0 / (n - 1), n + 1) for n in CELLS]
    places = (moved.displacement - ranges.centre) / ranges.displacement
    found = np.histogram2d(places, moved.velocity / ranges.velocity, edges)[0]
    return np.asarray(found / found[found > 0.0].mean())
