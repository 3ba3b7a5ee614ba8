"""The result of a diagnosis in the form in which it is stored, plotted and reported."""

import json

from wedgesweep.diagnose.diagnosis import Diagnosis
from wedgesweep.diagnose.result import missing_force
from wedgesweep.diagnose.result.arrays import dataset, parts
from wedgesweep.diagnose.result.document import document
from wedgesweep.diagnose.result.extended_config import extended
from wedgesweep.diagnosis_result import DiagnosisResult


def result_of(found: Diagnosis) -> DiagnosisResult:
    """Return the result of a diagnosis, as it would be read from its files."""
    return DiagnosisResult(
        json.loads(json.dumps(document(found))),
        missing_force.with_map(dataset(found), found.empirical),
        extended(found),
        parts(found),
        missing_force.files(found),
    )
