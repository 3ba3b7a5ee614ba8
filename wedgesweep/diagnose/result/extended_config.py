"""The extended model as extended.toml."""

from collections.abc import Mapping
from typing import Any

from wedgesweep import effects
from wedgesweep.config import Config
from wedgesweep.config.keys import SMALLEST
from wedgesweep.diagnose.diagnosis import Diagnosis
from wedgesweep.diagnose.fit_data import INPUT_GAIN
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.result.estimates import uncertain_values


def extended(found: Diagnosis) -> str:
    """The extended model as a config that runs the measured tests."""
    return _heading(found) + written(found, found.extended, found.extended.values)


def written(
    found: Diagnosis, fit: Fit, values: effects.Numbers, tables: Mapping[str, Any] | None = None
) -> str:
    """A config that runs the measured tests with a fit's effects, by their keys; ``tables``: as they are."""
    data = found.data
    document = {**found.measurement.model.document, "title": f"{found.measurement.title}: extended model"}
    nuisance = {name: each for name, each in uncertain_values(fit).items() if name != INPUT_GAIN}
    document["effects"] = _as_written(effects.merge(document["effects"], {**nuisance, **values}))
    document["effects"] |= tables or {}
    cases = [{"friction_law": data.law, **case} for case in data.cases(fit)]
    if not cases:
        return Config(document).to_toml()
    document["solver"] = _steady(document["solver"])
    document["sweep"] = {
        "omega_n_rad_per_s": data.model.sweep.omega_n,
        "excitation": data.model.excitation,
        # Repeated tests are one case.
        "case": [case for place, case in enumerate(cases) if case not in cases[:place]],
    }
    return Config(document).to_toml()


def _as_written(numbers: Mapping[str, Mapping[str, float]]) -> dict[str, dict[str, float]]:
    """Numbers as a config takes them: what is smaller than its smallest ones is zero."""
    return {
        name: {key: value if abs(value) >= SMALLEST else 0.0 for key, value in own.items()}
        for name, own in numbers.items()
    }


def _steady(solver: Mapping[str, Any]) -> dict[str, Any]:
    """The solver of a config, to run until steady, as the tests are; single cases do not continue others."""
    kept = {key: value for key, value in solver.items() if key not in ("duration_s", "settle_periods")}
    return {**kept, "method": "event-driven", "settle": "steady", "continuation": False}


def _heading(found: Diagnosis) -> str:
    best = found.finding.best
    what = " + ".join(best.effects) if best else "nothing added"
    return f"# Verdict: {found.finding.verdict}. The base model with {what}.\n"
