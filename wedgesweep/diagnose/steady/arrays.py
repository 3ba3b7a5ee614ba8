"""Harmonics and waveforms of steady tests, measured and simulated, for the figures (SI units)."""

from typing import TYPE_CHECKING

import numpy as np

from wedgesweep.diagnose.fit_data import BY_MODEL, BY_TEST, Arrays, Variables
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.steady import waveforms
from wedgesweep.diagnose.steady.column_load import CHANNEL

if TYPE_CHECKING:
    from wedgesweep.diagnose.steady.harmonic_data import HarmonicData

CHANNELS, UNIT = ("displacement", "velocity"), "m or m/s"
PARTS, PERIOD = ("channel", "harmonic", "part"), ("channel", "phase")


def arrays(data: "HarmonicData", base: Fit, extended: Fit) -> Arrays:
    """Arrays of steady tests with both models; harmonics are from phase 0 of the input."""
    fits = base, extended
    measured = waveforms.measured_from_phase_zero(data, extended)
    simulated = np.array([fit.evaluation.response.harmonics for fit in fits])[:, :, :CHANNEL, : data.shape[1]]
    variables = {
        **_spectra(data, measured, simulated),
        **_waveforms(data, measured, simulated),
        **_inputs(data, fits),
        **_energies(data, fits, measured),
        **_dwells(data, measured, simulated),
        **_forces(data, base),
        **_loads(data, fits),
    }
    coordinates = {
        "channel": list(CHANNELS[: data.shape[0]]),
        "harmonic": np.arange(1, data.shape[1] + 1),
        "part": ["real", "imaginary"],
        "phase": np.arange(waveforms.PHASES) / waveforms.PHASES,
    }
    return Arrays(variables, coordinates)


def _sample_noise(data: "HarmonicData") -> np.ndarray:
    """Noise (T, C) of a sample, NaN where a test does not have the channel."""
    found = np.full((data.tests, min(data.shape[0], CHANNEL)), np.nan)
    for row, spectrum in zip(found, data.spectra, strict=True):
        row[: spectrum.sample_noise.size] = spectrum.sample_noise
    return found


def _where_measured(data: "HarmonicData", values: np.ndarray) -> np.ndarray:
    """Values (T, C, ...) with NaN for channels that a test does not have."""
    return np.where(np.isnan(_sample_noise(data))[..., None], np.nan, values)


def _spectra(data: "HarmonicData", measured: np.ndarray, simulated: np.ndarray) -> Variables:
    weight = data.weight[:, :CHANNEL, : data.shape[1]]
    noise = np.divide(1.0, weight, out=np.full_like(weight, np.nan), where=weight > 0.0)
    seen, meaning = _parts(_where_measured(data, measured)), "noise of a real part of a harmonic"
    return {
        "measured_harmonics": (("test", *PARTS), seen, UNIT, "measured harmonics"),
        "noise_std": (("test", *PARTS[:2]), noise, UNIT, meaning),
        "simulated_harmonics": ((*BY_MODEL, *PARTS), _parts(simulated), UNIT, "simulated harmonics"),
    }


def _waveforms(data: "HarmonicData", measured: np.ndarray, simulated: np.ndarray) -> Variables:
    seen, found = _where_measured(data, waveforms.waveform(measured)), waveforms.waveform(simulated)
    travel = waveforms.peak_to_peak(seen[:, 0]), waveforms.peak_to_peak(found[:, :, 0])
    return {
        "measured_waveform": (("test", *PERIOD), seen, UNIT, "measured over one period"),
        "simulated_waveform": ((*BY_MODEL, *PERIOD), found, UNIT, "simulated over one period"),
        "waveform_noise": (("test", "channel"), _sample_noise(data), UNIT, "noise of one sample"),
        "measured_peak_to_peak": (BY_TEST, travel[0], "m", "measured peak to peak"),
        "simulated_peak_to_peak": (BY_MODEL, travel[1], "m", "simulated peak to peak"),
    }


def _inputs(data: "HarmonicData", fits: tuple[Fit, Fit]) -> Variables:
    fitted = np.array([data.inputs_of(fit.model.scenario(fit.point)) for fit in fits])
    unit = "N" if data.model.forced else "m"
    return {
        "frequency": (BY_TEST, data.omega / (2.0 * np.pi), "Hz", "input frequency"),
        "amplitude": (BY_TEST, data.amplitude, unit, "input amplitude as stated"),
        "amplitude_fitted": (BY_MODEL, fitted, unit, "input amplitude as fitted"),
    }


def _energies(data: "HarmonicData", fits: tuple[Fit, Fit], measured: np.ndarray) -> Variables:
    seen = waveforms.input_energy(data, fits[1], measured[:, 0, 0])
    seen = np.where(np.isnan(data.amplitude), np.nan, seen)
    responses = [fit.evaluation.response.harmonics[:, 0, 0] for fit in fits]
    found = [waveforms.input_energy(data, *each) for each in zip(fits, responses, strict=True)]
    meaning = "energy that the input puts in per period"
    return {
        "measured_energy": (BY_TEST, seen, "J", f"{meaning}, measured"),
        "simulated_energy": (BY_MODEL, np.array(found), "J", f"{meaning}, simulated"),
    }


def _dwells(data: "HarmonicData", measured: np.ndarray, simulated: np.ndarray) -> Variables:
    seen, *found = (
        waveforms.dwell(waveforms.waveform(waveforms.velocity(data, each))) for each in (measured, *simulated)
    )
    meaning = "share of the period near rest"
    return {
        "measured_plateau": (BY_TEST, seen, "1", f"{meaning}, measured"),
        "simulated_plateau": (BY_MODEL, np.array(found), "1", f"{meaning}, simulated"),
    }


def _forces(data: "HarmonicData", base: Fit) -> Variables:
    force = waveforms.residual_force(data, base, waveforms.measured_from_phase_zero(data, base))
    body = "mass" if data.model.system == "oscillator" else "bolster"
    meaning = f"force on the {body} that the base model lacks"
    return {"leftover_force": (("test", "phase"), force, "N", meaning)}


def _loads(data: "HarmonicData", fits: tuple[Fit, Fit]) -> Variables:
    """The load of the column over a period; NaN where it is not compared."""
    if not data.loads:
        return {}
    phase = fits[1].evaluation.response.phase
    seen = _load_waveform(data.rotated(data.measured, -phase))
    found = [_load_waveform(fit.evaluation.response.harmonics) for fit in fits]
    there = np.array([each is not None for each in data.loads])[:, None]
    return {
        "measured_load": (
            ("test", "phase"),
            np.where(there, seen, np.nan),
            "N",
            "measured load of the column",
        ),
        "simulated_load": ((*BY_MODEL, "phase"), np.where(there, found, np.nan), "N", "simulated load"),
    }


def _load_waveform(harmonics: np.ndarray) -> np.ndarray:
    """Load (..., T, PHASES) of harmonics (..., T, C, H), its mean last."""
    load = harmonics[..., CHANNEL, :]
    return waveforms.waveform(load[..., :-1]) + load[..., -1:].real


def _parts(values: np.ndarray) -> np.ndarray:
    return np.stack([values.real, values.imag], axis=-1)
