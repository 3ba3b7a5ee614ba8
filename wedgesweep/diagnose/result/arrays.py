"""diagnosis.nc: harmonics and waveforms, measured and simulated, for the figures (SI units)."""

from typing import NamedTuple

import numpy as np
import xarray as xr

from wedgesweep.diagnose.diagnosis import Diagnosis, of_each_kind
from wedgesweep.diagnose.mixed.mixed_data import MixedData
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.result import sampled, stored
from wedgesweep.diagnose.result.stored import BY_MODEL, BY_TEST, Variables
from wedgesweep.diagnose.sampled_data import SampledData
from wedgesweep.diagnose.steady import waveforms
from wedgesweep.diagnose.steady.harmonic_data import HarmonicData
from wedgesweep.sweep import labels

CHANNELS = ("displacement", "velocity")
PARTS = ("harmonic", "part")


class Arrays(NamedTuple):
    """What a diagnosis compares; harmonics are complex, from phase 0 of the input.

    ``fits``: base and extended model; ``measured`` (T, C, H) and ``simulated`` (2, T, C, H) harmonics;
    ``sample_noise`` (T, C): noise of a sample, NaN where a test does not have the channel.
    """

    data: HarmonicData
    fits: tuple[Fit, Fit]
    measured: np.ndarray
    simulated: np.ndarray
    sample_noise: np.ndarray


def dataset(found: Diagnosis) -> xr.Dataset:
    """Arrays of a diagnosis for figures and notebooks; of a mixed measurement, those common to all kinds."""
    data = found.data
    if isinstance(data, SampledData):
        return sampled.dataset(found, data)
    if isinstance(data, MixedData):
        return _overview(found, data)
    arrays = _arrays(found, data)
    variables = {
        **_spectra(arrays),
        **_waveforms(arrays),
        **_inputs(arrays),
        **_energies(arrays),
        **_dwells(arrays),
        **_forces(arrays),
    }
    coordinates = {
        "channel": list(CHANNELS[: data.shape[0]]),
        "harmonic": np.arange(1, data.shape[1] + 1),
        "part": ["real", "imaginary"],
        "phase": np.arange(waveforms.PHASES) / waveforms.PHASES,
    }
    return stored.dataset(found, variables, coordinates, **labels.attributes(data.model))


def parts(found: Diagnosis) -> dict[str, xr.Dataset]:
    """The dataset of each kind of test where there are several."""
    if not isinstance(found.data, MixedData):
        return {}
    return {kind: dataset(part) for kind, part in of_each_kind(found).items()}


def _overview(found: Diagnosis, data: MixedData) -> xr.Dataset:
    """Misfit of all tests of several kinds."""
    kinds = [part.kind for part in data.present for _ in part.names]
    return stored.dataset(found, {}, {"test_kind": (BY_TEST, kinds)}, kind=data.kind)


def _arrays(found: Diagnosis, data: HarmonicData) -> Arrays:
    fits = (found.base.fit, found.extended)
    sample_noise = np.full((data.tests, data.shape[0]), np.nan)
    for row, spectrum in zip(sample_noise, data.spectra, strict=True):
        row[: spectrum.sample_noise.size] = spectrum.sample_noise
    simulated = np.array([fit.evaluation.response.harmonics for fit in fits])[..., : data.shape[1]]
    return Arrays(data, fits, waveforms.measured_from_phase_zero(data, fits[1]), simulated, sample_noise)


def _where_measured(arrays: Arrays, values: np.ndarray) -> np.ndarray:
    """Values (T, C, ...) with NaN for channels that a test does not have."""
    return np.where(np.isnan(arrays.sample_noise)[..., None], np.nan, values)


def _spectra(arrays: Arrays) -> Variables:
    weight = arrays.data.weight[..., : arrays.data.shape[1]]
    noise = np.where(weight > 0.0, 1.0 / np.where(weight > 0.0, weight, 1.0), np.nan)
    measured = _parts(_where_measured(arrays, arrays.measured))
    simulated = _parts(arrays.simulated)
    return {
        "measured_harmonics": (("test", "channel", *PARTS), measured, "m or m/s", "measured harmonics"),
        "noise_std": (
            ("test", "channel", "harmonic"),
            noise,
            "m or m/s",
            "noise of a real part of a harmonic",
        ),
        "simulated_harmonics": ((*BY_MODEL, "channel", *PARTS), simulated, "m or m/s", "simulated harmonics"),
    }


def _waveforms(arrays: Arrays) -> Variables:
    measured, simulated = waveforms.waveform(arrays.measured), waveforms.waveform(arrays.simulated)
    measured = _where_measured(arrays, measured)
    one_period = ("channel", "phase")
    return {
        "measured_waveform": (("test", *one_period), measured, "m or m/s", "measured over one period"),
        "simulated_waveform": ((*BY_MODEL, *one_period), simulated, "m or m/s", "simulated over one period"),
        "waveform_noise": (("test", "channel"), arrays.sample_noise, "m or m/s", "noise of one sample"),
        "measured_peak_to_peak": (
            BY_TEST,
            waveforms.peak_to_peak(measured[:, 0]),
            "m",
            "measured peak to peak",
        ),
        "simulated_peak_to_peak": (
            BY_MODEL,
            waveforms.peak_to_peak(simulated[:, :, 0]),
            "m",
            "simulated peak to peak",
        ),
    }


def _inputs(arrays: Arrays) -> Variables:
    data = arrays.data
    fitted = np.array([data.inputs_of(fit.model.scenario(fit.point)) for fit in arrays.fits])
    unit = "N" if data.model.forced else "m"
    return {
        "frequency": (BY_TEST, data.omega / (2.0 * np.pi), "Hz", "input frequency"),
        "amplitude": (BY_TEST, data.amplitude, unit, "input amplitude as stated"),
        "amplitude_fitted": (BY_MODEL, fitted, unit, "input amplitude as fitted"),
    }


def _energies(arrays: Arrays) -> Variables:
    known = ~np.isnan(arrays.data.amplitude)
    measured = np.where(
        known, waveforms.input_energy(arrays.data, arrays.fits[1], arrays.measured[:, 0, 0]), np.nan
    )
    simulated = np.array(
        [
            waveforms.input_energy(arrays.data, fit, fit.evaluation.response.harmonics[:, 0, 0])
            for fit in arrays.fits
        ]
    )
    meaning = "energy that the input puts in per period"
    return {
        "measured_energy": (BY_TEST, measured, "J", f"{meaning}, measured"),
        "simulated_energy": (BY_MODEL, simulated, "J", f"{meaning}, simulated"),
    }


def _dwells(arrays: Arrays) -> Variables:
    measured, *simulated = (
        waveforms.dwell(waveforms.waveform(waveforms.velocity(arrays.data, each)))
        for each in (arrays.measured, *arrays.simulated)
    )
    meaning = "share of the period near rest"
    return {
        "measured_plateau": (BY_TEST, measured, "1", f"{meaning}, measured"),
        "simulated_plateau": (BY_MODEL, np.array(simulated), "1", f"{meaning}, simulated"),
    }


def _forces(arrays: Arrays) -> Variables:
    base = arrays.fits[0]
    force = waveforms.residual_force(arrays.data, base, waveforms.measured_from_phase_zero(arrays.data, base))
    body = "mass" if arrays.data.model.system == "oscillator" else "bolster"
    return {
        "leftover_force": (("test", "phase"), force, "N", f"force on the {body} that the base model lacks")
    }


def _parts(values: np.ndarray) -> np.ndarray:
    return np.stack([values.real, values.imag], axis=-1)
