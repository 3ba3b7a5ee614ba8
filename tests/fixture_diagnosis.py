"""The result of a diagnosis with each verdict, made without solving anything.

The motion is that of a linear oscillator with its crests cut off. The "suspension" cuts deeper than the base
model does, more so at small inputs, and the extended model cuts nearly as deep: plateaus, harmonics,
energy and misfit all follow from the waveforms and the noise.
"""

import json

import numpy as np
import xarray as xr
from scipy.stats import chi2

OMEGA_N, RESONANCE, MASS = 85.356, 97.506, 0.75
HARMONICS, PHASES = 16, 256
FLOOR = 0.004  # noise of what is compared over the response
NOISE = 0.04  # std of one sample over the rms of its channel
PERIODS, SAMPLES = 8, 600
TEXT = {
    "title": "bench run 12",
    "model": {"law": "static-dynamic", "title": "table 1"},
    "version": "0.2.0",
    "created": "2025-01-31T12:00:00Z",
    "uncertain": {"friction_level": {"scale": 1.03, "std": 0.04}},
}
STRIBECK = {"stribeck.peak": (0.08, 0.07, 0.09), "stribeck.velocity_mm_per_s": (5.1, 4.8, 5.5)}
GUIDE = {"guide_friction.force_N": (2.13, 1.95, 2.31)}
STIFFNESS = {"bolster_stiffness.scale": (0.91, 0.85, 0.97)}
FAMILIES = {"guide_friction": "missing-force", "stribeck": "friction-law"}
NEXT = {
    "frequency_hz": 24.0,
    "amplitude_mm": 0.1,
    "separates": ["stribeck", "guide_friction"],
    "distance": 41.0,
}
DETECTABLE = {
    "bolster_stiffness": {"scale": 1.02},
    "stribeck": {"peak": 0.004},
    "guide_friction": {"force_N": 0.05},
    "fixture_resonance": {"frequency_hz": 310.0},
}
NOT_TESTABLE = ["cross_slip", "ageing"]
REASONS = {
    "nothing-missing": {"code": "only-noise"},
    "named": {"code": "alone"},
    "consistent-with": {"code": "weak-excess", "excess": 300.0},
    "tied": {"code": "equally-good"},
    "data-insufficient": {"code": "few-tests"},
    "none-of-mine": {"code": "unexplained"},
}
# Per verdict: share of the missing cut that the extended model has, its effects, rivals, tests.
CASES = {
    "nothing-missing": (1.0, [], [], 12),
    "named": (1.0, ["stribeck", "guide_friction"], [], 12),
    "consistent-with": (1.0, ["guide_friction"], [], 12),
    "tied": (1.0, ["stribeck"], [{"effects": ["guide_friction"], "gap": 3.2}], 12),
    "data-insufficient": (1.0, [], [], 2),
    "none-of-mine": (0.6, [], [], 12),
}

# Nodes of a map of an empirical force, and what is stored of it.
PLACES, SPEEDS = 5, 7
EMPIRICAL = {
    "offered": True,
    "accuracy": 0.02,
    "accuracy_held_out": 0.03,
    "named": {"effects": ["stribeck"], "accuracy": 0.1, "accuracy_held_out": 0.12},
    "degrees_of_freedom": 12.3,
    "step_N": 0.4,
    "nearest": [{"form": "damper (viscous_damping)", "share": 0.8, "ci95": [0.7, 0.9]}],
    "next_place": {"displacement_mm": 0.5, "velocity_mm_per_s": 40.0},
}


def write(directory, verdict="named", **options):
    """Write both files of a diagnosis into a directory."""
    document, data = build(verdict, **options)
    directory.mkdir(parents=True, exist_ok=True)
    (directory / "diagnosis.json").write_text(json.dumps(document, allow_nan=False), encoding="utf-8")
    data.to_netcdf(directory / "diagnosis.nc", engine="netcdf4")
    return document, data


def build(verdict="named", tests=None, velocity=True, known=True):
    """Document and dataset; without velocity channel or known amplitudes where asked for."""
    share, causes, rivals, usual = CASES[verdict]
    missing = {"nothing-missing": 0.0, "consistent-with": 0.001}.get(verdict, 0.2)
    known = known and verdict != "data-insufficient"
    data = _dataset(tests or usual, missing, share, 2 if velocity else 1, known)
    attempt = ["stribeck"] if verdict in ("data-insufficient", "none-of-mine") else causes
    return _document(verdict, data, causes, attempt, rivals, known), data


def _places(tests):
    """Frequencies (Hz) and amplitudes (m) of the tests: a grid with up to three amplitudes."""
    rows = max(1, min(3, tests // 2))
    columns = -(-tests // rows)
    hertz = np.linspace(6.0, 32.0, columns) if tests > 2 else np.array([20.0, 30.0])
    size = np.geomspace(0.1e-3, 1e-3, rows)
    return np.tile(hertz, rows)[:tests], np.repeat(size, columns)[:tests]


def _displacement(frequency, amplitude, missing):
    """Waveforms (T, PHASES) of x - y; ``missing`` friction cuts them deeper."""
    phase = 2.0 * np.pi * np.arange(PHASES) / PHASES
    squared = (2.0 * np.pi * frequency / RESONANCE) ** 2
    linear = squared / np.hypot(1.0 - squared, 0.2)
    lag = np.arctan2(0.2, 1.0 - squared)
    cut = np.clip(0.9 - missing * (0.5 + 0.5 * (0.1e-3 / amplitude) ** 0.3), 0.1, 1.0)
    sine = np.sin(phase - lag[:, None])
    swing = amplitude * linear * (0.3 + 0.7 * cut)
    return swing[:, None] * np.clip(sine, -cut[:, None], cut[:, None]) / cut[:, None]


def _harmonics(waveform, omega, channels):
    """Harmonics (T, channels, HARMONICS) of displacement and its rate."""
    spectrum = 2.0 * np.fft.fft(waveform)[:, 1 : HARMONICS + 1] / PHASES
    rate = 1j * omega[:, None] * np.arange(1, HARMONICS + 1) * spectrum
    return np.stack([spectrum, rate], axis=1)[:, :channels]


def _waveform(harmonics):
    phase = 2.0 * np.pi * np.arange(PHASES) / PHASES
    return (harmonics @ np.exp(1j * np.outer(np.arange(1, HARMONICS + 1), phase))).real


def _dataset(tests, missing, share, channels, known):
    random = np.random.default_rng(1)
    frequency, amplitude = _places(tests)
    omega = 2.0 * np.pi * frequency
    true, base, extended = (
        _harmonics(_displacement(frequency, amplitude, m), omega, channels)
        for m in (missing, 0.0, share * missing)
    )
    simulated = np.array([base, extended])
    level = NOISE * np.sqrt((np.abs(true) ** 2).sum(-1) / 2.0)
    std = np.repeat((level * np.sqrt(2.0 / (PERIODS * SAMPLES)))[..., None], HARMONICS, axis=-1)
    measured = true + std * (random.normal(size=true.shape) + 1j * random.normal(size=true.shape))
    q = (np.abs(measured - simulated) ** 2 / std**2).sum((-2, -1))
    both = [_waveform(each) for each in (measured, *simulated)]
    rate = [
        _waveform(1j * omega[:, None] * np.arange(1, HARMONICS + 1) * h[:, 0]) for h in (measured, *simulated)
    ]
    plateau = [(np.abs(v) < 0.05 * np.abs(v).max(-1, keepdims=True)).mean(-1) for v in rate]
    energy = [np.pi * MASS * amplitude * omega**2 * np.abs(h[:, 0, 0].imag) for h in (measured, *simulated)]
    unknown = np.full(tests, np.nan)
    force = -2.1 * np.tanh(-rate[0] / 5e-3) * (missing > 0.0) + 0.1 * random.normal(size=rate[0].shape)
    by_model = ("model", "test")
    parts = ("harmonic", "part")
    variables = {
        "measured_harmonics": (("test", "channel", *parts), _parts(measured)),
        "noise_std": (("test", "channel", "harmonic"), std),
        "simulated_harmonics": ((*by_model, "channel", *parts), _parts(simulated)),
        "measured_waveform": (("test", "channel", "phase"), both[0]),
        "simulated_waveform": ((*by_model, "channel", "phase"), np.array(both[1:])),
        "waveform_noise": (("test", "channel"), level),
        "frequency": (("test",), frequency),
        "amplitude": (("test",), amplitude if known else unknown),
        "amplitude_fitted": (by_model, np.array([amplitude, 1.01 * amplitude])),
        "measured_peak_to_peak": (("test",), np.ptp(both[0][:, 0], axis=-1)),
        "simulated_peak_to_peak": (by_model, np.array([np.ptp(each[:, 0], axis=-1) for each in both[1:]])),
        "measured_energy": (("test",), energy[0] if known else unknown),
        "simulated_energy": (by_model, np.array(energy[1:])),
        "measured_plateau": (("test",), plateau[0]),
        "simulated_plateau": (by_model, np.array(plateau[1:])),
        "leftover_force": (("test", "phase"), force),
        "q": (by_model, q),
        "dof": (("test",), np.full(tests, 2 * channels * HARMONICS - 1)),
    }
    coordinates = {
        "force_place": np.linspace(-1e-3, 1e-3, PLACES),
        "force_speed": np.linspace(-0.1, 0.1, SPEEDS),
        "test": [f"run-{place:02d}" for place in range(tests)],
        "model": ["base", "extended"],
        "channel": ["displacement", "velocity"][:channels],
        "harmonic": np.arange(1, HARMONICS + 1),
        "part": ["real", "imaginary"],
        "phase": np.arange(PHASES) / PHASES,
    }
    variables |= _missing_force()
    return xr.Dataset(variables, coordinates, {"title": TEXT["title"]})


def _missing_force():
    """An empirical force that was not measured in one corner."""
    force = np.add.outer(np.linspace(-1.0, 1.0, PLACES), np.linspace(1.0, -1.0, SPEEDS))
    force[0, 0] = np.nan
    found = {"missing_force": (("force_place", "force_speed"), force)}
    for over, count in (("place", PLACES), ("speed", SPEEDS)):
        found[f"missing_force_over_{over}"] = ((f"force_{over}",), np.linspace(-1.0, 1.0, count))
        found[f"missing_force_over_{over}_std"] = ((f"force_{over}",), np.full(count, 0.1))
    return found


def _parts(values):
    return np.stack([values.real, values.imag], axis=-1)


def _document(verdict, data, causes, attempt, rivals, known):
    totals = data["q"].sum("test").values
    dof = int(data["dof"].sum())
    base, extended = float(totals[0]), float(totals[1])
    numbers = {**STRIBECK, **GUIDE}
    held_out = _held_out(data) if attempt and data.sizes["test"] > 2 else []
    return {
        "verdict": verdict,
        "reason": REASONS[verdict],
        "causes": [_cause(name, numbers) for name in causes],
        "rivals": rivals,
        "misfit": {
            "chi2_base": base,
            "chi2_extended": extended,
            "dof": dof,
            "excess_base": base - dof,
            "p_base": float(chi2.sf(base, dof)),
            "p_extended": float(chi2.sf(extended, dof - 2 * len(attempt))),
            "p_where_it_shows": float(chi2.sf(extended, dof - 2 * len(attempt))),
            "p_constant": 1.0,
            "least_constant": None,
            "tests": _tests(data, known),
        },
        "gain": _gain(held_out),
        "empirical_force": EMPIRICAL if verdict == "none-of-mine" else None,
        "detectable": DETECTABLE,
        "not_testable": NOT_TESTABLE,
        "next_test": dict(NEXT) if verdict in ("tied", "data-insufficient") else None,
        **TEXT,
        "method": {
            "penalty_per_parameter": 12.6,
            "gap": 10.0,
            "enough_distance": 30.0,
            "strong_excess": 800.0,
            "larger_model_error": 0.04,
            "adequate_p": 0.01,
            "model_error": 0.0,
            "noise_floor": FLOOR,
            "dof": dof,
            "harmonics": HARMONICS,
            "calibrated": None,
        },
        "ladder": _ladder(verdict, attempt),
        "candidates": _candidates(base, extended, dof, attempt),
    }


def _ladder(verdict, attempt):
    """Base model, single effects, and pairs where the attempt is one or nothing is adequate."""
    if verdict == "nothing-missing":
        return [_level(([], 0.0)), _level((["stribeck"], 0.0), (["guide_friction"], 0.0))]
    left = 0.012 if verdict == "none-of-mine" else 0.0
    single = attempt if len(attempt) == 1 else ["stribeck"]
    other = "guide_friction" if single == ["stribeck"] else "stribeck"
    singles = [(single, left if single == attempt else 0.08), ([other], 0.14), (["end_stop"], 0.3)]
    levels = [_level(([], 0.35)), _level(*singles)]
    if len(attempt) == 2 or left:
        pair = attempt if len(attempt) == 2 else ["stribeck", "velocity_lag"]
        levels.append(
            _level((pair, 0.8 * left), (["stribeck", "end_stop"], 0.011), (["stribeck", "ageing"], None))
        )
    return levels


def _level(*rated):
    (effects, best), *others = rated
    rivals = [{"effects": each, "accuracy": size} for each, size in others]
    distinct = rivals[0]["accuracy"] / best if rivals and best else None
    level = {"effects": effects, "accuracy": best, "accuracy_held_out": 1.25 * best}
    return {**level, "distinct": distinct, "rivals": rivals}


def _cause(effect, numbers):
    mine = {key.split(".")[1]: value for key, value in numbers.items() if key.startswith(f"{effect}.")}
    return {
        "effect": effect,
        "family": FAMILIES[effect],
        "branch": "numerical-model",
        "parameters": {key: {"value": v, "ci95": [low, high]} for key, (v, low, high) in mine.items()},
    }


def _tests(data, known):
    rows = []
    for place, name in enumerate(data["test"].values):
        one = data.isel(test=place)
        noise = one["waveform_noise"].values * 1e3
        rows.append(
            {
                "name": str(name),
                "frequency_hz": float(one["frequency"]),
                "amplitude_mm": 1e3 * float(one["amplitude"]) if known else None,
                "amplitude_fitted_mm": 1e3 * float(one["amplitude_fitted"][1]),
                "periods": 8.4,
                "noise_displacement_mm": float(noise[0]),
                "noise_velocity_mm_per_s": float(noise[1]) if noise.size > 1 else None,
                "q_base": float(one["q"][0]),
                "q_extended": float(one["q"][1]),
                "dof": int(one["dof"]),
            }
        )
    return rows


def _held_out(data):
    dof = data["dof"].values
    base, extended = np.sqrt(data["q"].values / dof)
    return [
        {
            "test": str(name),
            "scheme": scheme,
            "rmse_base": float(1.1 * base[place]),
            "rmse_extended": float(1.1 * extended[place]),
            "rmse_noise": 0.98,
        }
        for scheme in ("frequency", "amplitude")
        for place, name in enumerate(data["test"].values)
    ]


def _gain(held_out):
    if not held_out:
        keys = ("scheme", "rmse_base", "rmse_extended", "rmse_noise", "gain", "excess_removed", "ci95")
        return {**dict.fromkeys(keys), "held_out": []}
    base, extended, noise = (
        float(np.sqrt(np.mean([row[f"rmse_{kind}"] ** 2 for row in held_out])))
        for kind in ("base", "extended", "noise")
    )
    removed = (base**2 - extended**2) / (base**2 - noise**2)
    return {
        "scheme": "leave-one-frequency-out and leave-one-amplitude-out",
        "rmse_base": base,
        "rmse_extended": extended,
        "rmse_noise": noise,
        "gain": 1.0 - extended / base,
        "excess_removed": removed,
        "ci95": [removed - 0.01, min(removed + 0.005, 1.0)] if len(held_out) > 8 else None,
        "held_out": held_out,
    }


def _candidates(base, extended, dof, attempt):
    """Base model, attempt, others between them, one that failed and one that cannot be tested."""
    rows = [_candidate([], base, dof, {}, None, None)]
    if attempt:
        rows.append(_candidate(attempt, extended, dof, {**STRIBECK, **GUIDE}, 900.0, 0.8))
    others = {"guide_friction": GUIDE, "stribeck": STRIBECK, "bolster_stiffness": STIFFNESS}
    others |= {name: {} for name in ("viscous_damping", "end_stop", "fixture_resonance", "velocity_lag")}
    for place, (name, numbers) in enumerate(others.items()):
        if [name] != attempt:
            left = extended * (base / max(extended, 1.0)) ** (0.15 + 0.12 * place) + 4.0 * place
            rows.append(_candidate([name], left, dof, numbers, 700.0 / (place + 1), 0.6))
    rows.append(_candidate(["ageing"], base - 1.0, dof, {}, None, 0.02, "not testable"))
    rows.append(_candidate(["cross_slip"], None, dof, {}, None, 0.01, "failed"))
    return sorted(rows, key=lambda row: np.inf if row["penalised"] is None else row["penalised"])


def _candidate(effects, q, dof, numbers, score, retention, status="fitted"):
    mine = {key: each for key, each in numbers.items() if key.split(".")[0] in effects}
    left = dof - len(mine)
    return {
        "effects": list(effects),
        "q": q,
        "dof": left,
        "p": None if q is None else float(chi2.sf(q, left)),
        "penalised": None if q is None else q + 12.6 * max(len(mine), len(effects)),
        "parameters": {key: {"value": v, "ci95": [low, high]} for key, (v, low, high) in mine.items()},
        "score": score if len(effects) == 1 else None,
        "retention": retention if len(effects) == 1 else None,
        "status": status,
    }
