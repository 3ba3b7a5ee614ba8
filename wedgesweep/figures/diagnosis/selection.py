"""Which tests a figure of a diagnosis shows, in which order, their labels, and a period of their motion."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr

from wedgesweep import formatting
from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.figures import style

TESTS_SHOWN = 6  # tests in a figure by default, those with the largest misfit


def by_misfit(data: xr.Dataset) -> np.ndarray:
    """Return indices of the tests, the base model's largest misfit per degree of freedom first."""
    ratio = (data["q"].sel(model="base") / data["dof"]).values
    return np.argsort(-np.nan_to_num(ratio, nan=np.inf), kind="stable")


def choose(result: DiagnosisResult, tests: Sequence[int] | None) -> np.ndarray:
    """Return indices of the tests asked for, or of those with the largest misfit."""
    return by_misfit(result.data)[:TESTS_SHOWN] if tests is None else np.asarray(tests, int)


def by_frequency(data: xr.Dataset) -> np.ndarray:
    """Return indices of the tests by amplitude and then frequency, as a bench would run them."""
    if "frequency" not in data:
        return np.arange(data.sizes["test"])
    amplitude = data["amplitude_fitted"].sel(model="extended").values
    return np.lexsort((data["frequency"].values, np.round(np.log(amplitude), 1)))


def label(data: xr.Dataset, test: int) -> str:
    """Name, frequency and input amplitude of a test; ~ marks an amplitude that was only fitted."""
    if "frequency" not in data:
        return str(data["test"].values[test])
    stated = data["amplitude"].values[test]
    fitted = data["amplitude_fitted"].sel(model="extended").values[test]
    size = amplitude(data, stated, 3) if np.isfinite(stated) else f"~{amplitude(data, fitted, 2)}"
    return f"{data['test'].values[test]}: {data['frequency'].values[test]:.4g} Hz, {size}"


def amplitude(data: xr.Dataset, value: float, digits: int) -> str:
    """Write an input amplitude (m or N) with its unit."""
    if data["amplitude"].attrs.get("units", "m").startswith("N"):
        return f"{value:.{digits}g} N"
    return f"{value * style.MM:.{digits}g} mm"


def errors(result: DiagnosisResult, test: int) -> str:
    """Name of a test, and the error of each model as a share of the response."""
    row = result.document["misfit"]["tests"][test]
    told = " → ".join(formatting.error(row[f"error_{model}"]) for model in result.models)
    return f"{label(result.data, test)}\nerror {told}"


def misfit_label(result: DiagnosisResult, test: int) -> str:
    """Misfit per degree of freedom of each model in a test."""
    ratios = [result.data["q"].sel(model=model) / result.data["dof"] for model in result.models]
    return "Q/dof " + " → ".join(formatting.number(ratio.values[test]) for ratio in ratios)


class Motion(NamedTuple):
    """Relative displacement (m) and velocity (m/s) over one period of the input."""

    displacement: np.ndarray
    velocity: np.ndarray


def motion(data: xr.Dataset, waveform: xr.DataArray, test: int) -> Motion:
    """Return the motion of a test; its velocity is differentiated where there is no such channel."""
    one = waveform.isel(test=test)
    displacement = one.sel(channel="displacement").values
    if "velocity" in data["channel"].values:
        velocity = one.sel(channel="velocity").values
        if np.isfinite(velocity).all():
            return Motion(displacement, velocity)
    return Motion(displacement, _rate(data, displacement, test))


def closed(values: np.ndarray) -> np.ndarray:
    """Repeat the first sample of a period at its end."""
    return np.append(values, values[:1])


def _rate(data: xr.Dataset, displacement: np.ndarray, test: int) -> np.ndarray:
    """Differentiate one period of a displacement (m); m/s."""
    orders = np.fft.rfftfreq(displacement.size, 1.0 / displacement.size)
    turn = 2j * np.pi * data["frequency"].values[test] * orders
    return np.fft.irfft(turn * np.fft.rfft(displacement), displacement.size)
