#!/usr/bin/env python3
"""Other ways to fit the published recordings of a frame that rubs on a wall, in the unit of wedgesweep's.

Each method is fitted to one recording and predicts the other. Whatever it finds is simulated by wedgesweep
under the recorded base motion; friction is in proportion to the weight of the disc. SINDy needs pysindy.
"""

import argparse
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pysindy
import real_frame
from real_frame import AS_RECORDED, DISCS, FREQUENCY, Frame
from scipy.optimize import least_squares

# Harmonics of a recording that the methods see, as wedgesweep does.
HARMONICS = 16
# Terms of SINDy whose contribution to the force is less than this share (rms) are dropped.
SPARSITY = 0.05
# SINDy sees samples at which the plate is faster than this share of its highest velocity: where it sticks,
# friction is no function of velocity, and with those samples the regression fails.
MOVING = 0.1


class Recorded(NamedTuple):
    """Harmonics (H,) of plate and base in m, from a recording, with their angular frequencies (rad/s)."""

    plate: np.ndarray
    base: np.ndarray
    omega: np.ndarray

    def series(self, harmonics: np.ndarray, order: int = 0) -> np.ndarray:
        """Samples (n,) of one period of a quantity, or of its derivative."""
        time = np.arange(1000) / (1000.0 * FREQUENCY)
        return (harmonics * (1j * self.omega) ** order @ np.exp(1j * np.outer(self.omega, time))).real


def read(file: Path) -> Recorded:
    """Harmonics of a recording by least squares."""
    time, plate, base = np.genfromtxt(file, delimiter=",", skip_header=1).T
    omega = 2.0 * np.pi * FREQUENCY * np.arange(1, HARMONICS + 1)
    angles = np.outer(time, omega)
    waves = np.hstack([np.cos(angles), np.sin(angles), np.ones((time.size, 1))])
    numbers = np.linalg.lstsq(waves, 1e-3 * np.column_stack([plate, base]), rcond=None)[0][:-1]
    harmonics = numbers[:HARMONICS] - 1j * numbers[HARMONICS:]
    return Recorded(harmonics[:, 0], harmonics[:, 1], omega)


def linear_fit(recorded: Recorded) -> Frame:
    """Stiffness and damping of the linear frame that comes closest."""
    return _linear(recorded, lambda x: Frame(stiffness=x[0] * Frame().stiffness, damping=x[1]), [1.0, 1.0])


def equivalent_damping(recorded: Recorded) -> Frame:
    """Viscous damping in place of friction, the stiffness being as stated."""
    return _linear(recorded, lambda x: Frame(damping=x[0]), [10.0])


def _linear(recorded: Recorded, frame: Callable[[np.ndarray], Frame], start: list[float]) -> Frame:
    def left(x: np.ndarray) -> np.ndarray:
        one = frame(x)
        joint = one.stiffness + 1j * recorded.omega * one.damping
        response = joint / (joint - real_frame.MASS * recorded.omega**2) * recorded.base
        error = (response - recorded.plate) / np.linalg.norm(recorded.plate)
        return np.r_[error.real, error.imag]

    return frame(least_squares(left, start, bounds=(0.0, np.inf)).x)


def sindy(recorded: Recorded) -> Frame:
    """Sparse regression of the restoring force on spring, damper, cubic spring and dry friction."""
    stretch = recorded.plate - recorded.base
    states = [recorded.series(stretch), recorded.series(stretch, 1), recorded.series(recorded.plate, 1)]
    functions = [
        lambda z, _v, _w: z,
        lambda _z, v, _w: v,
        lambda z, _v, _w: z**3,
        lambda _z, _v, w: np.sign(w),
    ]
    library = pysindy.CustomLibrary(library_functions=functions)
    moving = np.abs(states[2]) > MOVING * np.abs(states[2]).max()
    terms = np.asarray(library.fit_transform(np.column_stack(states)[moving]))
    force = -real_frame.MASS * recorded.series(recorded.plate, 2)[moving]
    stiffness, damping, cubic, friction = sparse_fit(terms, force, SPARSITY)
    return Frame(stiffness, max(damping, 0.0), friction, cubic)


def sparse_fit(terms: np.ndarray, force: np.ndarray, least: float) -> np.ndarray:
    """Coefficients (k,) of terms (n, k) of a force (n,); those with less than a share of its rms are 0."""
    sizes = np.sqrt((terms**2).mean(axis=0) / (force**2).mean())
    fitted = pysindy.STLSQ(threshold=least, alpha=0.0).fit(terms / sizes, force[:, None])
    return np.ravel(fitted.coef_) / sizes


METHODS: Mapping[str, Callable[[Recorded], Frame]] = {
    "linear fit (stiffness and damping)": linear_fit,
    "equivalent viscous damping": equivalent_damping,
    "SINDy on the restoring force": sindy,
}


class Compared(NamedTuple):
    """What a method found in a recording, its accuracy there and that of its prediction of the other one."""

    frame: Frame
    own: float
    other: float


def compared(data: Path, output: Path) -> dict[str, dict[int, Compared]]:
    """What the methods found, by name and disc."""
    real_frame.copy(data, output)
    recorded = {grams: read(output / f"{AS_RECORDED}-{grams}g.csv") for grams in DISCS}
    found = {name: {grams: method(recorded[grams]) for grams in DISCS} for name, method in METHODS.items()}
    forces = {grams: real_frame.linear(output, AS_RECORDED, grams).force for grams in DISCS}
    mine = {grams: real_frame.rubbing(output, AS_RECORDED, grams, forces[grams]) for grams in DISCS}
    found["wedgesweep, friction"] = {grams: mine[grams].friction.frame for grams in DISCS}
    found["wedgesweep, friction, stiffness and damping"] = {
        grams: mine[grams].with_damping.frame for grams in DISCS
    }

    def tried(frame: Frame, grams: int) -> float:
        return real_frame.evaluated(output, frame, AS_RECORDED, grams)[0]

    return {
        name: {
            grams: Compared(
                frames[grams],
                tried(frames[grams], grams),
                tried(frames[grams].under(other / grams), other),
            )
            for grams, other in (DISCS, DISCS[::-1])
        }
        for name, frames in found.items()
    }


def main() -> None:
    """Print the table."""
    options = real_frame.parsed(argparse.ArgumentParser(description=__doc__))
    print("| fitted to | own | the other | stiffness, damping, friction, cubic stiffness |")
    for name, by_disc in compared(options.data, options.output).items():
        for grams, (frame, own, other) in by_disc.items():
            print(f"| {name}, {grams} g | {own:.1%} | {other:.1%} | {frame.stiffness:.0f} N/m, ", end="")
            print(f"{frame.damping:.2f} N s/m, {frame.friction:.3f} N, {1e-9 * frame.cubic:.3f} N/mm3 |")


if __name__ == "__main__":
    main()
