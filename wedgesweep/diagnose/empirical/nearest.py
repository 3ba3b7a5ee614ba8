"""Which known forms the empirical force looks like: hypotheses to test, never a verdict."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from wedgesweep.diagnose.cross_validation import RESAMPLED
from wedgesweep.diagnose.empirical.force_map import ForceMap

Form = Callable[[np.ndarray, np.ndarray], np.ndarray]
# Forms of effects (their names in brackets), and others that are often met, of displacement z and velocity v
# in units of the largest ones.
FORMS: dict[str, Form] = {
    "spring (bolster_stiffness)": lambda z, v: z,
    "spring that stiffens (cubic_stiffness)": lambda z, v: z**3,
    "spring that differs by side (asymmetric_spring)": lambda z, v: np.abs(z),
    "end stops or play (end_stop, backlash)": lambda z, v: np.sign(z) * np.maximum(np.abs(z) - 0.7, 0.0),
    "damper (viscous_damping)": lambda z, v: v,
    "damper that differs by direction (directional_damping)": lambda z, v: np.abs(v),
    "drag (quadratic_drag)": lambda z, v: v * np.abs(v),
    "damper that is degressive (degressive_damping)": lambda z, v: np.sign(v) * np.sqrt(np.abs(v)),
    "dry friction (guide_friction, friction_level)": lambda z, v: np.sign(v),
    "friction that falls with speed (stribeck)": lambda z, v: np.sign(v) * np.exp(-np.abs(v) / 0.2),
    "friction that differs along the stroke (position_friction)": lambda z, v: np.sign(v) * z,
    "friction that grows with travel": lambda z, v: np.sign(v) * np.abs(z),
    "damping that differs along the stroke": lambda z, v: v * z,
    "damping that grows with travel": lambda z, v: v * z**2,
    "spring whose stiffness depends on speed": lambda z, v: z * np.abs(v),
}
# Shares below this are those of anything that is smooth.
LEAST_SHARE = 0.1


class Nearest(NamedTuple):
    """A form, the share of the force's mean square that it explains, and 95 % interval of that share."""

    name: str
    share: float
    interval: tuple[float, float]


def nearest(found: ForceMap) -> list[Nearest]:
    """All forms that explain more than anything smooth does, the best first."""
    z, v = np.meshgrid(*(np.linspace(-1.0, 1.0, n) for n in found.force.shape), indexing="ij")
    known = np.where(found.measured, found.density, 0.0) / found.std**2
    weight = np.sqrt(known / known.max()).ravel()
    values, vectors = np.linalg.eigh(found.covariance)
    draws = np.random.default_rng(0).standard_normal((RESAMPLED, len(values)))
    about = draws * np.sqrt(np.maximum(values, 0.0)) @ vectors.T
    forces = weight * np.concatenate([found.force.ravel()[None], found.force.ravel() + about])
    forces = _without(forces, weight)
    scatter = forces[1:] - forces[0]
    # Errors add their own power to that of the force; a draw has those of the estimate, and its own.
    errors = np.r_[1.0, np.full(RESAMPLED, 2.0)]
    power = (forces**2).sum(axis=1) - errors * (scatter**2).sum(axis=1).mean()
    rows = []
    for name, form in FORMS.items():
        shape = _without((weight * form(z, v).ravel())[None], weight)[0]
        along = (forces @ shape) ** 2 - errors * ((scatter @ shape) ** 2).mean()
        shares = np.divide(along, power * (shape @ shape), out=np.zeros_like(along), where=power > 0.0)
        shares = np.clip(shares, 0.0, 1.0)
        low, high = np.quantile(shares[1:], [0.025, 0.975])
        rows.append(Nearest(name, float(shares[0]), (float(low), float(high))))
    return sorted((each for each in rows if each.share >= LEAST_SHARE), key=lambda each: -each.share)


def _without(forces: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """Forces (n, m) without the constant, which no test shows."""
    return forces - np.outer(forces @ weight, weight) / (weight @ weight)
