"""The Python interface: what the commands do, as functions for scripts and notebooks.

``import wedgesweep as ws`` offers them all, and loads what they need when they are first used.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from math import inf
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import TYPE_CHECKING, Any

from wedgesweep import config as configs
from wedgesweep import figures, measured
from wedgesweep.config import Config, variants
from wedgesweep.effects import EFFECTS, candidates
from wedgesweep.errors import InputError, SweepError
from wedgesweep.files import NETCDF, mismatch
from wedgesweep.hints import hint
from wedgesweep.measured import Measurement
from wedgesweep.sweep.backend import count_jobs
from wedgesweep.sweep.run import Progress, Sweep

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from wedgesweep.diagnosis_result import DiagnosisResult


def load_config(source: str | Path | Mapping[str, Any]) -> Config:
    """Read and check a config.

    Parameters
    ----------
    source : str, Path or mapping
        A TOML file, or its content as a mapping of tables. ``wedgesweep init`` writes a file with every
        key; the ending of a key names its unit. Only the table ``sweep`` must be given.

    Returns
    -------
    Config
        The checked config with every default filled in: ``config.to_toml()`` shows it.

    Raises
    ------
    ConfigError
        The config cannot run; the message lists everything that is wrong with it.

    Examples
    --------
    >>> import wedgesweep as ws
    >>> config = ws.load_config({"sweep": {"friction_law": "coulomb", "beta": 0.8, "amplitude_mm": [1, 2]}})
    >>> len(config.case_list())
    2
    """
    if isinstance(source, Mapping):
        return configs.from_document(source)
    return configs.load(source)


def simulate_case(
    config: Config,
    *,
    amplitude_mm: float | None = None,
    amplitude_N: float | None = None,
    beta: float | None = None,
    frequency_hz: float | None = None,
    law: str | None = None,
) -> xr.Dataset:
    """Simulate one case in this process.

    Parameters
    ----------
    config : Config
        The suspension or oscillator, its effects and the solver; the cases of its sweep are not run.
    amplitude_mm : float
        Input amplitude of the side frame or base (mm; mrad of a rotation).
    amplitude_N : float
        Amplitude of the force (N), if the config's sweep says ``excitation = "force"``.
    beta, frequency_hz : float
        Input frequency: either its ratio to omega_n, or in Hz.
    law : str, optional
        Friction law; the config's first by default.

    Returns
    -------
    xarray.Dataset
        The dataset of a sweep (SI units) with dimensions friction_law, beta and amplitude of size 1. It holds
        the waveforms of the kept periods. A case that fails is no exception: its ``status`` is not 0, and
        ``message`` says why.

    Raises
    ------
    ConfigError
        A value is out of range, or ``beta`` and ``frequency_hz``, or both amplitudes, are both given or both
        missing.

    References
    ----------
    Numerical investigation on the friction wedge damper dynamics - a comparative study.

    Examples
    --------
    >>> import wedgesweep as ws
    >>> config = ws.load_config("configs/quick.toml")  # doctest: +SKIP
    >>> case = ws.simulate_case(config, law="coulomb", beta=0.8, amplitude_mm=1.0)  # doctest: +SKIP
    >>> case["amplitude_ratio"].item()  # doctest: +SKIP
    """
    single = variants.single_case(config, amplitude_mm, beta, frequency_hz, law, amplitude_N)
    return Sweep(single, Path("case.nc"), "wedgesweep.simulate_case").run_here()


def run_sweep(
    config: Config,
    out: str | Path | None = None,
    *,
    n_jobs: int | None = None,
    progress: Progress | None = None,
    fail_fast: bool = False,
    fresh: bool = False,
) -> xr.Dataset:
    """Run all cases of a config.

    Parameters
    ----------
    config : Config
        The cases and how to solve them.
    out : str or Path, optional
        netCDF file of the dataset. Finished cases are stored beside it at once: after an interruption the
        same call resumes the sweep, and a complete sweep is read, not run again. Without ``out`` nothing is
        stored.
    n_jobs : int, optional
        Number of cases solved at a time; one per processor by default.
    progress : callable, optional
        Called as ``progress(records, total)`` whenever cases finish: their records, shape (n,), and the
        number of all cases.
    fail_fast : bool
        Stop at the first case that fails; by default a failed case is data, with its ``status`` and
        ``message``.
    fresh : bool
        Discard what earlier runs left in ``out``.

    Returns
    -------
    xarray.Dataset
        One value or waveform per case in SI units, over friction_law, beta and amplitude, over case if the
        config lists its cases, or over friction_law and scale if it has an [input].

    Raises
    ------
    MismatchError
        ``out`` holds a sweep of another config or version.
    SweepError
        The sweep cannot start or be stored; as CaseFailedError: a case failed and ``fail_fast`` was asked
        for.

    Examples
    --------
    >>> import wedgesweep as ws
    >>> ds = ws.run_sweep(ws.load_config("configs/quick.toml"), "quick.nc")  # doctest: +SKIP
    """
    if out is None:
        with TemporaryDirectory() as directory:
            return run_sweep(
                config, Path(directory, "sweep.nc"), n_jobs=n_jobs, progress=progress, fail_fast=fail_fast
            )
    if problem := mismatch(Path(out), NETCDF):
        raise SweepError(problem)
    sweep = Sweep(config, Path(out), "wedgesweep.run_sweep")
    stored = None if fresh else sweep.stored()
    if stored is not None:
        return stored
    return sweep.run(
        count_jobs(n_jobs),
        progress=progress or (lambda records, total: None),
        fail_fast=fail_fast,
        fresh=fresh,
    )


def engineering(ds: xr.Dataset) -> xr.Dataset:
    """Add the engineer's quantities to the dataset of a sweep: loads, friction forces, losses, unloading.

    Parameters
    ----------
    ds : xarray.Dataset
        From ``run_sweep`` or ``simulate_case``, of a suspension; cases may have been selected.

    Returns
    -------
    xarray.Dataset
        The same with the quantities of docs/api.md, a number for each case in SI units. Unloading needs
        waveforms, losses a cycle an input that repeats. NaN: a case failed, nothing moves, or (friction
        forces) the wedges lock.

    Raises
    ------
    ValueError
        The dataset is one of an oscillator.

    Examples
    --------
    >>> import wedgesweep as ws
    >>> ds = ws.engineering(ws.run_sweep(ws.load_config("configs/wear.toml")))  # doctest: +SKIP
    >>> ds["relative_friction"].sel(wear_mm=6.0)  # doctest: +SKIP
    """
    from wedgesweep import engineering_quantities

    return engineering_quantities.engineering(ds)


def read_measurement(path: str | Path, model: str | Path | None = None) -> Measurement:
    """Read measured vibration, and the model that it is to be compared with.

    Parameters
    ----------
    path : str or Path
        A measured.toml, which names the files of the tests.
    model : str or Path, optional
        Config of the base model, instead of the one that the measurement names.

    Returns
    -------
    Measurement
        The base model and the tests, with samples in SI units.

    Raises
    ------
    MeasuredError
        The data cannot be used; the message lists everything that is wrong with them.
    """
    return measured.read(Path(path), None if model is None else Path(model))


def diagnose_measurement(
    measurement: Measurement,
    *,
    effects: Sequence[str] | None = None,
    n_jobs: int | None = None,
    progress: Callable[[str], None] | None = None,
    calibrate: bool = False,
    time_limit_s: float = inf,
    reached: Callable[[DiagnosisResult], None] | None = None,
) -> DiagnosisResult:
    """Find what the base model of a measurement misses, or say why that cannot be found.

    Parameters
    ----------
    measurement : Measurement
        From ``read_measurement``.
    effects : sequence of str, optional
        Names of the candidates; all effects by default. With "empirical_force" among them the missing force
        is fitted as a table whatever the verdict is; without only where no name explains it.
    n_jobs : int, optional
        Number of threads; one per processor by default.
    progress : callable, optional
        Called with a short text at each step.
    calibrate : bool
        Take the thresholds of the verdict from simulations of these tests (minutes), not the general ones.
    time_limit_s : float, optional
        The fits end after this time (s), and the result is what was found by then: ``document["unfinished"]``
        lists the steps without a result. The base model is always fitted.
    reached : callable, optional
        Called with the result so far after the fit of the base model and after each later step.

    Returns
    -------
    DiagnosisResult
        After an interrupt or the time limit, what was found by then.
        ``verdict``, ``causes``, the whole content of diagnosis.json (``document``) and the data behind it
        (``data``, SI units). ``write(directory)`` stores them as ``wedgesweep diagnose`` does.

    Raises
    ------
    InputError
        One of ``effects`` is unknown, or there is none.

    Examples
    --------
    >>> import wedgesweep as ws
    >>> found = ws.diagnose_measurement(ws.read_measurement("measured.toml"))  # doctest: +SKIP
    >>> found.verdict, [cause["effect"] for cause in found.causes]  # doctest: +SKIP
    """
    from wedgesweep.diagnose import diagnosis
    from wedgesweep.diagnose.result import result_of

    began = perf_counter()
    found = diagnosis.diagnose(
        measurement,
        _candidates(effects),
        count_jobs(n_jobs),
        progress or (lambda step: None),
        calibrate,
        reached=(lambda found: reached(result_of(found))) if reached else (lambda found: None),
        time_used=lambda: (perf_counter() - began) / time_limit_s,
    )
    return result_of(found)


def _candidates(effects: Sequence[str] | None) -> tuple[str, ...]:
    if effects is None:
        return candidates()
    unknown = [
        f"effects: unknown effect {name}; {hint(name, EFFECTS)}" for name in effects if name not in EFFECTS
    ]
    if unknown or not effects:
        raise InputError(unknown or [f"effects: empty; valid here: {', '.join(EFFECTS)}"])
    return tuple(effects)


def plot(
    data: xr.Dataset | DiagnosisResult, figure_name: str, ax: Axes | None = None, **picks: Any
) -> Figure:
    """Draw one figure of a dataset or of a diagnosis.

    Parameters
    ----------
    data : xarray.Dataset or DiagnosisResult
        From ``run_sweep`` or ``simulate_case``, or from ``diagnose_measurement``.
    figure_name : str
        One of the names that ``wedgesweep plot --help`` lists.
    ax : matplotlib.axes.Axes, optional
        Axes to draw into, for a figure with a single panel; a new figure by default.
    **picks
        What to draw of the data, where the figure offers it: ``law``, ``beta``, ``amplitude`` (m) or
        ``amplitudes`` (m); the nearest values that the data hold are drawn.

    Returns
    -------
    matplotlib.figure.Figure
        The figure drawn into.

    Raises
    ------
    ValueError
        There is no such figure, or these data do not suit it.
    """
    return figures.draw(data, figure_name, ax=ax, **picks)
