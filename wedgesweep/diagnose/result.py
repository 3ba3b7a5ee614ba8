"""What a diagnosis leaves behind: diagnosis.json, diagnosis.nc and extended.toml."""

import json
import os
from datetime import UTC, datetime
from math import exp, inf, isfinite, log, sqrt
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from wedgesweep import __version__
from wedgesweep.config import toml
from wedgesweep.diagnose import waveforms
from wedgesweep.diagnose.diagnosis import Diagnosis
from wedgesweep.diagnose.gain import Gain
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.next_test import ENOUGH
from wedgesweep.diagnose.search import PENALTY, TONE_FREQUENCY, Explanation
from wedgesweep.diagnose.verdict import ADEQUATE, where_it_shows
from wedgesweep.effects import EFFECTS
from wedgesweep.quantity import Quantity

# 95 % of a normal distribution.
TWO_SIDED = 1.959964
JSON, DATASET, EXTENDED = "diagnosis.json", "diagnosis.nc", "extended.toml"
CHANNELS = ("displacement", "velocity")


def write(found: Diagnosis, directory: Path) -> None:
    """Write all three files; each is whole or not there."""
    directory.mkdir(parents=True, exist_ok=True)
    dataset_file = directory / f".{DATASET}.partial"
    dataset(found).to_netcdf(dataset_file)
    dataset_file.replace(directory / DATASET)
    _write_text(directory / EXTENDED, extended(found))
    _write_text(directory / JSON, json.dumps(document(found), indent=2, allow_nan=False) + "\n")


def _write_text(file: Path, text: str) -> None:
    partial = file.with_name(f".{file.name}.partial")
    partial.write_text(text, encoding="utf-8")
    os.replace(partial, file)


def parameters(fit: Fit) -> dict[str, dict[str, dict[str, Any]]]:
    """Fitted numbers of every effect with their 95 % intervals, in key units.

    Symmetric in the fit's coordinate: a number that is fitted as a logarithm has the interval of that. No
    interval reaches beyond the range that was searched: of what lies there the fit knows nothing.
    """
    hypothesis, size = fit.model.hypothesis, fit.model.size
    x, covariance = fit.x[:size], fit.covariance[:size, :size]
    here = hypothesis.in_key_units(x)
    step = 1e-5 * hypothesis.width
    moved = [hypothesis.in_key_units(x + step * row) for row in np.eye(size)]
    found: dict[str, dict[str, dict[str, Any]]] = {}
    for name in hypothesis.effects:
        found[name] = {}
        for quantity in EFFECTS[name].quantities:
            if quantity.search:
                value = here[name][quantity.key]
                slope = np.array([_change(quantity, value, m[name][quantity.key]) for m in moved]) / step
                std = sqrt(max(float(slope @ covariance @ slope), 0.0))
                if f"{name}.{quantity.key}" == TONE_FREQUENCY:
                    std = _change(quantity, value, value + fit.model.problem.tone_std)
                half = TWO_SIDED * std
                ends = _interval(quantity, value, half)
                found[name][quantity.key] = {"value": _finite(value), "ci95": [_finite(end) for end in ends]}
    return found


def _change(quantity: Quantity, value: float, moved: float) -> float:
    """Change of a number in the coordinate in which it is fitted."""
    if quantity.logarithmic:
        return log(moved / value)
    return quantity.nearest(moved, value) - value


def _interval(quantity: Quantity, value: float, half: float) -> tuple[float, float]:
    """Ends of an interval of half a width ``half`` in the coordinate in which a number is fitted."""
    low, high = quantity.search or (-inf, inf)
    if quantity.angle:
        half = min(half, 0.5 * (high - low))
        return value - half, value + half
    if quantity.logarithmic:
        half = min(half, log(high / low))
        return max(value * exp(-half), low), min(value * exp(half), high)
    return max(value - half, low), min(value + half, high)


def causes(each: Explanation | None) -> list[dict[str, Any]]:
    """The causes of an explanation as DIAGNOSIS.md wants them."""
    if each is None:
        return []
    numbers = parameters(each.fit)
    return [
        {
            "effect": name,
            "family": EFFECTS[name].family,
            "branch": EFFECTS[name].branch,
            "parameters": numbers[name],
        }
        for name in each.effects
    ]


def document(found: Diagnosis) -> dict[str, Any]:
    """The content of diagnosis.json."""
    finding, problem, base = found.finding, found.problem, found.base
    best = finding.best or base
    following = found.next_test
    return {
        "verdict": finding.verdict,
        "causes": causes(finding.cause),
        "rivals": [
            {"effects": list(each.effects), "gap": _finite(each.penalised - best.penalised)}
            for each in finding.rivals
        ],
        "misfit": {
            "chi2_base": _finite(base.fit.q),
            "chi2_extended": _finite(best.fit.q),
            "dof": base.fit.dof,
            "dof_extended": best.fit.dof,
            "excess_base": _finite(base.fit.excess),
            "p_base": _finite(base.fit.p),
            "p_extended": _finite(best.fit.p),
            "p_where_it_shows": _finite(where_it_shows(base.fit, best.fit)),
            "tests": _tests(found),
        },
        "gain": _gain(found.gain),
        "detectable": {
            score.effect: {score.key: _finite(score.detectable)} for score in found.scores if score.testable
        },
        "not_testable": [score.effect for score in found.scores if not score.testable],
        "next_test": following
        and {
            "frequency_hz": following.frequency,
            "amplitude_mm": 1e3 * following.amplitude,
            "separates": list(following.separates),
            "distance": following.distance,
        },
        "extended": list(best.effects),
        "title": found.measurement.title,
        "model": {"law": problem.law, "title": problem.model.title},
        "uncertain": _uncertain(best.fit),
        "version": __version__,
        "created": datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ"),
        "method": {
            "penalty_per_parameter": PENALTY + log(problem.points.sum()),
            "gap": found.thresholds.gap,
            "enough_distance": ENOUGH,
            "strong_excess": _finite(found.thresholds.strong),
            "adequate_p": ADEQUATE,
            "least_gain": found.thresholds.least_gain,
            "dof": base.fit.dof,
            "harmonics": problem.shape[1],
            "calibrated": found.calibration,
        },
        "candidates": _candidates(found),
    }


def _tests(found: Diagnosis) -> list[dict[str, Any]]:
    problem, base, best = found.problem, found.base.fit, found.extended
    amplitude = best.amplitudes()
    rows = []
    for t, (name, spectrum) in enumerate(zip(problem.names, problem.spectra, strict=True)):
        noise = spectrum.sample_noise
        rows.append(
            {
                "name": name,
                "frequency_hz": spectrum.frequency,
                "amplitude_mm": _finite(1e3 * problem.amplitude[t]),
                "amplitude_fitted_mm": _finite(1e3 * amplitude[t]),
                "periods": spectrum.periods,
                "noise_displacement_mm": 1e3 * noise[0],
                "noise_velocity_mm_per_s": 1e3 * noise[1] if noise.size > 1 else None,
                "q_base": _finite(base.trial.by_test[t]),
                "q_extended": _finite(best.trial.by_test[t]),
                "dof": int(problem.dof[t]),
            }
        )
    return rows


def _gain(gain: Gain | None) -> dict[str, Any] | None:
    if gain is None or not gain.held_out:
        return None
    base, extended, noise = np.sqrt(gain.totals())
    return {
        "scheme": "leave-one-frequency-out"
        + (" and leave-one-amplitude-out" if any(h.scheme == "amplitude" for h in gain.held_out) else ""),
        "rmse_base": _finite(base),
        "rmse_extended": _finite(extended),
        "rmse_noise": _finite(noise),
        "gain": _finite(1.0 - extended / base),
        "excess_removed": _finite(gain.excess_removed),
        "ci95": gain.interval,
        "held_out": [
            {
                "test": each.test,
                "scheme": each.scheme,
                "rmse_base": _finite(each.rmse(each.base)),
                "rmse_extended": _finite(each.rmse(each.extended)),
                "rmse_noise": _finite(each.rmse(each.noise)),
            }
            for each in gain.held_out
        ],
    }


def _uncertain(fit: Fit) -> dict[str, dict[str, float]]:
    """Uncertain numbers of the model as fitted."""
    size = fit.model.size
    return {
        name: {"scale": float(value), "std": float(sqrt(max(fit.covariance[size + i, size + i], 0.0)))}
        for i, (name, value) in enumerate(zip(fit.model.uncertain, fit.x[size:], strict=True))
    }


def _candidates(found: Diagnosis) -> list[dict[str, Any]]:
    scores = {score.effect: score for score in found.scores}
    rows = []
    for each in sorted([found.base, *found.explanations], key=lambda one: one.penalised):
        score = scores.get(each.effects[0]) if len(each.effects) == 1 else None
        numbers = parameters(each.fit) if isfinite(each.fit.q) else {}
        rows.append(
            {
                "effects": list(each.effects),
                "q": _finite(each.fit.q),
                "dof": each.fit.dof,
                "p": _finite(each.fit.p),
                "penalised": _finite(each.penalised),
                "parameters": {
                    f"{name}.{key}": value for name, own in numbers.items() for key, value in own.items()
                },
                "score": None if score is None else _finite(score.t2),
                "retention": None if score is None else _finite(score.retention),
                "status": _status(each, score),
            }
        )
    return rows


def _status(each: Explanation, score: Any) -> str:
    if not isfinite(each.fit.q):
        return "failed"
    return "not testable" if score is not None and not score.testable else "fitted"


def extended(found: Diagnosis) -> str:
    """The extended model as a config that runs the measured tests."""
    best, problem = found.extended, found.problem
    document = {**problem.model.document, "title": f"{found.measurement.title}: extended model"}
    nuisance = {name: {"scale": each["scale"]} for name, each in _uncertain(best).items()}
    document["effects"] = {**document["effects"], **nuisance, **best.values}
    document["sweep"] = {
        "omega_n_rad_per_s": problem.model.sweep.omega_n,
        "case": [
            {
                "friction_law": problem.law,
                "frequency_hz": spectrum.frequency,
                "amplitude_mm": float(1e3 * amplitude),
            }
            for spectrum, amplitude in zip(problem.spectra, best.amplitudes(), strict=True)
        ],
    }
    return _heading(found) + toml.dumps(document)


def _heading(found: Diagnosis) -> str:
    best = found.finding.best
    what = " + ".join(best.effects) if best else "nothing added"
    return f"# Verdict: {found.finding.verdict}. The model on trial with {what}.\n"


def dataset(found: Diagnosis) -> xr.Dataset:
    """Harmonics and waveforms, measured and simulated, for the figures (SI units)."""
    problem = found.problem
    fits = (found.base.fit, found.extended)
    channels, harmonics = problem.shape
    turned = waveforms.measured_from_phase_zero(fits[1])
    simulated = np.array([fit.trial.harmonics for fit in fits])[..., :harmonics]
    signal, model_signal = waveforms.waveform(turned), waveforms.waveform(simulated)
    rates = [waveforms.velocity(problem, each) for each in (turned, *simulated)]
    shown = [waveforms.waveform(each) for each in rates]
    weight = problem.weight[..., :harmonics]
    noise = np.where(weight > 0.0, 1.0 / np.where(weight > 0.0, weight, 1.0), np.nan)
    known = ~np.isnan(problem.amplitude)
    energy = np.where(known, waveforms.supplied(fits[1], turned[:, 0, 0]), np.nan)
    sampled = np.full((problem.tests, channels), np.nan)
    for row, spectrum in zip(sampled, problem.spectra, strict=True):
        row[: spectrum.sample_noise.size] = spectrum.sample_noise
    # A channel that a test does not have was nowhere near zero.
    absent = np.isnan(sampled)[..., None]
    signal, seen = np.where(absent, np.nan, signal), np.where(absent, np.nan, turned)
    by_test, by_model = ("test",), ("model", "test")
    parts = ("harmonic", "part")
    variables: dict[str, tuple[tuple[str, ...], Any, str, str]] = {
        "measured_harmonics": (("test", "channel", *parts), _parts(seen), "m or m/s", "measured harmonics"),
        "noise_std": (
            ("test", "channel", "harmonic"),
            noise,
            "m or m/s",
            "noise of a real part of a harmonic",
        ),
        "simulated_harmonics": (
            (*by_model, "channel", *parts),
            _parts(simulated),
            "m or m/s",
            "simulated harmonics",
        ),
        "measured_waveform": ((*by_test, "channel", "phase"), signal, "m or m/s", "measured over one period"),
        "simulated_waveform": (
            (*by_model, "channel", "phase"),
            model_signal,
            "m or m/s",
            "simulated over one period",
        ),
        "waveform_noise": (("test", "channel"), sampled, "m or m/s", "noise of one sample"),
        "frequency": (by_test, problem.omega / (2.0 * np.pi), "Hz", "input frequency"),
        "amplitude": (by_test, problem.amplitude, "m", "input amplitude as stated"),
        "amplitude_fitted": (
            by_model,
            np.array([fit.amplitudes() for fit in fits]),
            "m",
            "input amplitude as fitted",
        ),
        "measured_peak_to_peak": (
            by_test,
            waveforms.peak_to_peak(signal[:, 0]),
            "m",
            "measured peak to peak",
        ),
        "simulated_peak_to_peak": (
            by_model,
            waveforms.peak_to_peak(model_signal[:, :, 0]),
            "m",
            "simulated peak to peak",
        ),
        "measured_energy": (by_test, energy, "J", "energy that the base puts in per period, measured"),
        "simulated_energy": (
            by_model,
            np.array([waveforms.supplied(fit, fit.trial.harmonics[:, 0, 0]) for fit in fits]),
            "J",
            "energy that the base puts in per period, simulated",
        ),
        "measured_plateau": (
            by_test,
            waveforms.plateau(shown[0]),
            "1",
            "share of the period near rest, measured",
        ),
        "simulated_plateau": (
            by_model,
            np.array([waveforms.plateau(each) for each in shown[1:]]),
            "1",
            "share of the period near rest, simulated",
        ),
        "leftover_force": (
            ("test", "phase"),
            waveforms.leftover_force(fits[0], waveforms.measured_from_phase_zero(fits[0])),
            "N",
            "force on the bolster that the base model lacks",
        ),
        "q": (by_model, np.array([fit.trial.by_test for fit in fits]), "1", "squared misfit over noise"),
        "dof": (by_test, problem.dof, "1", "degrees of freedom"),
    }
    data = {
        name: (dims, values, {"units": unit, "long_name": text})
        for name, (dims, values, unit, text) in variables.items()
    }
    coordinates = {
        "test": list(problem.names),
        "model": ["base", "extended"],
        "channel": list(CHANNELS[:channels]),
        "harmonic": np.arange(1, harmonics + 1),
        "part": ["real", "imaginary"],
        "phase": np.arange(waveforms.PHASES) / waveforms.PHASES,
    }
    attributes = {
        "title": found.measurement.title,
        "verdict": found.finding.verdict,
        "law": problem.law,
        "wedgesweep_version": __version__,
    }
    return xr.Dataset(data, coordinates, attributes)


def _parts(values: np.ndarray) -> np.ndarray:
    return np.stack([values.real, values.imag], axis=-1)


def _finite(value: Any) -> float | None:
    """A number as JSON takes it."""
    return float(value) if value is not None and isfinite(value) else None
