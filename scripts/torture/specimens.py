"""Valid inputs of every kind, from which hostile ones are made."""

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

# Name of a config without anything unusual.
PLAIN = "quick"
CONFIGS = Path(__file__).parents[2] / "configs"
# Few and short cases, so that what is accepted does not cost time.
SHORT = {"method": "event-driven", "settle_periods": 3, "kept_periods": 2, "samples_per_period": 32}
AXES = {"beta": [0.3, 1.1], "amplitude_mm": [0.2, 1.2], "amplitude_N": [0.5], "frequency_hz": [20.0, 30.0]}
SAMPLES, RATE, FREQUENCY = 360, 1000.0, 20.0
MEASURED = {
    "measurement": {
        "title": "bench",
        "model": "model.toml",
        "input_harmonics_std": 0.004,
        "columns": {
            "time": {"column": "t", "unit": "s"},
            "displacement": {"column": "d", "unit": "mm"},
            "velocity": {"column": "v", "unit": "mm/s"},
        },
        "uncertain": {"friction_level": 0.05},
        "test": [
            {"file": "one.csv", "frequency_hz": FREQUENCY, "amplitude_mm": 0.3, "amplitude_std": 0.01},
            {"file": "two.csv", "from_s": 0.01, "to_s": 0.35, "detrend": True},
        ],
    }
}
RECORDED = {
    "measurement": {
        "model": "model.toml",
        "model_error": 0.02,
        "input_gain_std": 0.01,
        "csv": {"delimiter": "comma", "decimal": "point", "encoding": "utf-8", "skip_rows": 0},
        "columns": {
            "time": {"column": "t", "unit": "s"},
            "acceleration": {"column": "v", "unit": "m/s^2", "of": "absolute"},
            "input": {"column": "d", "unit": "mm", "quantity": "displacement"},
        },
        "test": [{"file": "one.csv", "model": {"suspension.bolster_mass_kg": 0.8}}, {"file": "two.csv"}],
    }
}
TRANSIENT = {
    "measurement": {
        "model": "model.toml",
        "columns": {"time": {"column": "t", "unit": "s"}, "displacement": {"column": "d", "unit": "mm"}},
        "test": [{"file": "decay.csv", "kind": "transient"}],
    }
}
LOOP = {
    "measurement": {
        "model": "model.toml",
        "columns": {
            "time": {"column": "t", "unit": "s"},
            "displacement": {"column": "d", "unit": "mm"},
            "force": {"column": "v", "unit": "N"},
        },
        "test": [{"file": "one.csv", "kind": "loop", "lowpass_hz": 150.0}],
    }
}
MODEL = {
    "title": "on trial",
    "sweep": {"friction_law": "static-dynamic", "beta": 1.0, "amplitude_mm": 0.1},
    "solver": SHORT,
}
PLAN = {
    "test": [
        {"frequency_hz": 20.0, "amplitude_mm": 0.3, "amplitude_std": 0.01},
        {"frequency_hz": 12.0, "amplitude_mm": 0.5},
    ]
}


@dataclass(frozen=True)
class Specimens:
    """Valid inputs: documents of TOML files, and the bytes of files that commands write."""

    configs: list[dict[str, Any]]
    measured: list[dict[str, Any]]
    csv: dict[str, str]
    dataset: bytes
    journal: bytes
    stored: dict[str, bytes]
    diagnosis: dict[str, bytes]


def configs() -> list[dict[str, Any]]:
    """Return the configs of the repository, shortened, that of the plain sweep last."""
    paths = sorted(CONFIGS.glob("*.toml"), key=lambda path: path.stem == PLAIN)
    return [_shortened(tomllib.loads(path.read_text(encoding="utf-8"))) for path in paths]


def _shortened(document: dict[str, Any]) -> dict[str, Any]:
    if "input" in document:  # a single motion for each law
        return document
    sweep = {key: AXES.get(key, each) for key, each in document["sweep"].items() if key != "case"}
    amplitude = "amplitude_N" if sweep.get("excitation") == "force" else "amplitude_mm"
    sweep = {"friction_law": "coulomb", "beta": [1.0], amplitude: AXES[amplitude], **sweep}
    if "frequency_hz" in sweep:
        sweep.pop("beta")
    return {**document, "sweep": sweep, "solver": {**SHORT}}


def vibration(seed: int = 0) -> np.ndarray:
    """Time (s), displacement (mm) and velocity (mm/s) of a made-up steady vibration, shape (n, 3)."""
    random = np.random.default_rng(seed)
    t = np.arange(SAMPLES) / RATE
    omega = 2.0 * np.pi * FREQUENCY
    d = 5.0 + np.cos(omega * t) + 0.3 * np.sin(3.0 * omega * t) + 0.02 * random.normal(size=t.size)
    v = omega * (-np.sin(omega * t) + 0.9 * np.cos(3.0 * omega * t) + 0.02 * random.normal(size=t.size))
    return np.column_stack([t, d, v])


def csv_files() -> dict[str, str]:
    """Return the vibration, twice, and one that decays, as CSV files by name."""
    decay = vibration(2)
    decay[:, 1:] *= np.exp(-8.0 * decay[:, :1])
    return {"one.csv": _csv(vibration(0)), "two.csv": _csv(vibration(1)), "decay.csv": _csv(decay)}


def _csv(samples: np.ndarray) -> str:
    return "t,d,v\n" + "".join(f"{t:.4f},{d:.6g},{v:.6g}\n" for t, d, v in samples)


def make(directory: Path, diagnosis: dict[str, bytes]) -> Specimens:
    """Make all specimens; ``diagnosis`` holds the files of a diagnosis by name."""
    from torture.formats import stored
    from torture.mutations import toml
    from wedgesweep import config
    from wedgesweep.sweep.run import Sweep

    document = configs()[-1]
    settings = config.parse(toml(document))
    sweep = Sweep(settings, directory / "whole.nc")
    sweep.run(n_jobs=1)
    return Specimens(
        configs=configs(),
        measured=[MEASURED, RECORDED, TRANSIENT, LOOP],
        csv=csv_files(),
        dataset=(directory / "whole.nc").read_bytes(),
        journal=_journal(Sweep(settings, directory / "half.nc")),
        stored=stored(directory),
        diagnosis=diagnosis,
    )


def _journal(sweep: Any) -> bytes:
    """Return the journal of a sweep that was stopped after its first cases."""

    def stop(records: np.ndarray, total: int) -> None:
        if records.size:
            raise KeyboardInterrupt

    try:
        sweep.run(n_jobs=1, progress=stop)
    except KeyboardInterrupt:
        return sweep.journal_path.read_bytes()
    raise AssertionError
