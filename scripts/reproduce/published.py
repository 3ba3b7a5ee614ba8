"""Published numbers of oscillators with friction, which the same solver must give."""

from itertools import product
from math import cos, exp, pi, sin, sqrt
from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr

from reproduce.findings import Check, above, below
from wedgesweep import config
from wedgesweep.sweep.run import Sweep

# Relative error of Den Hartog's closed form (1930), and the least number of cases without stops.
CLOSED_FORM_ERROR, FEWEST_CASES = 1e-8, 20
# The block on a belt of Leine et al. (1998): each number (SI) and its allowed error.
BELT = {
    "period": (12.00103, 1e-5),
    "slip": (4.29600, 1e-5),
    "stick": (7.70503, 1e-5),
    "sticks_from": (-0.5410064, 1e-6),
    "highest": (1.1339447, 1e-6),
    "lowest": (-0.5554327, 1e-6),
}
# Last samples of slip from which its end is extrapolated; first and last of its first ones, and the degree of
# the polynomial through these.
FITTED = 6
SKIPPED, BEGINNING, DEGREE = 10, 300, 5
# The mass of Exudyn's test of LuGre friction, at a time (s): displacement and deflection of the bristles
# (m), and their allowed errors.
PULLED_AT = 25.0
PULLED = {"displacement": (1.9088391992, 1e-7), "bristles": (1.18167955e-5, 1e-11)}


def check(configs: Path) -> tuple[Check, ...]:
    """Run the configs of these oscillators in a directory, and compare."""
    force, belt, pulled = (
        Sweep(config.load(configs / f"{name}.toml"), Path(f"{name}.nc")).run_here()
        for name in ("den-hartog", "belt", "lugre")
    )
    return *den_hartog(force), *block_on_belt(belt), *pulled_mass(pulled)


def den_hartog(ds: xr.Dataset) -> tuple[Check, ...]:
    """Compare a dataset of Den Hartog's oscillator with his closed form where the motion never stops."""
    cases = ds.sel(friction_law="coulomb")
    errors = [
        abs(case["amplitude_ratio"].item() / _magnification(beta, 1.0 / force) - 1.0)
        for beta, force in product(cases["beta"].values, cases["amplitude"].values)
        if (case := cases.sel(beta=beta, amplitude=force))["stick_fraction"] == 0.0
    ]
    return (
        above("Den Hartog: cases that never stop", len(errors), FEWEST_CASES),
        below(
            "Den Hartog: largest relative error of the amplitude",
            max(errors, default=np.nan),
            CLOSED_FORM_ERROR,
        ),
    )


def _magnification(ratio: float, friction: float) -> float:
    """Amplitude over the deflection at rest, from the ratios of frequencies and of friction to the force."""
    response = 1.0 / (1.0 - ratio**2)
    damping = sin(pi / ratio) / (ratio * (1.0 + cos(pi / ratio)))
    return sqrt(response**2 - (friction * damping) ** 2)


def block_on_belt(ds: xr.Dataset) -> tuple[Check, ...]:
    """Compare a dataset of the block on a belt with the published cycle."""
    case = ds.squeeze()
    belt = config.parse(ds.attrs["config"]).oscillator["belt_velocity"]
    t = case["phase"].values / (2.0 * pi * case["frequency"].item())
    x, velocity, stuck = (case[name].values for name in ("displacement", "velocity", "stuck"))
    cycle = measured(t, x, velocity, stuck, belt)
    return tuple(
        _within(f"block on a belt: {name.replace('_', ' ')}", getattr(cycle, name), *expected)
        for name, expected in BELT.items()
    )


class Cycle(NamedTuple):
    """A stick-slip cycle: times in s, displacements in m."""

    period: float
    slip: float
    stick: float
    sticks_from: float
    highest: float
    lowest: float


def measured(t: np.ndarray, x: np.ndarray, velocity: np.ndarray, stuck: np.ndarray, belt: float) -> Cycle:
    """Take the first whole cycle from evenly sampled motion, shape (n,), on a belt (m/s).

    Slip ends between two samples: where its velocity, extrapolated, is the belt's. It begins from zero
    acceleration, as friction is continuous there, so that the root of the slip velocity is extrapolated.
    """
    stuck = stuck.astype(bool)
    onsets = np.flatnonzero(stuck[1:] & ~stuck[:-1]) + 1
    releases = np.flatnonzero(~stuck[1:] & stuck[:-1]) + 1
    first, second = onsets[0], onsets[1]
    release = releases[releases > first][0]
    begin, end = (_end_of_slip(t, velocity, place, belt) for place in (first, second))
    sticks_from = x[first] - belt * (t[first] - begin)
    slips = _start_of_slip(t, velocity, release, belt)
    # Extremes lie between samples, where the velocity is zero.
    inside = slice(first, second)
    return Cycle(
        end - begin,
        end - slips,
        slips - begin,
        float(sticks_from),
        _extreme(t[inside], x[inside], velocity[inside], 1.0),
        _extreme(t[inside], x[inside], velocity[inside], -1.0),
    )


def _end_of_slip(t: np.ndarray, velocity: np.ndarray, place: int, belt: float) -> float:
    """Time at which the velocity of slip, extrapolated past the last sample, reaches the belt's."""
    near = slice(place - FITTED, place)
    return _crossing(t[near] - t[place], velocity[near] - belt, 3) + t[place]


def _start_of_slip(t: np.ndarray, velocity: np.ndarray, place: int, belt: float) -> float:
    """Time at which slip began, from its first samples but those that are mostly rounding."""
    near = slice(place + SKIPPED, place + BEGINNING)
    return _crossing(t[near] - t[place], np.sqrt(np.abs(velocity[near] - belt)), DEGREE) + t[place]


def _crossing(t: np.ndarray, values: np.ndarray, degree: int) -> float:
    """Time at which a polynomial fitted to values is zero, the one nearest to t = 0."""
    scale = np.abs(t).max()
    roots = np.roots(np.polyfit(t / scale, values, degree))
    real = roots[np.abs(roots.imag) < 1e-6].real
    return float(real[np.abs(real).argmin()] * scale)


def _extreme(t: np.ndarray, x: np.ndarray, velocity: np.ndarray, sign: float) -> float:
    """Largest or smallest displacement of a motion, on the parabola through the samples around it."""
    place = int((sign * x).argmax())
    near = slice(max(place - 2, 0), place + 3)
    middle = t[place]
    fit = np.polyfit(t[near] - middle, x[near], 2)
    return float(fit[2] - fit[1] ** 2 / (4.0 * fit[0]))


def pulled_mass(ds: xr.Dataset) -> tuple[Check, ...]:
    """Compare a dataset of the pulled mass with the published state."""
    case = ds.squeeze().sel(time=PULLED_AT, method="nearest")
    x, v, a = (case[name].item() for name in ("displacement", "velocity", "acceleration"))
    model = config.parse(ds.attrs["config"])
    own, friction = model.oscillator, model.friction
    stiffness, damping, viscous = (own[f"bristle_{name}"] for name in ("stiffness", "damping", "viscous"))
    fading = exp(-((v / friction["threshold_velocity"]) ** 2))
    level = own["normal_force"] * (friction["dynamic"] + (friction["static"] - friction["dynamic"]) * fading)
    # sigma_0 z + sigma_1 (v - sigma_0 |v| z / g) + sigma_2 v = k (u - x) - m a
    friction_force = own["spring"] * (case["input"].item() - x) - own["mass"] * a
    bent = (friction_force - (damping + viscous) * v) / (stiffness * (1.0 - damping * abs(v) / level))
    return tuple(
        _within(f"LuGre friction, pulled: {name}", here, *PULLED[name])
        for name, here in (("displacement", x), ("bristles", bent))
    )


def _within(statement: str, here: float, expected: float, error: float) -> Check:
    return Check(statement, here, f"{expected:.8g} +- {error:g}", bool(abs(here - expected) <= error))
