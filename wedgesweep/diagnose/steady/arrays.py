"""Harmonics and waveforms of steady tests, measured and simulated, for the figures (SI units)."""

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from wedgesweep.diagnose.fit_data import BY_MODEL, BY_TEST, Arrays, Variables
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.steady import waveforms

if TYPE_CHECKING:
    from wedgesweep.diagnose.steady.harmonic_data import HarmonicData

CHANNELS = ("displacement", "velocity")
PARTS = ("harmonic", "part")


class Compared(NamedTuple):
    """What a diagnosis compares; harmonics are complex, from phase 0 of the input.

    ``fits``: base and extended model; ``measured`` (T, C, H) and ``simulated`` (2, T, C, H) harmonics;
    ``sample_noise`` (T, C): noise of a sample, NaN where a test does not have the channel.
    """

    data: "HarmonicData"
    fits: tuple[Fit, Fit]
    measured: np.ndarray
    simulated: np.ndarray
    sample_noise: np.ndarray


def arrays(data: "HarmonicData", base: Fit, extended: Fit) -> Arrays:
    """Arrays of steady tests with both models."""
    compared = _compared(data, (base, extended))
    variables = {
        **_spectra(compared),
        **_waveforms(compared),
        **_inputs(compared),
        **_energies(compared),
        **_dwells(compared),
        **_forces(compared),
    }
    coordinates = {
        "channel": list(CHANNELS[: data.shape[0]]),
        "harmonic": np.arange(1, data.shape[1] + 1),
        "part": ["real", "imaginary"],
        "phase": np.arange(waveforms.PHASES) / waveforms.PHASES,
    }
    return Arrays(variables, coordinates)


def _compared(data: "HarmonicData", fits: tuple[Fit, Fit]) -> Compared:
    sample_noise = np.full((data.tests, data.shape[0]), np.nan)
    for row, spectrum in zip(sample_noise, data.spectra, strict=True):
        row[: spectrum.sample_noise.size] = spectrum.sample_noise
    simulated = np.array([fit.evaluation.response.harmonics for fit in fits])[..., : data.shape[1]]
    return Compared(data, fits, waveforms.measured_from_phase_zero(data, fits[1]), simulated, sample_noise)


def _where_measured(compared: Compared, values: np.ndarray) -> np.ndarray:
    """Values (T, C, ...) with NaN for channels that a test does not have."""
    return np.where(np.isnan(compared.sample_noise)[..., None], np.nan, values)


def _spectra(compared: Compared) -> Variables:
    weight = compared.data.weight[..., : compared.data.shape[1]]
    noise = np.where(weight > 0.0, 1.0 / np.where(weight > 0.0, weight, 1.0), np.nan)
    measured = _parts(_where_measured(compared, compared.measured))
    simulated = _parts(compared.simulated)
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


def _waveforms(compared: Compared) -> Variables:
    measured, simulated = waveforms.waveform(compared.measured), waveforms.waveform(compared.simulated)
    measured = _where_measured(compared, measured)
    one_period = ("channel", "phase")
    return {
        "measured_waveform": (("test", *one_period), measured, "m or m/s", "measured over one period"),
        "simulated_waveform": ((*BY_MODEL, *one_period), simulated, "m or m/s", "simulated over one period"),
        "waveform_noise": (("test", "channel"), compared.sample_noise, "m or m/s", "noise of one sample"),
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


def _inputs(compared: Compared) -> Variables:
    data = compared.data
    fitted = np.array([data.inputs_of(fit.model.scenario(fit.point)) for fit in compared.fits])
    unit = "N" if data.model.forced else "m"
    return {
        "frequency": (BY_TEST, data.omega / (2.0 * np.pi), "Hz", "input frequency"),
        "amplitude": (BY_TEST, data.amplitude, unit, "input amplitude as stated"),
        "amplitude_fitted": (BY_MODEL, fitted, unit, "input amplitude as fitted"),
    }


def _energies(compared: Compared) -> Variables:
    known = ~np.isnan(compared.data.amplitude)
    measured = np.where(
        known, waveforms.input_energy(compared.data, compared.fits[1], compared.measured[:, 0, 0]), np.nan
    )
    simulated = np.array(
        [
            waveforms.input_energy(compared.data, fit, fit.evaluation.response.harmonics[:, 0, 0])
            for fit in compared.fits
        ]
    )
    meaning = "energy that the input puts in per period"
    return {
        "measured_energy": (BY_TEST, measured, "J", f"{meaning}, measured"),
        "simulated_energy": (BY_MODEL, simulated, "J", f"{meaning}, simulated"),
    }


def _dwells(compared: Compared) -> Variables:
    measured, *simulated = (
        waveforms.dwell(waveforms.waveform(waveforms.velocity(compared.data, each)))
        for each in (compared.measured, *compared.simulated)
    )
    meaning = "share of the period near rest"
    return {
        "measured_plateau": (BY_TEST, measured, "1", f"{meaning}, measured"),
        "simulated_plateau": (BY_MODEL, np.array(simulated), "1", f"{meaning}, simulated"),
    }


def _forces(compared: Compared) -> Variables:
    base = compared.fits[0]
    force = waveforms.residual_force(
        compared.data, base, waveforms.measured_from_phase_zero(compared.data, base)
    )
    body = "mass" if compared.data.model.system == "oscillator" else "bolster"
    return {
        "leftover_force": (("test", "phase"), force, "N", f"force on the {body} that the base model lacks")
    }


def _parts(values: np.ndarray) -> np.ndarray:
    return np.stack([values.real, values.imag], axis=-1)
