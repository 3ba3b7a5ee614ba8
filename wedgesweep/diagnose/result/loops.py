"""What is stored of a diagnosis of loops: forces along each block, measured and simulated."""

from typing import Any

import numpy as np
import xarray as xr

from wedgesweep import __version__
from wedgesweep.diagnose.diagnosis import Diagnosis
from wedgesweep.diagnose.loop.loop_data import LoopData
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.result.estimates import finite


def _fits(found: Diagnosis) -> dict[str, Fit]:
    return {"base": found.base.fit, "extended": found.extended}


def tests(found: Diagnosis, data: LoopData) -> list[dict[str, Any]]:
    """Rows of the tests for diagnosis.json; errors are rms over the rms of the measured force."""
    errors = {name: data.error(fit.evaluation) for name, fit in _fits(found).items()}
    rows = []
    for t, (name, (number, _)) in enumerate(zip(data.names, data.chosen, strict=True)):
        own = data.recordings[number]
        rows.append(
            {
                "name": name,
                "lowpass_hz": finite(own.low_pass.cutoff),
                "samples": int(data.observations[t]),
                "noise_force_N": finite(own.noise),
                "noise_velocity_mm_per_s": finite(1e3 * own.motion.velocity_noise),
                **{f"error_{model}": finite(error[t]) for model, error in errors.items()},
                **{
                    f"q_{model}": finite(fit.evaluation.chi2_by_test[t])
                    for model, fit in _fits(found).items()
                },
                "dof": int(data.dof[t]),
            }
        )
    return rows


def dataset(found: Diagnosis, data: LoopData) -> xr.Dataset:
    """Forces (N) over the imposed motion (m, m/s), NaN where nothing is compared."""
    by_sample, by_model = ("test", "sample"), ("model", "test", "sample")
    shown = np.where(data.weight > 0.0, 1.0, np.nan)
    motions = [own.motion for own in data.recordings]
    places = [own.places for own in data.recordings]
    position, velocity = (
        data.padded([getattr(each, name)[place] for each, place in zip(motions, places, strict=True)])
        for name in ("displacement", "velocity")
    )
    fits = list(_fits(found).values())
    simulated = np.array([data.with_zero(fit.evaluation) for fit in fits])
    q = np.array([fit.evaluation.chi2_by_test for fit in fits])
    variables = {
        "displacement": (by_sample, position * shown, "m", "imposed displacement"),
        "velocity": (by_sample, velocity * shown, "m/s", "imposed velocity"),
        "measured_force": (by_sample, data.measured * shown, "N", "measured force"),
        "simulated_force": (by_model, simulated * shown, "N", "simulated force, with the fitted zero"),
        "force_noise": (("test",), data.noise, "N", "noise of a compared force"),
        "q": (("model", "test"), q, "1", "squared misfit over noise"),
        "dof": (("test",), data.dof, "1", "degrees of freedom"),
    }
    return xr.Dataset(
        {
            name: (dims, values, {"units": unit, "long_name": meaning})
            for name, (dims, values, unit, meaning) in variables.items()
        },
        {"test": list(data.names), "model": list(_fits(found))},
        {
            "title": found.measurement.title,
            "kind": data.kind,
            "verdict": found.finding.verdict,
            "law": data.law,
            "wedgesweep_version": __version__,
        },
    )
