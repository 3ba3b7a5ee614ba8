"""The extended model as extended.toml."""

from wedgesweep.config import toml
from wedgesweep.diagnose.diagnosis import Diagnosis
from wedgesweep.diagnose.result.estimates import uncertain


def extended(found: Diagnosis) -> str:
    """The extended model as a config that runs the measured tests."""
    best, problem = found.extended, found.problem
    document = {**problem.model.document, "title": f"{found.measurement.title}: extended model"}
    nuisance = {name: {"scale": each["scale"]} for name, each in uncertain(best).items()}
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
