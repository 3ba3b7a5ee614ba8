"""Faults of recorders: valid records are made worse as people's files are, in files and clocks.

Each way takes the columns of a test and gives its columns anew. Sizes are in samples, so that they mean the
same at any rate. Between its samples a channel is a cubic spline, as a record of 60 samples a period allows.
"""

import tomllib
from collections.abc import Callable, Collection
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from wedgesweep import toml

Columns = dict[str, np.ndarray]
# Column of the time (s), and columns of channels that may be late.
TIME, LATE = "t", ("F", "u")


class Way(NamedTuple):
    """A fault of a recorder, with a small and a large size in samples, or as a share of them."""

    small: float
    large: float
    worsened: Callable[[Columns, float, np.random.Generator], Columns]


def _at(columns: Columns, times: np.ndarray, names: Collection[str] | None = None) -> Columns:
    """Columns, or those that are named, as they are at times (n,) in s; the time stays."""
    chosen = columns if names is None else names
    return {
        name: samples if name == TIME or name not in chosen else CubicSpline(columns[TIME], samples)(times)
        for name, samples in columns.items()
    }


def _step(columns: Columns) -> float:
    return float(columns[TIME][1] - columns[TIME][0])


def _rows(columns: Columns, rows: np.ndarray) -> Columns:
    return {name: samples[rows] for name, samples in columns.items()}


def jitter(columns: Columns, size: float, random: np.random.Generator) -> Columns:
    """Samples are taken at scattered times, which the stamps tell."""
    scatter = np.clip(random.normal(0.0, size, columns[TIME].size), -0.45, 0.45)
    times = np.clip(columns[TIME] + scatter * _step(columns), columns[TIME][0], columns[TIME][-1])
    return {**_at(columns, times), TIME: times}


def late_stamps(columns: Columns, size: float, random: np.random.Generator) -> Columns:
    """Samples are even, but software reads the clock late."""
    late = np.minimum(np.abs(random.normal(0.0, size, columns[TIME].size)), 0.9)
    return {**columns, TIME: columns[TIME] + late * _step(columns)}


def rounding(columns: Columns, size: float, _: np.random.Generator) -> Columns:
    """The stamps have few decimals, a power of ten near a share of the step."""
    decimals = round(-np.log10(size * _step(columns)))
    return {**columns, TIME: np.round(columns[TIME], decimals)}


def drift(columns: Columns, size: float, _: np.random.Generator) -> Columns:
    """The rate changes slowly; the stamps tell."""
    share = np.linspace(0.0, 1.0, columns[TIME].size)
    times = columns[TIME] - 4.0 * size * _step(columns) * share * (1.0 - share)
    times = np.clip(times, columns[TIME][0], columns[TIME][-1])
    times[1:] = np.maximum(times[1:], times[:-1] + 1e-3 * _step(columns))
    return {**_at(columns, times), TIME: times}


def lost(columns: Columns, size: float, random: np.random.Generator) -> Columns:
    """Samples are lost here and there, and the stamps go on."""
    kept = random.random(columns[TIME].size) >= size
    kept[[0, -1]] = True
    return _rows(columns, kept)


def pause(columns: Columns, size: float, random: np.random.Generator) -> Columns:
    """Samples are lost once, one after the other."""
    first = int(random.uniform(0.2, 0.7) * columns[TIME].size)
    return _rows(columns, np.r_[0:first, first + int(size) : columns[TIME].size])


def doubled(columns: Columns, size: float, random: np.random.Generator) -> Columns:
    """Some samples are written twice."""
    written = 1 + (random.random(columns[TIME].size) < size)
    return _rows(columns, np.repeat(np.arange(columns[TIME].size), written))


def missing(columns: Columns, size: float, random: np.random.Generator) -> Columns:
    """Cells of each channel are empty here and there."""
    return {
        name: samples if name == TIME else np.where(random.random(samples.size) < size, np.nan, samples)
        for name, samples in columns.items()
    }


def delay(columns: Columns, size: float, random: np.random.Generator) -> Columns:
    """The force of loops, or the input, is late by a time of which the std is known."""
    times = columns[TIME] - size * random.normal() * _step(columns)
    return _at(columns, np.clip(times, columns[TIME][0], columns[TIME][-1]), LATE)


DELAY = "delay"
WAYS = {
    "jitter": Way(0.03, 0.2, jitter),
    "late stamps": Way(0.03, 0.3, late_stamps),
    "rounded stamps": Way(0.1, 1.0, rounding),
    "drift": Way(0.2, 5.0, drift),
    "lost samples": Way(0.002, 0.02, lost),
    "pause": Way(3, 60, pause),
    "doubled stamps": Way(0.005, 0.05, doubled),
    "empty cells": Way(0.005, 0.03, missing),
    DELAY: Way(0.1, 1.0, delay),
}


class Fault(NamedTuple):
    """A way, its size, and the turn in which all ways are taken."""

    way: str
    size: float
    turn: int


def of(index: int) -> Fault:
    """The fault of the set with an index: all ways take turns, small and large."""
    turn, place = divmod(index, len(WAYS))
    way = list(WAYS)[place]
    return Fault(way, WAYS[way].large if turn % 2 else WAYS[way].small, turn)


def worsen(data: Path, name: str, size: float, random: np.random.Generator) -> None:
    """Make the tests of a measurement worse in one way, and declare what its owner would know."""
    file = data / "measured.toml"
    document = tomllib.loads(file.read_text())
    seed, tests = int(random.integers(2**31)), document["measurement"]["test"]
    for number, test in enumerate(tests):
        # One amplifier delays all tests alike.
        own = np.random.default_rng([seed, 0 if name == DELAY else number])
        _write(data / test["file"], WAYS[name].worsened(_read(data / test["file"]), size, own))
    if name == DELAY:
        step = _step(_read(data / tests[0]["file"]))
        channels = document["measurement"]["columns"]
        late = next(channels[each] for each in ("force", "input") if each in channels)
        late["delay_std_ms"] = float(f"{1e3 * size * step:.4g}")
        file.write_text(toml.dumps(document))


def _read(file: Path) -> Columns:
    names = file.read_text().split("\n", 1)[0].split(",")
    return dict(zip(names, np.loadtxt(file, delimiter=",", skiprows=1, unpack=True), strict=True))


def _write(file: Path, columns: Columns) -> None:
    rows = np.column_stack(list(columns.values()))
    lines = [",".join(columns), *(",".join("" if np.isnan(x) else f"{x:.9g}" for x in row) for row in rows)]
    file.write_text("\n".join(lines) + "\n")
