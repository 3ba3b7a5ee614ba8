"""How the arrays of a diagnosis become a dataset."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from wedgesweep import __version__
from wedgesweep.diagnose.diagnosis import Diagnosis

# Dimensions, values, unit and meaning of a variable.
Variables = dict[str, tuple[tuple[str, ...], np.ndarray, str, str]]
BY_TEST, BY_MODEL = ("test",), ("model", "test")
MODELS = ["base", "extended"]


def dataset(
    found: Diagnosis, variables: Variables, coordinates: Mapping[str, Any], **attributes: Any
) -> xr.Dataset:
    """A dataset of variables over the tests of a diagnosis, and its misfit with both models."""
    data = found.data
    q = np.array([fit.evaluation.chi2_by_test for fit in (found.base.fit, found.extended)])
    misfit: Variables = {
        "q": (BY_MODEL, q, "1", "squared misfit over noise"),
        "dof": (BY_TEST, data.dof, "1", "degrees of freedom"),
    }
    return xr.Dataset(
        {
            name: (dims, values, {"units": unit, "long_name": meaning})
            for name, (dims, values, unit, meaning) in {**variables, **misfit}.items()
        },
        {"test": list(data.names), "model": MODELS, **coordinates},
        {
            "title": found.measurement.title,
            "verdict": found.finding.verdict,
            "law": data.law,
            "wedgesweep_version": __version__,
            **attributes,
        },
    )
