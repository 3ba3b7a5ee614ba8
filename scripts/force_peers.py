#!/usr/bin/env python3
"""Other ways to find the force that a base model lacks in loops, beside the empirical force.

Each method sees displacement, velocity, and the measured force less the base model's. It predicts records
that it was not fitted to (of a single record blocks of cycles), whose zero is free. pysindy is needed,
which brings scikit-learn along.
"""

import argparse
import json
import warnings
from collections.abc import Callable, Iterator, Mapping
from math import inf
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pysindy
import xarray as xr
from frame_peers import sparse_fit
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import RBF, ConstantKernel, WhiteKernel

# Terms of SINDy whose rms is less than this share of the force's are dropped.
SPARSITY = 0.02
# A Gaussian process takes the cube of the number of samples; more than these make it no better here.
SAMPLES = 800


class Samples(NamedTuple):
    """Displacement and velocity over their largest values (n,), force (N), and the number of the test."""

    place: np.ndarray
    speed: np.ndarray
    force: np.ndarray
    test: np.ndarray

    def of(self, chosen: np.ndarray) -> "Samples":
        return Samples(*(each[chosen] for each in self))

    def centred(self, values: np.ndarray) -> np.ndarray:
        """Values (n, ...) less the mean of their test."""
        found = np.array(values, float)
        for test in np.unique(self.test):
            found[self.test == test] -= found[self.test == test].mean(axis=0)
        return found


Predict = Callable[[Samples], np.ndarray]


def linear_fit(seen: Samples) -> Predict:
    """A spring and a damper."""

    def terms(samples: Samples) -> np.ndarray:
        return samples.centred(np.column_stack([samples.place, samples.speed]))

    sizes = np.linalg.lstsq(terms(seen), seen.centred(seen.force), rcond=None)[0]
    return lambda samples: terms(samples) @ sizes


def sindy(seen: Samples) -> Predict:
    """Sparse regression on polynomials up to the third degree, drag and friction."""
    library = pysindy.PolynomialLibrary(degree=3, include_bias=False)

    def terms(samples: Samples) -> np.ndarray:
        states = np.column_stack([samples.place, samples.speed])
        sign = np.sign(samples.speed)
        known = np.asarray(library.fit_transform(states))
        others = sign, samples.speed**2 * sign, sign * samples.place
        return samples.centred(np.column_stack([known, *others]))

    sizes = sparse_fit(terms(seen), seen.centred(seen.force), SPARSITY)
    return lambda samples: terms(samples) @ sizes


def gaussian_process(seen: Samples) -> Predict:
    """A smooth force of displacement and velocity whose lengths are fitted, with a step at rest."""

    def states(samples: Samples) -> np.ndarray:
        return np.column_stack([samples.place, samples.speed, np.sign(samples.speed)])

    rows = np.linspace(0, seen.force.size - 1, min(SAMPLES, seen.force.size)).astype(int)
    force, scale = seen.centred(seen.force)[rows], seen.force.std()
    kernel = ConstantKernel(1.0, (1e-3, 1e4)) * RBF([1.0] * 3, (1e-2, 1e2)) + WhiteKernel(1e-2, (1e-8, 1.0))
    process = GaussianProcessRegressor(kernel).fit(states(seen)[rows], force / scale)
    return lambda samples: scale * process.predict(states(samples))


METHODS: Mapping[str, Callable[[Samples], Predict]] = {
    "linear fit": linear_fit,
    "SINDy": sindy,
    "Gaussian process": gaussian_process,
}


def held_out(result: Path) -> Iterator[tuple[str, float]]:
    """Name and accuracy on tests left out of each method, then of the diagnosis with and without names."""
    with xr.open_dataset(result / "diagnosis.nc") as found:
        if found.attrs["kind"] != "loop":
            raise SystemExit(f"{result}: has {found.attrs['kind']} tests; loops show the force itself")
        measured, noise = found["measured_force"].values, found["force_noise"].values
        lacking = measured - found["simulated_force"].sel(model="base").values
        states = found["displacement"].values, found["velocity"].values
        names = [str(name) for name in found["test"].values]
    known = np.isfinite(lacking)
    place, speed = (each[known] / np.nanmax(np.abs(each)) for each in states)
    samples = Samples(place, speed, lacking[known], np.nonzero(known)[0])
    records = np.array([name.rsplit(" ", 1)[0] for name in names])
    groups = records if len(set(records)) > 1 else np.array(names)
    size = np.sqrt(np.mean([np.nanvar(each) for each in measured]))
    for name, method in METHODS.items():
        left = np.empty_like(samples.force)
        for group in dict.fromkeys(groups):
            out = (groups == group)[samples.test]
            tested = samples.of(out)
            left[out] = tested.centred(tested.force - method(samples.of(~out))(tested))
        beyond = (left**2).mean() - (noise[samples.test] ** 2).mean()
        yield name, float(np.sqrt(max(beyond, 0.0)) / size)
    told = json.loads((result / "diagnosis.json").read_text())["empirical_force"]
    if told is None:
        raise SystemExit(f"{result}: has no empirical force; ask for it by --empirical-force")
    yield "best names", _accuracy(told["named"])
    yield "empirical force", _accuracy(told)


def _accuracy(told: dict[str, Any]) -> float:
    return inf if told["accuracy_held_out"] is None else float(told["accuracy_held_out"])


def main() -> None:
    """Print a row for each diagnosis."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("results", nargs="+", type=Path, help="directories of diagnoses")
    warnings.filterwarnings("ignore", category=UserWarning)  # lengths at their limits
    for place, result in enumerate(parser.parse_args().results):
        row = dict(held_out(result))
        if not place:
            print("| error on records left out | " + " | ".join(row) + " |")
        print(f"| {result} | " + " | ".join(f"{100.0 * each:.1f} %" for each in row.values()) + " |")


if __name__ == "__main__":
    main()
