"""The sweeps on which the claims are checked, and single cases that none of them holds."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from math import nan, pi
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from wedgesweep import config, simulate
from wedgesweep.config import Case, Config, from_document
from wedgesweep.errors import MismatchError
from wedgesweep.response import NUMBERS
from wedgesweep.solvers.trajectory import CaseError
from wedgesweep.sweep.run import Progress, Sweep
from wedgesweep.sweep.variables import HARMONICS

CONFIG_NAMES = ("paper", "paper-y0", "breakaway")
# The paper's cases with joints that lift off.
UNILATERAL_NAME = "paper-unilateral"
UNILATERAL = {"suspension": {"joints": "unilateral"}, "solver": {"method": "event-driven"}}
LAWS = ("coulomb", "static-dynamic", "exponential")
MM = 1e3
COMMAND = "make reproduce"
# Relative difference up to which a frequency or an amplitude is the one that is looked for.
SAME = 1e-5
# Changes of a config: keys and values by table.
Changes = Mapping[str, Mapping[str, Any]]


def changed(config: Config, changes: Changes) -> Config:
    """The config with some keys changed; settling periods replace a duration."""
    document = {**config.document, **{name: config.document[name] | changes[name] for name in changes}}
    if "settle_periods" in changes.get("solver", {}):
        document["solver"] = {key: value for key, value in document["solver"].items() if key != "duration_s"}
    return from_document(document)


def by_law(numbers: Iterable[float], digits: str = ".3f") -> str:
    """A number of each law in words."""
    coulomb, static_dynamic, exponential = (
        f"{number:{digits}} ({law})" for number, law in zip(numbers, LAWS, strict=True)
    )
    return f"{coulomb}, {static_dynamic} and {exponential}"


@dataclass(frozen=True)
class Run:
    """The dataset of one config."""

    ds: xr.Dataset

    @cached_property
    def config(self) -> Config:
        return config.parse(self.ds.attrs["config"])

    @property
    def omega_n(self) -> float:
        return float(self.ds.attrs["omega_n"])

    @property
    def resonance(self) -> float:
        """Frictionless resonance over omega_n."""
        return float(self.ds.attrs["frictionless_resonance"]) / self.omega_n

    @property
    def onset(self) -> xr.DataArray:
        """Input amplitude (m) at which set-valued friction begins to slip from rest, over beta."""
        return self.ds.attrs["breakaway_acceleration"] / (self.omega_n * self.ds["beta"]) ** 2

    def law(self, name: str) -> xr.Dataset:
        """All cases of a law, over beta and amplitude."""
        return self.ds.sel(friction_law=name)

    def beta_of(self, hertz: float) -> float:
        """Frequency ratio of a frequency."""
        return 2.0 * pi * hertz / self.omega_n

    def cases(self, name: str, beta: float) -> xr.Dataset:
        """All cases of a law at a frequency ratio, over amplitude."""
        law = self.law(name)
        return law.isel(beta=_place(law["beta"], beta))

    def case(self, name: str, beta: float, millimetres: float) -> xr.Dataset:
        """One case."""
        cases = self.cases(name, beta)
        return cases.isel(amplitude=_place(cases["amplitude"], millimetres / MM))

    def ratios(self, beta: float, millimetres: float) -> list[float]:
        """Amplitude ratio of one case under each law."""
        return [self.number("amplitude_ratio", law, beta, millimetres) for law in LAWS]

    def number(self, variable: str, name: str, beta: float, millimetres: float) -> float:
        """One variable of one case, in SI units."""
        return float(self.case(name, beta, millimetres)[variable])


def distortion(case: xr.Dataset) -> xr.DataArray:
    """Root sum of squares of the higher harmonics of the displacement over the fundamental."""
    parts = case["displacement_harmonics"]
    squared = (parts**2).sum("part", skipna=False)
    higher = squared.isel(harmonic=slice(1, None)).sum("harmonic", skipna=False)
    fundamental = squared.isel(harmonic=0)
    return (higher / fundamental.where(fundamental > 0.0)) ** 0.5


def _place(coordinate: xr.DataArray, wanted: float) -> int:
    """Index of a value of a coordinate; KeyError if it is not there."""
    place = int(np.abs(coordinate.values - wanted).argmin())
    if abs(coordinate.values[place] - wanted) > SAME * wanted:
        raise KeyError(f"no {coordinate.name} = {wanted:g} in the dataset")
    return place


@dataclass(frozen=True)
class Runs:
    """Table 1 as printed, with springs scaled to the paper's y_0, and over the range of the experiment.

    ``unilateral``: Table 1 as printed with joints that lift off.
    """

    paper: Run
    scaled: Run
    breakaway: Run
    unilateral: Run

    @property
    def named(self) -> dict[str, Run]:
        every = (self.paper, self.scaled, self.breakaway, self.unilateral)
        return dict(zip((*CONFIG_NAMES, UNILATERAL_NAME), every, strict=True))

    @property
    def with_unilateral_joints(self) -> "Runs":
        """The runs with joints that lift off in place of the paper's."""
        return replace(self, paper=self.unilateral)


def obtain(
    directory: Path, configs: Path, n_jobs: int, report: Callable[[str], None], progress: Progress
) -> Runs:
    """Run the sweeps that ``directory`` lacks."""
    directory.mkdir(parents=True, exist_ok=True)
    studies = {name: config.load(configs / f"{name}.toml") for name in CONFIG_NAMES}
    studies[UNILATERAL_NAME] = changed(studies["paper"], UNILATERAL)
    sweeps = [Sweep(study, directory / f"{name}.nc", COMMAND) for name, study in studies.items()]
    return Runs(*(_obtain(sweep, n_jobs, report, progress) for sweep in sweeps))


def _obtain(sweep: Sweep, n_jobs: int, report: Callable[[str], None], progress: Progress) -> Run:
    try:
        stored = sweep.stored()
        if stored is not None:
            report(f"{sweep.out}: kept from an earlier run")
            return Run(stored)
        report(f"{sweep.out}: {sweep.config.title}")
        return Run(sweep.run(n_jobs, progress=progress))
    except MismatchError as error:  # results of another version or config
        report(f"{error}; running it again")
        return Run(sweep.run(n_jobs, progress=progress, fresh=True))


def mirrored_columns(config: Config) -> dict[str, dict[str, float]]:
    """The change that mirrors the column angle."""
    return {"suspension": {"column_angle_deg": -config.document["suspension"]["column_angle_deg"]}}


def record(config: Config, law: str, beta: float, millimetres: float) -> np.ndarray:
    """Parameter record of a case, shape (1,)."""
    return config.record(Case(law, beta, millimetres / MM))


def single(run: Run, law: str, beta: float, millimetres: float, changes: Changes) -> dict[str, float]:
    """Numbers (see response.NUMBERS, SI) of a case of the run's config with some changes.

    All are NaN if the case fails, so that no criterion holds.
    """
    config = changed(run.config, changes)
    try:
        found, _ = simulate.respond(record(config, law, beta, millimetres), config.solver, HARMONICS)
    except CaseError:
        return dict.fromkeys(NUMBERS.names or (), nan)
    return found.numbers
