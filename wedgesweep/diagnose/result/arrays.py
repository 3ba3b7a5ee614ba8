"""diagnosis.nc: what was measured and simulated in each test, for the figures (SI units)."""

import numpy as np
import xarray as xr

from wedgesweep import __version__, rotation
from wedgesweep.diagnose.diagnosis import Diagnosis
from wedgesweep.diagnose.fit_data import BY_MODEL, BY_TEST, FitData, Variables
from wedgesweep.diagnose.model import Fit
from wedgesweep.sweep import labels

MODELS = ["base", "extended"]


def dataset(found: Diagnosis) -> xr.Dataset:
    """Arrays of a diagnosis for figures and notebooks; of several kinds of test, what all of them have."""
    return _dataset(found, found.data, found.base, found.extended)


def parts(found: Diagnosis) -> dict[str, xr.Dataset]:
    """The dataset of each kind of test where there are several."""
    if len(found.data.parts) == 1:
        return {}
    base, extended = found.data.fits(found.base), found.data.fits(found.extended)
    own = zip(found.data.parts, base, extended, strict=True)
    return {part.kind: _dataset(found, part, *fits) for part, *fits in own}


def _dataset(found: Diagnosis, data: FitData, base: Fit, extended: Fit) -> xr.Dataset:
    own, kinds = data.arrays(base, extended), [part.kind for part in data.parts for _ in part.names]
    misfit: Variables = {
        "q": (
            BY_MODEL,
            np.array([fit.evaluation.chi2_by_test for fit in (base, extended)]),
            "1",
            "squared misfit over noise",
        ),
        "dof": (BY_TEST, data.dof, "1", "degrees of freedom"),
    }
    made = xr.Dataset(
        {
            name: (dims, values, {"units": unit, "long_name": meaning})
            for name, (dims, values, unit, meaning) in {**own.variables, **misfit}.items()
        },
        {"test": list(data.names), "model": MODELS, "test_kind": (BY_TEST, kinds), **own.coordinates},
        {
            "title": found.measurement.title,
            "verdict": found.finding.verdict,
            "law": data.law,
            "wedgesweep_version": __version__,
            "kind": data.kind,
            **labels.attributes(data.model),
        },
    )
    return rotation.with_units(made) if data.model.turns else made
